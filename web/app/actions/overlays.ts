/** What is drawn around the figure to show time: ghosts of the neighbouring key poses, the path of a joint. */
import { jointIndex } from '../../core/skeleton';
import type { Context } from '../context';

/** Actions on the overlays of the stage. */
export function overlayActions({ state, announce }: Context) {
  let lastJoint = jointIndex('right_hand');
  return {
    /** Neighbouring key poses as ghosts: shown or hidden. */
    toggleOnion(shown = !state.onionShown.value): void {
      state.onionShown.value = shown;
      announce(shown ? 'Ghosts of the neighbouring key poses are shown.' : 'Ghosts are hidden.');
    },
    /** The path of a joint: shown (of the joint that was chosen last) or hidden. */
    togglePath(shown = state.pathJoint.value === null): void {
      state.pathJoint.value = shown ? lastJoint : null;
      announce(shown ? 'The path of a joint is shown.' : 'The path is hidden.');
    },
    /** Shows the path of this joint. */
    showPathOf(joint: number): void {
      lastJoint = joint;
      state.pathJoint.value = joint;
    },
  };
}
