import {
  BackSide,
  CircleGeometry,
  Color,
  Mesh,
  ShaderMaterial,
  SphereGeometry,
  UniformsLib,
  UniformsUtils,
  Vector4,
} from 'three';
import { jointIndex } from '../core/skeleton';

/** Background of the stage: what the floor fades into. */
const STAGE_COLOURS = { top: new Color('#0a0c11'), horizon: new Color('#171a21'), floor: new Color('#30333b') };

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

/** Shadows of our figure end so far from the middle of the light, metres. */
const SHADOW_REACH = 2.6;

/** The floor: a soft pool of light with a fading grid, contact shadows under the body and a glow on the beat. */
export class Floor {
  readonly mesh: Mesh;
  private readonly blockers = BLOCKERS.map(() => new Vector4());
  private size = 1;
  private readonly uniforms = {
    blockers: { value: this.blockers },
    glow: { value: 0 },
    reach: { value: SHADOW_REACH },
    horizon: { value: STAGE_COLOURS.horizon },
    ground: { value: STAGE_COLOURS.floor },
  };

  constructor() {
    // Unlit but for the shadow: the lamps' pool of light is painted, which costs a fraction of lighting a screenful of pixels.
    const material = new ShaderMaterial({
      lights: true,
      transparent: true,
      dithering: true,
      uniforms: Object.assign(UniformsUtils.clone(UniformsLib.lights), this.uniforms),
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
    });
    this.mesh = new Mesh(new CircleGeometry(9, 64), material);
    this.mesh.rotation.x = -Math.PI / 2;
    this.mesh.receiveShadow = true;
    this.mesh.renderOrder = -1;
  }

  /** Keeps the pool of light under the camera's target; the grid stays where it is. */
  follow(x: number, z: number): void {
    this.mesh.position.set(x, 0, z);
  }

  /** Makes shadows fit a dancer so many times our figure's height. */
  fit(size: number): void {
    this.size = size;
    this.uniforms.reach.value = SHADOW_REACH * Math.max(1, size);
  }

  /** Places the contact shadows. `joints` is 24 x 3 world positions, metres. */
  shade(joints: Float32Array): void {
    BLOCKERS.forEach(([joint, own], i) => {
      const radius = own * this.size;
      const [x, y, z] = joints.subarray(joint * 3, joint * 3 + 3);
      this.blockers[i].set(x, Math.max(y, radius * 0.6), z, radius);
    });
  }

  /** Strength of the beat's glow, 0..1. */
  set glow(value: number) {
    this.uniforms.glow.value = value;
  }

  /** Frees the floor. */
  dispose(): void {
    this.mesh.geometry.dispose();
    (this.mesh.material as ShaderMaterial).dispose();
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

const VERTEX = /* glsl */ `
#include <common>
#include <shadowmap_pars_vertex>
varying vec3 vFloor;
varying vec2 vLocal;
void main() {
  #include <beginnormal_vertex>
  #include <defaultnormal_vertex>
  #include <begin_vertex>
  #include <project_vertex>
  #include <worldpos_vertex>
  #include <shadowmap_vertex>
  vFloor = worldPosition.xyz;
  vLocal = position.xy;
}`;

const FRAGMENT = /* glsl */ `
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <lights_pars_begin>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
uniform vec4 blockers[${BLOCKERS.length}];
uniform float glow, reach;
uniform vec3 horizon, ground;
varying vec3 vFloor;
varying vec2 vLocal;

float gridLine(vec2 at, float width) {
  vec2 cell = abs(fract(at - 0.5) - 0.5);
  vec2 w = fwidth(at);
  vec2 line = 1.0 - smoothstep(vec2(width) - w * 0.5, vec2(width) + w, cell);
  // Lines thinner than a pixel fade instead of flickering.
  line *= min(vec2(1.0), 2.0 * width / w);
  return max(line.x, line.y);
}

// Share of the sky over this point that the body leaves free (a ball over a plane hides cosine times solid angle).
float openSky() {
  float open = 1.0;
  for (int i = 0; i < ${BLOCKERS.length}; i++) {
    vec3 d = blockers[i].xyz - vFloor;
    float r2 = blockers[i].w * blockers[i].w;
    float l2 = max(dot(d, d), r2);
    open *= 1.0 - 0.9 * clamp(d.y * r2 * inversesqrt(l2) / l2, 0.0, 1.0);
  }
  return open;
}

void main() {
  float away2 = dot(vLocal, vLocal);
  float away = sqrt(away2);
  vec3 light = ground * mix(0.3, 1.0, exp(-away2 * 0.3)) * 1.35;
  float lines = gridLine(vFloor.xz, 0.005) * exp(-away2 * 0.11);
  if (away < reach) {
    float open = openSky();
    light *= mix(0.25, 1.0, open) * mix(0.5, 1.0, getShadowMask());
    lines *= open;
    if (glow > 0.0) {
      float ring = exp(-pow2((away - 0.55 - 0.75 * (1.0 - glow)) * 5.0)) + 0.5 * exp(-away2 * 1.4);
      light += vec3(0.11, 0.095, 0.23) * ring * glow * glow;
    }
  }
  light += vec3(0.055, 0.0625, 0.08) * lines;
  // Far off the floor takes the backdrop's colour before it fades, so that no dark band is left between them.
  light = mix(light, horizon, smoothstep(1.2, 7.0, away));
  gl_FragColor = vec4(light, 1.0 - smoothstep(4.0, 8.8, away));
  #include <colorspace_fragment>
  #include <dithering_fragment>
}`;
