/** Ties the camera to the project: a view that was turned is kept, and a project that is opened shows its own. */
import { computed, effect, untracked } from '@preact/signals';
import type { Store } from '../app/store';
import type { Stage } from '../scene/stage';

/** Starts keeping the view. Returns how to stop. */
export function bindCamera(stage: Stage, store: Store): () => void {
  const { state } = store;
  const wanted = computed(() => state.document.value.camera);
  /** The view on stage as the document knows it. */
  let shown = null as ReturnType<Stage['getView']>;
  const keep = (view: typeof shown) => {
    shown = view;
    store.keepCamera(view);
  };
  const stops = [
    stage.onView(keep),
    effect(() => {
      const camera = wanted.value;
      if (camera === shown) return;
      shown = camera;
      untracked(() => {
        store.setCameraFollows(camera?.follows ?? true);
        if (camera) stage.setView(camera);
        else stage.frameFigure();
      });
    }),
    effect(() => {
      const follows = state.cameraFollows.value;
      untracked(() => {
        if (follows !== (shown?.follows ?? true)) keep(stage.getView());
      });
    }),
  ];
  return () => {
    for (const stop of stops) stop();
  };
}
