/** The generate worker behind the app's own port, loaded only when a dance is wanted. */
import type { GenerateClient } from '../workers/generate-client';
import type { Engine, ModelInfo } from './ports';

/** @param onMove - The model had to move to another backend by itself. */
export function createEngine(onMove: (model: ModelInfo) => void = () => undefined): Engine {
  let client: Promise<GenerateClient> | null = null;
  const open = () => {
    client ??= import('../workers/generate-client').then((module) => {
      const made = new module.GenerateClient();
      made.onBackendChange = onMove;
      return made;
    });
    return client;
  };
  return {
    load: async (backend, onProgress, engine) => (await open()).load({ backend, onProgress, engine }),
    generate: async (request, onPartial, signal) => (await open()).generate(request, { onPartial, signal }),
  };
}
