import type { State } from '../../app/state';
import type { Motion } from '../../core/types';

/** The dance that is seen at a time: the new one as far as it is made, the former one beyond; or the one held for comparison. */
export function motionAt(state: State, time: number): Motion | null {
  const held = state.compare.value?.shown === 'a';
  const partial = held ? null : state.partial.value;
  if (partial && time * partial.fps < partial.frames) return partial;
  const dance = state.onStage.value;
  return dance && dance.motion.frames > 0 ? dance.motion : null;
}
