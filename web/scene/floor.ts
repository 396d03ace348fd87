import {
  BackSide,
  CircleGeometry,
  Color,
  Mesh,
  MeshLambertMaterial,
  ShaderMaterial,
  SphereGeometry,
  Vector4,
} from 'three';
import { jointIndex } from '../core/skeleton';

/** Background of the stage: what the floor fades into. */
export const STAGE_COLOURS = { top: new Color('#0a0c11'), horizon: new Color('#171a21'), floor: new Color('#30333b') };

/** Balls that darken the floor below them: [joint, radius in metres]. */
const BLOCKERS: [number, number][] = (
  [
    ['left_ankle', 0.045],
    ['right_ankle', 0.045],
    ['left_foot', 0.04],
    ['right_foot', 0.04],
    ['left_knee', 0.06],
    ['right_knee', 0.06],
    ['left_hand', 0.045],
    ['right_hand', 0.045],
    ['pelvis', 0.14],
    ['spine3', 0.15],
    ['head', 0.11],
  ] as const
).map(([name, radius]) => [jointIndex(name), radius]);

/** The floor: a soft pool of light with a fading grid, contact shadows under the body and a glow on the beat. */
export class Floor {
  readonly mesh: Mesh;
  private readonly blockers = BLOCKERS.map(() => new Vector4());
  private readonly uniforms = {
    blockers: { value: this.blockers },
    glow: { value: 0 },
    horizon: { value: STAGE_COLOURS.horizon },
  };

  constructor() {
    const material = new MeshLambertMaterial({
      color: STAGE_COLOURS.floor,
      transparent: true,
      dithering: true,
      toneMapped: false,
    });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', '#include <common>\nvarying vec3 vFloor;\nvarying vec2 vLocal;')
        .replace(
          '#include <begin_vertex>',
          '#include <begin_vertex>\nvFloor = (modelMatrix * vec4(position, 1.0)).xyz;\nvLocal = position.xy;',
        );
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>\n${DECLARATIONS}`)
        .replace('#include <opaque_fragment>', `${SHADE}\n#include <opaque_fragment>`);
    };
    this.mesh = new Mesh(new CircleGeometry(9, 64), material);
    this.mesh.rotation.x = -Math.PI / 2;
    this.mesh.receiveShadow = true;
    this.mesh.renderOrder = -1;
  }

  /** Keeps the pool of light under the camera's target; the grid stays where it is. */
  follow(x: number, z: number): void {
    this.mesh.position.set(x, 0, z);
  }

  /** Places the contact shadows. `joints` is 24 x 3 world positions, metres. */
  shade(joints: Float32Array): void {
    BLOCKERS.forEach(([joint, radius], i) =>
      this.blockers[i].set(
        joints[joint * 3],
        Math.max(joints[joint * 3 + 1], radius * 0.6),
        joints[joint * 3 + 2],
        radius,
      ),
    );
  }

  /** Strength of the beat's glow, 0..1. */
  set glow(value: number) {
    this.uniforms.glow.value = value;
  }

  /** Frees the floor. */
  dispose(): void {
    this.mesh.geometry.dispose();
    (this.mesh.material as MeshLambertMaterial).dispose();
  }
}

/** A dark dome that is a little lighter at the horizon. */
export function createBackdrop(): Mesh {
  const material = new ShaderMaterial({
    side: BackSide,
    depthWrite: false,
    dithering: true,
    uniforms: { top: { value: STAGE_COLOURS.top }, horizon: { value: STAGE_COLOURS.horizon } },
    vertexShader: /* glsl */ `
      varying vec3 vDirection;
      void main() {
        vDirection = position;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: /* glsl */ `
      #include <common>
      #include <dithering_pars_fragment>
      uniform vec3 top, horizon;
      varying vec3 vDirection;
      void main() {
        float up = abs(normalize(vDirection).y);
        gl_FragColor = vec4(mix(horizon, top, smoothstep(0.0, 0.55, up)), 1.0);
        #include <colorspace_fragment>
        #include <dithering_fragment>
      }`,
  });
  const mesh = new Mesh(new SphereGeometry(40, 24, 16), material);
  mesh.renderOrder = -2;
  mesh.frustumCulled = false;
  return mesh;
}

const DECLARATIONS = /* glsl */ `
uniform vec4 blockers[${BLOCKERS.length}];
uniform float glow;
uniform vec3 horizon;
varying vec3 vFloor;
varying vec2 vLocal;
float gridLine(vec2 at, float spacing, float width) {
  vec2 cell = abs(fract(at / spacing - 0.5) - 0.5) * spacing;
  vec2 w = fwidth(at);
  vec2 line = 1.0 - smoothstep(vec2(width) - w * 0.5, vec2(width) + w, cell);
  // Lines thinner than a pixel fade instead of flickering.
  line *= min(vec2(1.0), 2.0 * width / w);
  return max(line.x, line.y);
}`;

const SHADE = /* glsl */ `
float away = length(vLocal);
// Share of the sky over a floor point that each ball hides (a ball over a plane: cosine times solid angle).
float open = 1.0;
for (int i = 0; i < ${BLOCKERS.length}; i++) {
  vec3 d = blockers[i].xyz - vFloor;
  float l2 = max(dot(d, d), blockers[i].w * blockers[i].w);
  open *= 1.0 - 0.9 * clamp(max(d.y, 0.0) * blockers[i].w * blockers[i].w / (l2 * sqrt(l2)), 0.0, 1.0);
}
outgoingLight *= mix(0.3, 1.0, exp(-away * away * 0.3)) * mix(0.25, 1.0, open);
float lines = 0.5 * gridLine(vFloor.xz, 1.0, 0.005);
outgoingLight += vec3(0.11, 0.125, 0.16) * lines * exp(-away * away * 0.11) * open;
float ring = exp(-pow((away - 0.55 - 0.75 * (1.0 - glow)) * 5.0, 2.0)) + 0.5 * exp(-away * away * 1.4);
outgoingLight += vec3(0.16, 0.14, 0.34) * ring * glow * glow;
// Far off the floor takes the backdrop's colour before it fades, so that no dark band is left between them.
outgoingLight = mix(outgoingLight, horizon, smoothstep(1.2, 7.0, away));
diffuseColor.a = 1.0 - smoothstep(4.0, 8.8, away);`;
