/** How light becomes colour: the same on the stage and in what is filmed there. */
import { NeutralToneMapping, PCFShadowMap, type WebGLRenderer } from 'three';

/** Sets a renderer up for the stage. */
export function applyLook(renderer: WebGLRenderer): void {
  // Reading a shader's log waits for it to be built: worth it only while developing.
  renderer.debug.checkShaderErrors = import.meta.env.DEV;
  renderer.toneMapping = NeutralToneMapping;
  renderer.toneMappingExposure = 1.05;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
}
