/** Posing by keyboard: with the stage focused, arrow keys turn or move the chosen joint and go through the skeleton. */
import type { Store } from '../../app/store';
import { JOINTS, MIRROR, PARENTS } from '../../core/skeleton';
import type { Stage } from '../../scene/stage';

/** Degrees of one press, and with Shift. */
const TURN = { fine: 5, coarse: 15 };
/** Metres of one press, and with Shift. */
const MOVE = { fine: 0.02, coarse: 0.1 };

/** Axis and sign of each key: left and right, up and down, nearer and further. */
const MOVES: Readonly<Record<string, readonly [number, number, number]>> = {
  ArrowRight: [1, 0, 0],
  ArrowLeft: [-1, 0, 0],
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  PageUp: [0, 0, -1],
  PageDown: [0, 0, 1],
};
const TURNS: Readonly<Record<string, readonly ['x' | 'y' | 'z', 1 | -1]>> = {
  ArrowRight: ['y', 1],
  ArrowLeft: ['y', -1],
  ArrowUp: ['x', -1],
  ArrowDown: ['x', 1],
  PageUp: ['z', 1],
  PageDown: ['z', -1],
};

/** The joint that an arrow key goes to from another one: to its parent, its first child, or the other side. */
export function neighbourJoint(joint: number, key: string): number {
  if (key === 'ArrowUp') return Math.max(PARENTS[joint], 0);
  // The spine's first child goes on up the spine: the pelvis and the chest have limbs beside it.
  if (key === 'ArrowDown') {
    const children = JOINTS.flatMap((name, index) => (PARENTS[index] === joint ? [{ name, index }] : []));
    const middle = children.find(({ index }) => MIRROR[index] === index);
    return (middle ?? children[0])?.index ?? joint;
  }
  if (MIRROR[joint] !== joint) return MIRROR[joint];
  // From the middle, left and right go out to the limb of that side.
  const side = key === 'ArrowLeft' ? 'right_' : 'left_';
  const limb = JOINTS.findIndex((name, index) => PARENTS[index] === joint && name.startsWith(side));
  return limb < 0 ? joint : limb;
}

/** Handles a key on the focused stage. Returns whether it was one. */
export function onStageKey(event: KeyboardEvent, stage: Stage, store: Store): boolean {
  const draft = store.state.draft.value;
  if (!draft || event.altKey || !(event.key in MOVES)) return false;
  const { joint } = draft;
  if (joint === null || event.ctrlKey || event.metaKey) {
    store.selectJoint(joint === null ? 0 : neighbourJoint(joint, event.key));
    return true;
  }
  if (store.state.poseTools.value.mode === 'move') {
    const step = event.shiftKey ? MOVE.coarse : MOVE.fine;
    const [x, y, z] = MOVES[event.key];
    stage.moveSelected(x * step, y * step, z * step);
  } else {
    const [axis, sign] = TURNS[event.key];
    stage.rotateSelected(axis, (sign * (event.shiftKey ? TURN.coarse : TURN.fine) * Math.PI) / 180);
  }
  return true;
}
