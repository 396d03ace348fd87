/** Loading the models, each once. */
import type { EngineName } from '../../core/document';
import type { Backend } from '../../workers/protocol';
import type { Context } from '../context';
import type { LoadProgress, ModelInfo } from '../ports';

/**
 * Makes the way to load a model; one that is loaded or on its way is not asked for again.
 * @param awaited - True while somebody waits for a dance, so that the progress is shown.
 */
export function modelLoader({ state, services }: Context, awaited: () => boolean) {
  const loading = new Map<EngineName, { backend: Backend | undefined; promise: Promise<ModelInfo> }>();

  return (backend = services.forcedBackend, engine: EngineName = 'light'): Promise<ModelInfo> => {
    const before = loading.get(engine);
    if (before && before.backend === backend) return before.promise;
    const onProgress = (progress: LoadProgress) => {
      if (awaited()) state.generation.value = { status: 'loading', ...progress };
    };
    const promise = services.engine
      .load(backend, onProgress, ...(engine === 'light' ? [] : [engine]))
      .then((info) => (state.model.value = info));
    loading.set(engine, { backend, promise });
    // A failed download must not be remembered: the next press of Generate tries again.
    promise.catch(() => {
      if (loading.get(engine)?.promise === promise) loading.delete(engine);
    });
    return promise;
  };
}
