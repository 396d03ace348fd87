/** FBX files, by way of GLB and three. Loaded only when one is asked for; runs in a worker. */
import { FBXExporter } from '@comfyorg/fbx-exporter-three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

/**
 * A GLB file of ours as binary FBX 7.4: Y up, facing +Z, a metre is 100 of FBX's centimetres.
 * @param fps frames per second of the animation's keys
 */
export async function glbToFbx(glb: Uint8Array<ArrayBuffer>, fps: number): Promise<Uint8Array<ArrayBuffer>> {
  const { scene, animations } = await new GLTFLoader().parseAsync(glb.buffer, '');
  // FBX's front axis points at the viewer; the writer's own default would turn the figure to face away.
  const options = { preset: 'maya', axisForward: '-Z', fps, animations } as const;
  return new FBXExporter().parseSync(scene, options) as Uint8Array<ArrayBuffer>;
}
