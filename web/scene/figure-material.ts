import { Color, MeshStandardMaterial } from 'three';
import { REST } from './rest';
import { jointIndex } from '../core/skeleton';

/** Colours of the figure. Left is cool, right is warm, the middle is neutral. */
export const PALETTE = {
  body: new Color('#dde1e8'),
  left: new Color('#6aa5ea'),
  right: new Color('#f08672'),
  visor: new Color('#0b0f17'),
};

const height = (name: string) => REST[jointIndex(name) * 3 + 1].toFixed(4);
const reach = (name: string) => REST[jointIndex(name) * 3].toFixed(4);

/**
 * Satin material whose colours are painted by rest-pose position, so that edges stay sharp at any mesh resolution.
 * Reads the geometry's `surface` attribute (openness, part).
 */
export function createFigureMaterial(): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ metalness: 0 });
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
      .replace('#include <aomap_fragment>', SURROUNDINGS);
  };
  return material;
}

const DECLARATIONS = /* glsl */ `
uniform vec3 bodyColour, leftColour, rightColour, visorColour;
varying vec3 vRest;
varying vec2 vSurface;
float softBox(vec3 ray, vec3 towards, float size, float blur) {
  return smoothstep(size - blur, size + blur, dot(ray, towards));
}`;

const PAINT = /* glsl */ `
float part = floor(vSurface.y + 0.5);
float reach = abs(vRest.x);
vec3 side = vRest.x > 0.0 ? leftColour : rightColour;
float onArm = smoothstep(${reach('left_shoulder')} - 0.03, ${reach('left_wrist')} + 0.02, reach);
float onLeg = (1.0 - smoothstep(${height('left_ankle')}, ${height('left_hip')} + 0.03, vRest.y)) * (1.0 - step(0.4, reach));
float tint = max(onArm, onLeg);
float paintRoughness = 0.55;
vec3 paint = mix(bodyColour, side, 0.8 * tint);
// Gloves and shoes are painted on, so that their edges are clean whatever the mesh below them.
float cuff = reach > 0.4 ? reach - (${reach('left_wrist')} - 0.058) : ${height('left_ankle')} + 0.06 + 0.25 * (vRest.z + 0.04) - vRest.y;
float covered = part < 0.5 || part > 2.5 ? smoothstep(-0.6, 0.6, cuff / max(fwidth(cuff), 1e-5)) : 0.0;
paint = mix(paint, side * 0.88, covered);
paintRoughness = mix(paintRoughness, 0.42, covered);
if (part > 3.5) {
  paint = mix(paint, bodyColour, 1.0 - smoothstep(-0.6, 0.6, (vRest.y - 0.017) / max(fwidth(vRest.y), 1e-5)));
} else if (part > 1.5 && part < 2.5) {
  paint = visorColour;
  paintRoughness = 0.14;
} else if (part > 0.5 && part < 1.5 && reach > 0.0725) {
  paint = side;
}
diffuseColor.rgb = paint;`;

/** Reflections of three soft boxes and a sheen at grazing angles: what an environment map would give, without the wait for one. */
const SURROUNDINGS = /* glsl */ `
float open = vSurface.x;
vec3 ray = inverseTransformDirection(reflect(-geometryViewDir, geometryNormal), viewMatrix);
float grazing = pow(1.0 - clamp(dot(geometryNormal, geometryViewDir), 0.0, 1.0), 4.0);
float blur = 0.04 + 0.5 * material.roughness;
float boxes = 1.4 * softBox(ray, vec3(0.30, 0.81, 0.50), 0.80, blur)
  + 0.7 * softBox(ray, vec3(-0.90, 0.25, 0.36), 0.86, blur)
  + 0.5 * softBox(ray, vec3(0.93, 0.20, -0.30), 0.86, blur);
float mirror = (0.04 + 0.5 * grazing) * (1.0 - 0.75 * material.roughness);
reflectedLight.indirectSpecular += mirror * open * (boxes * vec3(1.0, 0.98, 0.95) + vec3(0.10, 0.12, 0.16) * (ray.y * 0.5 + 0.7));
reflectedLight.indirectDiffuse *= mix(1.0, open, 0.6);
reflectedLight.indirectDiffuse += diffuseColor.rgb * vec3(0.55, 0.62, 0.8) * 0.22 * grazing * open;
reflectedLight.directDiffuse *= mix(1.0, open, 0.2);`;
