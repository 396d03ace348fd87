import { BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial, Vector3, type Camera } from 'three';
import { JOINT_COUNT } from '../core/skeleton';

/** The colour of key poses all over the app. */
export const ACCENT = '#ffb454';

/** Round dots on the joints, the same size at any distance, seen through the body; one draw call. */
export class Handles {
  readonly points: Points;
  private readonly positions = new BufferAttribute(new Float32Array(JOINT_COUNT * 3), 3);
  /** 0 idle, 1 hovered, 2 selected; 4 more where the joint is pinned. */
  private readonly states = new BufferAttribute(new Float32Array(JOINT_COUNT), 1);
  private readonly material = new ShaderMaterial({
    transparent: true,
    depthTest: false,
    depthWrite: false,
    uniforms: { accent: { value: new Color(ACCENT) }, ratio: { value: 1 } },
    vertexShader: /* glsl */ `
      attribute float state;
      uniform float ratio;
      varying float vState;
      varying float vPinned;
      varying float vSize;
      void main() {
        vPinned = step(3.5, state);
        vState = state - 4.0 * vPinned;
        vSize = (vState > 1.5 ? 20.0 : vState > 0.5 ? 18.0 : 12.0 + 2.0 * vPinned) * ratio;
        gl_PointSize = vSize;
        gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      uniform vec3 accent;
      varying float vState;
      varying float vPinned;
      varying float vSize;
      void main() {
        vec2 p = abs(gl_PointCoord - 0.5);
        // A pinned joint is a square: it shows without colour too.
        float r = mix(length(p), max(p.x, p.y), vPinned) * vSize;
        float edge = vSize * 0.5 - 1.0;
        float disc = 1.0 - smoothstep(edge - 1.0, edge + 0.5, r);
        float core = 1.0 - smoothstep(edge * 0.62 - 0.7, edge * 0.62 + 0.7, r);
        // A dark rim keeps the dot readable on a light body; the selected one is a ring that the gizmo's centre shows through.
        vec3 colour = mix(vec3(0.03, 0.035, 0.05), accent, core);
        float alpha = disc * (vState > 0.5 ? 1.0 : mix(0.45, 0.85, core));
        if (vState > 1.5) colour = mix(accent, vec3(1.0, 0.97, 0.9), core);
        // and has a dark nail in its middle.
        float nail = 1.0 - smoothstep(edge * 0.26 - 0.7, edge * 0.26 + 0.7, length(p) * vSize);
        colour = mix(colour, vec3(0.03, 0.035, 0.05), nail * vPinned);
        alpha = max(alpha, vPinned * disc * core);
        gl_FragColor = vec4(colour, alpha);
        #include <colorspace_fragment>
      }`,
  });

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setAttribute('state', this.states);
    this.points = new Points(geometry, this.material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 5;
    this.points.visible = false;
  }

  /** Device pixels per CSS pixel. */
  set ratio(value: number) {
    this.material.uniforms.ratio.value = value;
  }

  /** Puts the dots on the joints, 24 x 3 world positions. */
  place(joints: Float32Array): void {
    this.positions.copyArray(joints);
    this.positions.needsUpdate = true;
  }

  /** Marks the hovered, the selected and the pinned joints. */
  mark(hovered: number | null, selected: number | null, pins: ReadonlySet<number>): void {
    for (let joint = 0; joint < JOINT_COUNT; joint++)
      this.states.setX(joint, (joint === selected ? 2 : joint === hovered ? 1 : 0) + (pins.has(joint) ? 4 : 0));
    this.states.needsUpdate = true;
  }

  /**
   * Joint whose dot is nearest to a point of the view, or null when none is within reach.
   * @param x, y CSS pixels from the view's top left corner
   * @param reach CSS pixels
   */
  nearest(x: number, y: number, reach: number, camera: Camera, width: number, height: number): number | null {
    let best: { joint: number; score: number } | null = null;
    const v = new Vector3();
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      v.fromBufferAttribute(this.positions, joint).project(camera);
      if (v.z > 1) continue;
      const distance = Math.hypot(((v.x + 1) / 2) * width - x, ((1 - v.y) / 2) * height - y);
      // Of two dots about as near, the one in front wins.
      const score = distance + v.z * 2;
      if (distance <= reach && (!best || score < best.score)) best = { joint, score };
    }
    return best?.joint ?? null;
  }

  /** Frees the dots. */
  dispose(): void {
    this.points.geometry.dispose();
    this.material.dispose();
  }
}
