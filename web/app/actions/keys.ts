/** Key poses on the timeline: add, change, delete, undo. Moving and copying: key-moves.ts. */
import { checkKeyPoses, frameOf, nextKeyId } from '../../core/document';
import { deleteKeys, editKeys, lastKeyTime, setStrength, settleKeys, toggleLock, withIds } from '../../core/key-ops';
import { mirrorPose } from '../../core/skeleton';
import { snapTime } from '../../core/snap';
import type { KeyPose } from '../../core/types';
import type { Context } from '../context';
import { idsOnStage } from './curves';
import { keyMoves } from './key-moves';
import { keySelection } from './key-selection';

/** Said when something locked should have changed. */
const LOCKED_NOTICE = 'That key pose is locked and stays as it is: unlock it first.';

const plural = (count: number) => (count === 1 ? 'key pose' : `${count} key poses`);

/** Actions on key poses. */
export function keyActions(context: Context) {
  const { state, history } = context;
  let strengthDrag = false;

  const keysNow = () => state.document.value.keyPoses;
  const setKeys = (label: string, keys: readonly KeyPose[]) =>
    context.change(label, (document) =>
      keys === document.keyPoses ? document : { ...document, keyPoses: keys as KeyPose[] },
    );
  const chosenKeys = (ids: ReadonlySet<string> = state.selection.value) => keysNow().filter((key) => ids.has(key.id));
  /** Says why locked ones among these stay. Returns false when there is none to work on. */
  const allowed = (ids: ReadonlySet<string>): boolean => {
    const chosen = chosenKeys(ids);
    const locked = chosen.filter((key) => key.locked).length;
    if (locked === 1 && chosen.length === 1) context.notify('info', LOCKED_NOTICE);
    else if (locked > 0) {
      context.notify(
        'info',
        `${locked === chosen.length ? 'These key poses are locked and stay' : `${locked} of them ${locked === 1 ? 'is' : 'are'} locked and stay${locked === 1 ? 's' : ''}`} as ${locked === 1 ? 'it is' : 'they are'}: unlock first.`,
      );
    }
    return locked < chosen.length;
  };
  const tools = { keysNow, setKeys, chosenKeys, allowed };
  const selection = keySelection(context);
  const moves = keyMoves(context, tools);

  return {
    ...selection,
    ...moves,

    /** Where a pose lands that is put at a time: on what key poses snap to, unless `exact`. */
    snapTime: (time: number, exact = false): number =>
      exact ? time : snapTime(state.grid.value, time, state.snap.value),

    /**
     * Puts a pose on the timeline and selects it. Without `exact` it snaps. Returns its id, or '' when a locked key pose is there:
     * then nothing happens.
     */
    addKey(rotations: readonly number[], time: number, options: { name?: string; exact?: boolean } = {}): string {
      const snapped = this.snapTime(time, options.exact);
      const at = Math.min(Math.max(snapped, 0), lastKeyTime(state.duration.value));
      const keys = keysNow();
      const replaced = keys.find((key) => frameOf(key.time) === frameOf(at));
      if (replaced?.locked) {
        context.notify('info', 'The key pose there is locked: unlock it to put another in its place.');
        return '';
      }
      const id = nextKeyId([...keys, ...idsOnStage(state).map((taken) => ({ id: taken }))]);
      const key: KeyPose = { id, time: at, rotations: [...rotations] };
      if (options.name) key.name = options.name;
      setKeys(replaced ? 'Replace key pose' : 'Add key pose', settleKeys(keys, [key], state.duration.value));
      selection.selectKey(id);
      context.announce(
        `${options.name ?? 'Pose'} ${replaced ? 'replaces the pose' : 'added'} at ${at.toFixed(2)} seconds.`,
      );
      return id;
    },

    /** Deletes the selected key poses, or those given. */
    deleteKeys(ids: ReadonlySet<string> = state.selection.value): void {
      if (!allowed(ids)) return;
      const before = keysNow();
      const left = deleteKeys(before, ids);
      const count = before.length - left.length;
      setKeys(`Delete ${plural(count)}`, left);
      context.announce(`${plural(count)} deleted.`);
    },

    /** Mirrors the selected key poses. */
    mirrorKeys(): void {
      const ids = state.selection.value;
      if (!allowed(ids)) return;
      setKeys(
        'Mirror key pose',
        editKeys(keysNow(), ids, (key) => ({ ...key, rotations: mirrorPose(key.rotations) })),
      );
    },

    /** Gives a key pose other rotations. Returns false when it is locked. */
    updateKey(id: string, rotations: readonly number[]): boolean {
      if (!allowed(new Set([id]))) return false;
      setKeys(
        'Edit key pose',
        editKeys(keysNow(), new Set([id]), (key) => ({ ...key, rotations: [...rotations] })),
      );
      return true;
    },

    /** Names a key pose; an empty name takes its name away. */
    renameKey(id: string, name: string): void {
      const ids = new Set([id]);
      const text = name.trim().slice(0, 200);
      const key = keysNow().find((each) => each.id === id);
      if (!key || (key.name ?? '') === text || !allowed(ids)) return;
      const edited: KeyPose = { ...key, name: text };
      if (!text) delete edited.name;
      setKeys(
        'Rename key pose',
        editKeys(keysNow(), ids, () => edited),
      );
    },

    /** Shows what another strength of the selected key poses would do; `setKeyStrength` ends it. */
    previewKeyStrength(value: number): void {
      if (!strengthDrag || !history.capturing) {
        if (!allowed(state.selection.value)) return;
        history.capture();
        strengthDrag = true;
      }
      history.preview({
        ...history.present,
        keyPoses: setStrength(history.present.keyPoses, state.selection.value, value) as KeyPose[],
      });
      context.sync();
    },

    /** How strongly the dance holds to the selected key poses, 0..1 times the dial: one step of undo. */
    setKeyStrength(value: number): void {
      this.previewKeyStrength(value);
      if (!strengthDrag) return;
      strengthDrag = false;
      history.commit('Key pose strength');
      context.sync();
    },

    /** Locks the selected key poses; unlocks them when all are locked. */
    toggleLock(): void {
      const chosen = chosenKeys();
      if (chosen.length === 0) return;
      const lock = chosen.some((key) => !key.locked);
      setKeys(`${lock ? 'Lock' : 'Unlock'} ${plural(chosen.length)}`, toggleLock(keysNow(), state.selection.value));
      context.announce(`${plural(chosen.length)} ${lock ? 'locked' : 'unlocked'}.`);
    },

    /** Replaces all key poses by checked ones from outside; throws and changes nothing when they are wrong. */
    setKeyPoses(input: unknown): void {
      const named = withIds(input, keysNow(), idsOnStage(state));
      const keys = checkKeyPoses(named, state.duration.value || Infinity);
      setKeys('Set key poses', keys);
      state.selection.value = new Set();
    },

    /** Takes the last step back. Inside a drag only the drag. */
    undo(): void {
      const label = history.undoLabel;
      if (!history.undo()) return;
      moves.forgetMove();
      context.sync();
      context.announce(`Undone: ${label ?? 'drag'}.`);
    },

    /** Brings the last undone step again. */
    redo(): void {
      if (!history.redo()) return;
      context.sync();
      context.announce(`Redone: ${history.undoLabel ?? 'change'}.`);
    },
  };
}
