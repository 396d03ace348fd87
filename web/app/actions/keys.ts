/** Key poses on the timeline: add, move, delete, select, undo. */
import { checkKeyPoses, frameOf, nextKeyId, sortKeys } from '../../core/document';
import { mirrorPose } from '../../core/skeleton';
import spec from '../../core/spec.json';
import type { KeyPose } from '../../core/types';
import type { Context } from '../context';
import { nearestBeat, stepBeat } from '../snapping';

const FRAME = 1 / spec.fps;

/** Actions on key poses. */
export function keyActions(context: Context) {
  const { state, history } = context;
  let dragOrigin: KeyPose[] | null = null;

  const clampTime = (time: number) => Math.min(Math.max(time, 0), Math.max(0, state.duration.value - FRAME));
  const setKeys = (label: string, keyPoses: KeyPose[]) =>
    context.change(label, (document) => ({ ...document, keyPoses: sortKeys(keyPoses) }));
  const selectOnly = (id: string) => (state.selection.value = new Set([id]));

  const moved = (keys: readonly KeyPose[], ids: ReadonlySet<string>, to: (key: KeyPose) => number): KeyPose[] => {
    const still = keys.filter((key) => !ids.has(key.id));
    // Moved ones come last: sortKeys lets the last of two on one frame stay.
    return [...still, ...keys.filter((key) => ids.has(key.id)).map((key) => ({ ...key, time: clampTime(to(key)) }))];
  };

  return {
    /** Puts a pose on the timeline and selects it. Without `exact` it snaps to the nearest beat. Returns its id. */
    addKey(rotations: readonly number[], time: number, options: { name?: string; exact?: boolean } = {}): string {
      const at = clampTime(options.exact ? time : nearestBeat(state.grid.value, time));
      const { keyPoses } = state.document.value;
      const replaced = keyPoses.find((key) => frameOf(key.time) === frameOf(at));
      const id = nextKeyId(keyPoses);
      const key: KeyPose = { id, time: at, rotations: [...rotations] };
      if (options.name) key.name = options.name;
      setKeys(replaced ? 'Replace key pose' : 'Add key pose', [...keyPoses, key]);
      selectOnly(id);
      context.announce(
        `${options.name ?? 'Pose'} ${replaced ? 'replaces the pose' : 'added'} at ${at.toFixed(2)} seconds.`,
      );
      return id;
    },

    /** Deletes the selected key poses, or those given. */
    deleteKeys(ids: ReadonlySet<string> = state.selection.value): void {
      const { keyPoses } = state.document.value;
      const left = keyPoses.filter((key) => !ids.has(key.id));
      const count = keyPoses.length - left.length;
      if (count === 0) return;
      setKeys(count === 1 ? 'Delete key pose' : `Delete ${count} key poses`, left);
      state.selection.value = new Set();
      context.announce(`${count} key pose${count === 1 ? '' : 's'} deleted.`);
    },

    /** Selects one key pose; `extend` adds it or takes it out. Never a step of undo. */
    selectKey(id: string | null, extend = false): void {
      if (id === null) state.selection.value = new Set();
      else if (!extend) selectOnly(id);
      else {
        const next = new Set(state.selection.value);
        if (!next.delete(id)) next.add(id);
        state.selection.value = next;
      }
    },

    /** Selects all key poses. */
    selectAll(): void {
      state.selection.value = new Set(state.document.value.keyPoses.map((key) => key.id));
    },

    /** A drag of the selected key poses begins. */
    beginMove(): void {
      dragOrigin = state.document.value.keyPoses;
      history.capture();
    },

    /** The dragged key poses, `seconds` from where they began; the one named by `anchor` snaps to a beat unless `exact`. */
    previewMove(seconds: number, anchor: string, exact: boolean): void {
      if (!dragOrigin || !history.capturing) return;
      const ids = state.selection.value;
      const lead = dragOrigin.find((key) => key.id === anchor);
      if (!lead) return;
      const target = clampTime(exact ? lead.time + seconds : nearestBeat(state.grid.value, lead.time + seconds));
      const shift = target - lead.time;
      const keyPoses = sortKeys(moved(dragOrigin, ids, (key) => key.time + shift));
      history.preview({ ...history.present, keyPoses: shift === 0 ? dragOrigin : keyPoses });
      context.sync();
    },

    /** The drag ends where it is: one step of undo. */
    commitMove(): void {
      if (!dragOrigin) return;
      if (state.document.value.keyPoses === dragOrigin) history.discard();
      else history.commit('Move key pose');
      dragOrigin = null;
      context.sync();
    },

    /** The drag never happened. */
    discardMove(): void {
      if (!dragOrigin) return;
      dragOrigin = null;
      history.discard();
      context.sync();
    },

    /** Moves the selected key poses by a beat or a frame; direction is -1 or 1. */
    nudgeKeys(direction: -1 | 1, unit: 'beat' | 'frame'): void {
      const ids = state.selection.value;
      const { keyPoses } = state.document.value;
      if (!keyPoses.some((key) => ids.has(key.id))) return;
      const grid = state.grid.value;
      const next = moved(keyPoses, ids, (key) =>
        unit === 'frame' ? (frameOf(key.time) + direction) * FRAME : stepBeat(grid, key.time, direction),
      );
      setKeys('Move key pose', next);
      const first = state.document.value.keyPoses.find((key) => ids.has(key.id));
      if (first) context.announce(`Key pose at ${first.time.toFixed(2)} seconds.`);
    },

    /** Mirrors the selected key poses. */
    mirrorKeys(): void {
      const ids = state.selection.value;
      const { keyPoses } = state.document.value;
      if (!keyPoses.some((key) => ids.has(key.id))) return;
      setKeys(
        'Mirror key pose',
        keyPoses.map((key) => (ids.has(key.id) ? { ...key, rotations: mirrorPose(key.rotations) } : key)),
      );
    },

    /** Gives a key pose other rotations. */
    updateKey(id: string, rotations: readonly number[]): void {
      const { keyPoses } = state.document.value;
      setKeys(
        'Edit key pose',
        keyPoses.map((key) => (key.id === id ? { ...key, rotations: [...rotations] } : key)),
      );
    },

    /** Replaces all key poses by checked ones from outside; throws and changes nothing when they are wrong. */
    setKeyPoses(input: unknown): void {
      const keys = checkKeyPoses(input, state.duration.value || Infinity);
      setKeys('Set key poses', keys);
      state.selection.value = new Set();
    },

    /** Takes the last step back. Inside a drag only the drag. */
    undo(): void {
      const label = history.undoLabel;
      if (!history.undo()) return;
      dragOrigin = null;
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
