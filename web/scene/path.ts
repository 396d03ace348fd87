import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  Points,
  ShaderMaterial,
  Vector2,
} from 'three';
import { ACCENT } from './handles';
import { PATH_CAPACITY, PATH_MARK, type PathPicture } from './path-picture';

/** The colour of motion all over the app. */
const MOTION = '#a78bfa';

/**
 * The path of a joint: a thread with dots whose spacing shows the speed, what was dimmer than what comes, key poses in their colour.
 * Two draw calls, seen through the body.
 */
export class Path {
  readonly group = new Group();
  private readonly points = new InstancedInterleavedBuffer(new Float32Array(PATH_CAPACITY * 3), 3);
  private readonly along = new InstancedBufferAttribute(
    Float32Array.from({ length: PATH_CAPACITY }, (_, i) => i),
    1,
  );
  private readonly spots = new BufferAttribute(new Float32Array(PATH_CAPACITY * 4), 4);
  private readonly ribbon = new InstancedBufferGeometry();
  private readonly dots = new BufferGeometry();
  /** Shared by both materials. */
  private readonly uniforms = {
    now: { value: 0 },
    last: { value: 1 },
    view: { value: new Vector2(1, 1) },
    ratio: { value: 1 },
    motion: { value: new Color(MOTION) },
    accent: { value: new Color(ACCENT) },
  };

  constructor() {
    this.points.setUsage(DynamicDrawUsage);
    this.spots.setUsage(DynamicDrawUsage);
    // A quad a segment: x along it (0 start, 1 end), y across (-1, 1). The same points, one frame on, are the segments' ends.
    this.ribbon.setAttribute(
      'position',
      new BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3),
    );
    this.ribbon.setIndex([0, 1, 2, 0, 2, 3]);
    this.ribbon.setAttribute('start', new InterleavedBufferAttribute(this.points, 3, 0));
    this.ribbon.setAttribute('end', new InterleavedBufferAttribute(this.points, 3, 3));
    this.ribbon.setAttribute('along', this.along);
    this.dots.setAttribute('spot', this.spots);
    const material = (vertexShader: string, fragmentShader: string) =>
      new ShaderMaterial({
        transparent: true,
        depthTest: false,
        depthWrite: false,
        uniforms: this.uniforms,
        vertexShader,
        fragmentShader,
      });
    const thread = new Mesh(this.ribbon, material(THREAD_VERTEX, THREAD_FRAGMENT));
    const beads = new Points(this.dots, material(BEAD_VERTEX, BEAD_FRAGMENT));
    thread.renderOrder = 6;
    beads.renderOrder = 7;
    for (const each of [thread, beads]) each.frustumCulled = false;
    this.group.add(thread, beads);
    this.group.visible = false;
  }

  /** Shows a path, or none. The picture is copied. */
  set(picture: PathPicture | null): void {
    this.group.visible = picture !== null && picture.count > 1;
    if (!picture || picture.count < 2) return;
    const count = Math.min(picture.count, PATH_CAPACITY);
    const array = this.points.array as Float32Array;
    for (let i = 0; i < count * 3; i++) array[i] = picture.points[i];
    this.points.needsUpdate = true;
    this.ribbon.instanceCount = count - 1;
    let beads = 0;
    for (let frame = 0; frame < count; frame++) {
      const mark = picture.marks[frame];
      if (mark === PATH_MARK.none) continue;
      // A bead's fourth number is its frame with its mark behind the point: both fit a float exactly.
      this.spots.setXYZW(beads++, array[frame * 3], array[frame * 3 + 1], array[frame * 3 + 2], frame + mark / 4);
    }
    this.spots.needsUpdate = true;
    this.dots.setDrawRange(0, beads);
    this.uniforms.last.value = count - 1;
    this.uniforms.now.value = picture.now;
  }

  /** Size of the view in CSS pixels, and device pixels per CSS pixel. */
  resize(width: number, height: number, ratio: number): void {
    this.uniforms.view.value.set(width, height);
    this.uniforms.ratio.value = ratio;
  }

  /** Frees the path. */
  dispose(): void {
    this.ribbon.dispose();
    this.dots.dispose();
    for (const each of this.group.children) ((each as Mesh).material as ShaderMaterial).dispose();
  }
}

/** Opacity by time: full at the playhead, fading to both ends, and less of it before than after. */
const FADE = /* glsl */ `
uniform float now, last;
float strength(float frame) {
  float side = frame < now ? 0.5 : 1.0;
  float reach = frame < now ? max(now, 1.0) : max(last - now, 1.0);
  float rest = 1.0 - abs(frame - now) / reach;
  return side * mix(0.22, 1.0, smoothstep(0.0, 0.8, rest));
}`;

const THREAD_VERTEX = /* glsl */ `
${FADE}
attribute vec3 start, end;
attribute float along;
uniform vec2 view;
varying float vStrength;
varying float vAcross;
varying float vWidth;
void main() {
  vec4 a = projectionMatrix * viewMatrix * vec4(start, 1.0);
  vec4 b = projectionMatrix * viewMatrix * vec4(end, 1.0);
  vec2 across = (b.xy / b.w - a.xy / a.w) * view;
  across = length(across) > 1e-4 ? normalize(across) : vec2(1.0, 0.0);
  vec4 at = mix(a, b, position.x);
  float frame = along + position.x;
  vStrength = strength(frame);
  vWidth = frame < now ? 2.2 : 3.4;
  vAcross = position.y * (vWidth * 0.5 + 1.0);
  // A little longer than the segment, so that bends show no gaps.
  vec2 offset = vec2(-across.y, across.x) * vAcross + across * (position.x - 0.5) * 0.6;
  gl_Position = at + vec4(offset / view * 2.0 * at.w, 0.0, 0.0);
}`;

const THREAD_FRAGMENT = /* glsl */ `
uniform vec3 motion;
varying float vStrength;
varying float vAcross;
varying float vWidth;
void main() {
  float edge = 1.0 - smoothstep(vWidth * 0.5 - 0.5, vWidth * 0.5 + 0.5, abs(vAcross));
  gl_FragColor = vec4(motion, vStrength * edge * 0.9);
  #include <colorspace_fragment>
}`;

const BEAD_VERTEX = /* glsl */ `
${FADE}
attribute vec4 spot;
uniform float ratio;
varying float vStrength;
varying float vMark;
varying float vSize;
void main() {
  float frame = floor(spot.w);
  vMark = (spot.w - frame) * 4.0;
  vStrength = strength(frame);
  vSize = (vMark > 2.5 ? 18.0 : vMark > 1.5 ? 10.0 : 6.5) * ratio;
  gl_PointSize = vSize;
  gl_Position = projectionMatrix * viewMatrix * vec4(spot.xyz, 1.0);
}`;

const BEAD_FRAGMENT = /* glsl */ `
uniform vec3 motion, accent;
varying float vStrength;
varying float vMark;
varying float vSize;
void main() {
  // Key poses are diamonds, as on the timeline; the editor's joints are discs of the same colour.
  vec2 at = abs(gl_PointCoord - 0.5) * vSize;
  float r = vMark > 2.5 ? (at.x + at.y) * 0.9 : length(at);
  float edge = vSize * 0.5 - 1.0;
  float disc = 1.0 - smoothstep(edge - 1.0, edge + 0.5, r);
  float core = 1.0 - smoothstep(edge * 0.64 - 0.7, edge * 0.64 + 0.7, r);
  // A dark rim keeps a bead readable on the light body.
  vec3 fillColour = vMark > 2.5 ? accent : vMark > 1.5 ? vec3(0.92, 0.9, 1.0) : mix(motion, vec3(1.0), 0.35);
  vec3 colour = mix(vec3(0.03, 0.035, 0.05), fillColour, core);
  float opacity = vMark > 2.5 ? max(vStrength, 0.75) : vStrength;
  gl_FragColor = vec4(colour, disc * opacity * mix(0.6, 1.0, core));
  #include <colorspace_fragment>
}`;
