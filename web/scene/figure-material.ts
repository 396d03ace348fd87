import { Color, MeshPhysicalMaterial } from 'three';
import { REST } from './rest';
import { jointIndex } from '../core/skeleton';

/** Colours of the figure. Left is cool, right is warm, the middle is neutral. */
export const PALETTE = {
  body: new Color('#d9d6d0'),
  left: new Color('#7fb0e6'),
  right: new Color('#ee8f7c'),
  visor: new Color('#0d1118'),
};

const height = (name: string) => REST[jointIndex(name) * 3 + 1].toFixed(4);
const reach = (name: string) => REST[jointIndex(name) * 3].toFixed(4);

/**
 * Satin material whose colours are painted by rest-pose position, so that edges stay sharp at any mesh resolution.
 * Reads the geometry's `surface` attribute (openness, part).
 */
export function createFigureMaterial(): MeshPhysicalMaterial {
  const material = new MeshPhysicalMaterial({ roughness: 0.5, metalness: 0, sheen: 0.25, sheenRoughness: 0.6 });
  material.onBeforeCompile = (shader) => {
    for (const [name, colour] of Object.entries(PALETTE)) shader.uniforms[`${name}Colour`] = { value: colour };
    shader.vertexShader = shader.vertexShader
      .replace(
        '#include <common>',
        '#include <common>\nattribute vec2 surface;\nvarying vec3 vRest;\nvarying vec2 vSurface;',
      )
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvRest = position;\nvSurface = surface;');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>\n${DECLARATIONS}`)
      .replace('#include <color_fragment>', `#include <color_fragment>\n${PAINT}`)
      .replace(
        '#include <roughnessmap_fragment>',
        '#include <roughnessmap_fragment>\nroughnessFactor = paintRoughness;',
      )
      .replace('#include <aomap_fragment>', OCCLUSION);
  };
  return material;
}

const DECLARATIONS = /* glsl */ `
uniform vec3 bodyColour, leftColour, rightColour, visorColour;
varying vec3 vRest;
varying vec2 vSurface;
// 1 on a thin line where the value passes zero, as wide as \`width\` metres and never thinner than a pixel.
float seam(float value, float width) {
  float w = max(width, fwidth(value));
  return 1.0 - smoothstep(0.4 * w, w, abs(value));
}`;

const PAINT = /* glsl */ `
float part = floor(vSurface.y + 0.5);
float reach = abs(vRest.x);
vec3 side = vRest.x > 0.0 ? leftColour : rightColour;
float onArm = smoothstep(${reach('left_shoulder')} - 0.02, ${reach('left_elbow')} + 0.1, reach);
float onLeg = smoothstep(${height('left_hip')} - 0.02, ${height('left_knee')} - 0.12, vRest.y) * (1.0 - step(0.4, reach));
float tint = max(onArm, onLeg) * 0.62;
float paintRoughness = 0.52;
vec3 paint = mix(bodyColour, side, tint);
if (part > 2.5) {
  paint = side * 0.86;
  paintRoughness = 0.42;
  if (part > 3.5) {
    // A pale sole under the shoe.
    float sole = 1.0 - smoothstep(-0.001, 0.001, vRest.y - 0.016);
    paint = mix(paint, bodyColour * 0.92, sole);
  }
} else if (part > 1.5) {
  paint = visorColour;
  paintRoughness = 0.12;
}
diffuseColor.rgb = paint;`;

const OCCLUSION = /* glsl */ `
float ambientOcclusion = mix(1.0, vSurface.x, 0.8);
reflectedLight.indirectDiffuse *= ambientOcclusion;
reflectedLight.directDiffuse *= mix(1.0, vSurface.x, 0.35);
reflectedLight.indirectSpecular *= ambientOcclusion;`;
