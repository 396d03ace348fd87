import type { State } from '../../app/state';
import type { Motion } from '../../core/types';

/** The dance that is seen at a time: the new one as far as it is made, the former one beyond. */
export function motionAt(state: State, time: number): Motion | null {
  const partial = state.partial.value;
  if (partial && time * partial.fps < partial.frames) return partial;
  const dance = state.dance.value;
  return dance && dance.motion.frames > 0 ? dance.motion : null;
}
