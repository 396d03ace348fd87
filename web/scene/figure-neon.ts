/** The style `neon`: a body of night, drawn by its glowing outline. Unlit, so that it costs less than a lit one. */
import { type Color, ShaderMaterial } from 'three';
import { jointIndex } from '../core/skeleton';
import { REST } from './rest';

const at = (name: string, axis: number) => REST[jointIndex(name) * 3 + axis].toFixed(4);

/** The colours are the tubes', linear. */
export interface NeonColours {
  body: Color;
  left: Color;
  right: Color;
}

/** Reads the geometry's `surface` attribute (openness, part). */
export function createNeonMaterial({ body, left, right }: NeonColours): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { bodyColour: { value: body }, leftColour: { value: left }, rightColour: { value: right } },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
  });
}

const VERTEX = /* glsl */ `
#include <common>
#include <skinning_pars_vertex>
attribute vec2 surface;
varying vec3 vFacing;
varying vec3 vToEye;
varying vec3 vRest;
varying vec2 vSurface;
void main() {
  #include <beginnormal_vertex>
  #include <skinbase_vertex>
  #include <skinnormal_vertex>
  #include <begin_vertex>
  #include <skinning_vertex>
  vec4 seen = viewMatrix * modelMatrix * vec4(transformed, 1.0);
  vFacing = normalMatrix * objectNormal;
  vToEye = -seen.xyz;
  vRest = position;
  vSurface = surface;
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 bodyColour, leftColour, rightColour;
varying vec3 vFacing;
varying vec3 vToEye;
varying vec3 vRest;
varying vec2 vSurface;
// A tube of light: a bright core and the glow round it. All in metres of the rest pose.
float tube(float away, float width) {
  float soft = max(fwidth(away), 1e-5);
  float core = 1.0 - smoothstep(width - soft, width + soft, abs(away));
  return core + 0.38 * exp(-abs(away) * 60.0);
}
void main() {
  float part = floor(vSurface.y + 0.5);
  float reach = abs(vRest.x);
  bool arm = reach > ${at('left_shoulder', 0)} + 0.02 && vRest.y > 1.0;
  float limb = max(
    smoothstep(${at('left_shoulder', 0)} - 0.05, ${at('left_shoulder', 0)} + 0.05, reach) * step(1.0, vRest.y),
    1.0 - smoothstep(${at('left_hip', 1)} - 0.06, ${at('left_hip', 1)} + 0.05, vRest.y));
  if (!arm && reach > 0.35 && vRest.y > 1.0) limb = 1.0;
  vec3 side = vRest.x > 0.0 ? leftColour : rightColour;
  vec3 glow = mix(bodyColour, side, limb);
  float facing = clamp(dot(normalize(vFacing), normalize(vToEye)), 0.0, 1.0);
  float rim = pow(1.0 - facing, 2.6);
  float line = smoothstep(0.62, 0.86, 1.0 - facing);
  float rings = tube(vRest.y - ${at('spine1', 1)}, 0.0035) * (1.0 - step(0.3, reach));
  rings += arm ? tube(reach - ${at('left_elbow', 0)}, 0.003) + tube(reach - ${at('left_wrist', 0)} + 0.045, 0.003) : 0.0;
  rings += vRest.y < 0.7 ? tube(vRest.y - ${at('left_knee', 1)}, 0.003) + tube(vRest.y - ${at('left_ankle', 1)} - 0.06, 0.003) : 0.0;
  float fill = part > 1.5 && part < 2.5 ? 0.85 : part > 2.5 ? 0.16 : 0.045;
  vec3 colour = vec3(0.006, 0.008, 0.014) + glow * (fill + 0.7 * rim + 1.5 * line + 1.2 * rings);
  colour += vec3(0.3) * glow * line * line;
  gl_FragColor = vec4(colour, 1.0);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
}`;
