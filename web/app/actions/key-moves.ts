/** Moving and copying key poses along the song. */
import { beatCount } from '../../core/beat-count';
import { MAX_KEY_POSES, type ProjectDocument } from '../../core/document';
import {
  copyKeysBy,
  distributeKeys,
  duplicateKeys,
  lastKeyTime,
  nudgeKeys,
  pasteKeys,
  shiftKeys,
  shiftKeysByBeats,
  type Added,
} from '../../core/key-ops';
import { snapTime } from '../../core/snap';
import type { KeyPose } from '../../core/types';
import type { Context } from '../context';
import { idsOnStage, withOwnCurves } from './curves';

/** What the actions on key poses share. */
export interface KeyTools {
  keysNow(): KeyPose[];
  setKeys(label: string, keys: readonly KeyPose[]): void;
  chosenKeys(ids?: ReadonlySet<string>): KeyPose[];
  /** Says why locked ones among these stay; false when there is none to work on. */
  allowed(ids: ReadonlySet<string>): boolean;
}

/** Actions that move and copy key poses. */
export function keyMoves(context: Context, tools: KeyTools) {
  const { state, history, services } = context;
  const { keysNow, setKeys, chosenKeys, allowed } = tools;
  let drag: { from: ProjectDocument; ids: ReadonlySet<string>; copies: string[] } | null = null;
  let clipboard: readonly KeyPose[] = [];

  const space = () => ({ duration: state.duration.value, grid: state.grid.value, takenIds: idsOnStage(state) });

  /** Makes copies one step and selects them. */
  const keepCopies = (label: string, { keys, added, left }: Added) => {
    if (keys.length > MAX_KEY_POSES) {
      context.notify('error', `A project holds at most ${MAX_KEY_POSES} key poses: delete some first.`);
      return;
    }
    if (added.length > 0) {
      setKeys(label, keys);
      state.selection.value = new Set(added);
    }
    const text = `${added.length} key pose${added.length === 1 ? '' : 's'} added.`;
    if (left > 0) {
      context.notify('info', `${left} key pose${left === 1 ? '' : 's'} would be past the end of the song: left out.`);
    }
    context.announce(text);
  };

  return {
    /** A drag of the selected key poses begins. */
    beginMove(): void {
      drag = { from: state.document.value, ids: state.selection.value, copies: [] };
      history.capture();
    },

    /**
     * The dragged key poses, `seconds` from where they began; the one named by `anchor` snaps unless `exact`, the others keep their
     * distance in beats. With `copy` the originals stay. Returns where the anchor (or its copy) is now, seconds; null outside a drag.
     */
    previewMove(seconds: number, anchor: string, exact: boolean, copy = false): number | null {
      if (!drag || !history.capturing) return null;
      const { from, ids } = drag;
      const keys = from.keyPoses;
      const lead = keys.find((key) => key.id === anchor);
      if (!lead) return null;
      const { grid, duration } = space();
      const wished = Math.min(Math.max(lead.time + seconds, 0), lastKeyTime(duration));
      const free = exact || state.snap.value === 'off';
      const target = free ? wished : snapTime(grid, wished, state.snap.value);
      const count = beatCount(grid);
      const beats = count.of(target) - count.of(lead.time);
      let next: readonly KeyPose[] = keys;
      drag.copies = [];
      if (target !== lead.time && copy) {
        const made = copyKeysBy(keys, ids, free ? { seconds: target - lead.time } : { beats }, space());
        next = made.keys;
        drag.copies = made.added;
      } else if (target !== lead.time) {
        next = free ? shiftKeys(keys, ids, target - lead.time, duration) : shiftKeysByBeats(keys, ids, beats, space());
      }
      // Changed curves of a key pose that the drag only passed over come back with it.
      const { curveEdits } = from;
      const document = { ...history.present, ...(curveEdits && { curveEdits }), keyPoses: next as KeyPose[] };
      history.preview(withOwnCurves(document));
      context.sync();
      const copied = drag.copies[keys.filter((key) => ids.has(key.id)).indexOf(lead)];
      return next.find((key) => key.id === (copied ?? anchor))?.time ?? null;
    },

    /** The drag ends where it is: one step of undo. */
    commitMove(): void {
      if (!drag) return;
      const { from, ids, copies } = drag;
      drag = null;
      if (state.document.value.keyPoses === from.keyPoses) {
        history.discard();
        allowed(ids);
      } else history.commit(copies.length > 0 ? 'Copy key pose' : 'Move key pose');
      if (copies.length > 0) state.selection.value = new Set(copies);
      context.sync();
    },

    /** The drag never happened. */
    discardMove(): void {
      if (!drag) return;
      drag = null;
      history.discard();
      context.sync();
    },

    /** Undo ended the drag. */
    forgetMove: () => void (drag = null),

    /** Moves the selected key poses by a beat or a frame; direction is -1 or 1. */
    nudgeKeys(direction: -1 | 1, unit: 'beat' | 'frame'): void {
      const ids = state.selection.value;
      if (!allowed(ids)) return;
      setKeys('Move key pose', nudgeKeys(keysNow(), ids, direction, unit, space()));
      const [first] = chosenKeys();
      if (first) context.announce(`Key pose at ${first.time.toFixed(2)} seconds.`);
    },

    /** Moves one key pose to a time, exactly. */
    setKeyTime(id: string, time: number): void {
      const key = keysNow().find((each) => each.id === id);
      const ids = new Set([id]);
      if (!key || !Number.isFinite(time) || !allowed(ids)) return;
      setKeys('Move key pose', shiftKeys(keysNow(), ids, time - key.time, state.duration.value));
    },

    /** Spreads the selected key poses over the beats (or bars, or half beats) from the first to the last. */
    distributeKeys(): void {
      const ids = state.selection.value;
      if (!allowed(ids)) return;
      const before = keysNow();
      const next = distributeKeys(before, ids, state.snap.value, space());
      if (next === before) {
        context.notify(
          'info',
          chosenKeys().filter((key) => !key.locked).length < 2
            ? 'Select two key poses or more to distribute them.'
            : 'These key poses are already evenly on the grid.',
        );
        return;
      }
      setKeys('Distribute key poses', next);
      context.announce(`${chosenKeys().length} key poses distributed.`);
    },

    /** Copies the selected key poses by as many bars as they span. */
    duplicateKeys(): void {
      const ids = state.selection.value;
      if (chosenKeys().length > 0) keepCopies('Duplicate key poses', duplicateKeys(keysNow(), ids, space()));
    },

    /** Remembers the selected key poses for pasting. Returns how many. */
    copyKeys(): number {
      const chosen = chosenKeys();
      if (chosen.length === 0) return 0;
      clipboard = chosen;
      state.keysCopied.value = chosen.length;
      // In the pose editor the same copy can be pasted as a pose.
      state.poseClip.value = { rotations: chosen[0].rotations, limb: null, name: chosen[0].name ?? 'Key pose' };
      context.announce(`${chosen.length} key pose${chosen.length === 1 ? '' : 's'} copied.`);
      return chosen.length;
    },

    /** Remembers the selected key poses and takes them out; locked ones are copied and stay. */
    cutKeys(): void {
      const ids = state.selection.value;
      if (this.copyKeys() === 0 || !allowed(ids)) return;
      const cut = new Set(chosenKeys().flatMap((key) => (key.locked ? [] : [key.id])));
      setKeys(
        `Cut ${cut.size === 1 ? 'key pose' : `${cut.size} key poses`}`,
        keysNow().filter((key) => !cut.has(key.id)),
      );
    },

    /** Puts the copied key poses at the playhead (snapped unless `exact`), their distances in beats kept. */
    pasteKeys(exact = false): void {
      if (clipboard.length === 0) {
        context.notify('info', 'Nothing is copied yet: select key poses and copy them first.');
        return;
      }
      const now = services.player.time();
      const at = exact ? now : snapTime(state.grid.value, now, state.snap.value);
      keepCopies('Paste key poses', pasteKeys(keysNow(), clipboard, at, space()));
    },
  };
}
