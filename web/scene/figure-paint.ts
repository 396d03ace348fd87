/** How the styles of the figure are painted: pieces of shader, by rest-pose position, so that edges stay sharp at any mesh resolution. */
import { jointIndex } from '../core/skeleton';
import { REST } from './rest';

const height = (name: string) => REST[jointIndex(name) * 3 + 1].toFixed(4);
const reach = (name: string) => REST[jointIndex(name) * 3].toFixed(4);

/** For all styles. `vSurface` is openness and part. */
export const DECLARATIONS = /* glsl */ `
uniform vec3 bodyColour, leftColour, rightColour, visorColour;
varying vec3 vRest;
varying vec2 vSurface;
float softBox(vec3 ray, vec3 towards, float size, float blur) {
  return smoothstep(size - blur, size + blur, dot(ray, towards));
}
// About a pixel wide, wherever the eye is.
float edge(float x) {
  return smoothstep(-0.6, 0.6, x / max(fwidth(x), 1e-5));
}`;

const WHERE = /* glsl */ `
float part = floor(vSurface.y + 0.5);
float reach = abs(vRest.x);
vec3 side = vRest.x > 0.0 ? leftColour : rightColour;`;

/** Satin; the limbs take their side's colour towards the ends. */
const STUDIO = /* glsl */ `
float onArm = smoothstep(${reach('left_shoulder')} - 0.03, ${reach('left_wrist')} + 0.02, reach);
float onLeg = (1.0 - smoothstep(${height('left_ankle')}, ${height('left_hip')} + 0.03, vRest.y)) * (1.0 - step(0.4, reach));
float tint = max(onArm, onLeg);
float paintRoughness = 0.55;
vec3 paint = mix(bodyColour, side, 0.8 * tint);
// Gloves and shoes are painted on, so that their edges are clean whatever the mesh below them.
float cuff = reach > 0.4 ? reach - (${reach('left_wrist')} - 0.058) : ${height('left_ankle')} + 0.06 + 0.25 * (vRest.z + 0.04) - vRest.y;
float covered = part < 0.5 || part > 2.5 ? edge(cuff) : 0.0;
paint = mix(paint, side * 0.88, covered);
paintRoughness = mix(paintRoughness, 0.42, covered);
if (part > 3.5) {
  paint = mix(paint, bodyColour, 1.0 - edge(vRest.y - 0.017));
} else if (part > 1.5 && part < 2.5) {
  paint = visorColour;
  paintRoughness = 0.14;
} else if (part > 0.5 && part < 1.5 && reach > 0.0725) {
  paint = side;
}`;

/** Plasticine: whole limbs in their side's colour, pressed on at shoulders and hips, two dots for eyes. */
const CLAY = /* glsl */ `
float seamArm = reach - (${reach('left_shoulder')} - 0.005);
float seamLeg = (${height('left_hip')} + 0.045) + 0.35 * (reach - 0.08) - vRest.y;
float seam = reach > 0.4 || vRest.y > ${height('spine2')} ? seamArm : max(seamLeg, reach > 0.3 ? 1.0 : seamLeg);
float onHead = step(${height('neck')} + 0.03, vRest.y) * (1.0 - step(0.13, reach));
float limb = onHead > 0.5 ? 0.0 : edge(seam);
vec3 paint = mix(bodyColour * vec3(1.0, 0.95, 0.88), side, limb);
paint *= 1.0 - 0.4 * (1.0 - onHead) * (1.0 - smoothstep(0.0, 0.006, abs(seam)));
// Lumps that a thumb leaves: slow waves, darker where they dip.
float dents = sin(vRest.x * 61.0 + sin(vRest.y * 43.0)) * sin(vRest.y * 57.0 + sin(vRest.z * 49.0)) * sin(vRest.z * 67.0 + 1.7 * sin(vRest.x * 37.0));
paint *= 1.0 + 0.09 * dents;
if (onHead > 0.5 && vRest.z > 0.02) {
  vec2 eye = vec2(reach - 0.031, vRest.y - (${height('head')} + 0.094));
  paint = mix(paint, visorColour, 1.0 - edge(length(eye * vec2(1.0, 0.72)) - 0.0092));
}
float paintRoughness = 0.92;`;

/** Turned beech; the balls of the joints lacquered in their side's colour. */
const MANNEQUIN = /* glsl */ `
float along = reach > 0.25 && vRest.y > 1.0 ? vRest.x : vRest.y;
vec2 across = reach > 0.25 && vRest.y > 1.0 ? vec2(vRest.y, vRest.z) : vec2(vRest.x, vRest.z);
float rings = length(across + vec2(0.011, 0.16)) * 520.0 + 2.4 * sin(along * 13.0);
float grain = sin(rings) * clamp(1.4 - fwidth(rings) * 0.45, 0.0, 1.0);
vec3 wood = mix(vec3(0.64, 0.39, 0.195), vec3(0.82, 0.565, 0.325), 0.62 + 0.2 * grain);
vec3 paint = part > 0.5 ? (part > 1.5 ? vec3(0.20, 0.105, 0.05) : side) : wood;
float paintRoughness = part > 0.5 ? 0.3 : 0.5;`;

/** The paint of a style: sets `diffuseColor` and `paintRoughness`. */
export const PAINTS = { studio: STUDIO, clay: CLAY, mannequin: MANNEQUIN } as const;

/** GLSL that paints one of the lit styles. */
export function paintOf(style: keyof typeof PAINTS): string {
  return `${WHERE}\n${PAINTS[style]}\ndiffuseColor.rgb = paint;`;
}

/** Reflections of three soft boxes and a sheen at grazing angles: what an environment map would give, without the wait for one. */
const GLOSS = /* glsl */ `
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

/** Nothing shines on clay; light that goes in comes out again near by, so that its shadows are soft and warm. */
const MATTE = /* glsl */ `
float open = vSurface.x;
float facing = clamp(dot(geometryNormal, geometryViewDir), 0.0, 1.0);
reflectedLight.indirectDiffuse *= mix(1.0, open, 0.75);
reflectedLight.indirectDiffuse += diffuseColor.rgb * (0.16 * open * (1.0 - facing) + 0.05) * vec3(1.0, 0.86, 0.74);
reflectedLight.directDiffuse *= mix(1.0, open, 0.3);
reflectedLight.directSpecular *= 0.3;`;

/** What the surroundings add to the light on a style. */
export const SURROUNDINGS = { studio: GLOSS, mannequin: GLOSS, clay: MATTE } as const;
