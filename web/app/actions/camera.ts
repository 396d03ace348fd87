/** The camera is part of the project but not of its history: turning it is no step of undo and never wipes redo. */
import type { CameraView } from '../../core/document';
import type { Context } from '../context';

/** Actions on the camera that is kept. */
export function cameraActions({ state, history, sync }: Context) {
  return {
    /** Keeps where the visitor looks from; null = the opening view. */
    keepCamera(camera: CameraView | null): void {
      if (camera === history.present.camera) return;
      history.amend((document) => ({ ...document, camera }));
      sync();
    },

    /** The camera goes along with the dancer or stays. */
    setCameraFollows(on: boolean): void {
      state.cameraFollows.value = on;
    },
  };
}
