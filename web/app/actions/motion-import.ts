/** The motion of an animation file as the dance to be danced anew, or as a starting clip. */
import { effect } from '@preact/signals';
import { MAX_KEY_POSES, frameOf, nextKeyId } from '../../core/document';
import { settleKeys } from '../../core/key-ops';
import { posesAtTimes, seedFromClip } from '../../core/import-motion';
import { gridTimes, nearestIndex } from '../../core/snap';
import type { KeyPose } from '../../core/types';
import { messageOf, type Context } from '../context';
import { idsOnStage } from './curves';

/** Which beats get a key pose. */
export type ImportDensity = 'beat' | 'two' | 'bar';

/** Ids of starting clips that come from files. */
const OWN = /^own-/;

/** Actions on the motion of a file. */
export function motionImportActions(context: Context) {
  const { state, services } = context;

  // The document's own clip stands beside those of the library, whatever brings the document.
  effect(() => {
    const own = state.document.value.ownSeed;
    const seeds = state.seeds.value;
    const library = seeds.filter(({ id }) => !OWN.test(id));
    const wanted = own && library.length > 0 ? [...library, own] : library;
    if (wanted.length !== seeds.length || wanted.at(-1) !== seeds.at(-1)) state.seeds.value = wanted;
  });

  const opened = () => {
    const open = state.poseImport.value;
    if (!open) throw new Error('Open an animation file first.');
    return {
      clip: open.clips[open.clip],
      frame: open.frame,
      name: open.file.replace(/(\.curves)?\.[a-z0-9]{2,5}$/i, ''),
    };
  };

  /** The beats that get a pose, from the one at the playhead on. */
  const beatsFrom = (density: ImportDensity): readonly number[] => {
    const grid = state.grid.value;
    const times = gridTimes(grid, density === 'bar' ? 'bar' : 'beat');
    if (!grid || times.length === 0) throw new Error('Drop a song first: the poses are placed on its beats.');
    const first = nearestIndex(times, services.player.time());
    const { trim } = state.document.value;
    return times.slice(first).filter((time, i) => (density !== 'two' || i % 2 === 0) && (!trim || time <= trim.end));
  };

  /** Key poses that the file would give. */
  const found = (density: ImportDensity) => {
    const { clip, frame } = opened();
    const beats = beatsFrom(density);
    return posesAtTimes(clip, frame, beats, beats[0]);
  };

  return {
    /** How many key poses the file gives at a density, and up to when; null where that cannot be. */
    fileKeyCount(density: ImportDensity): { count: number; from: number; to: number } | null {
      try {
        const { clip, frame } = opened();
        const beats = beatsFrom(density);
        const last = beats[0] + (clip.frames - 1 - frame + 0.5) / clip.fps;
        const reached = beats.filter((time) => time <= last);
        return { count: reached.length, from: reached[0], to: reached[reached.length - 1] };
      } catch {
        return null;
      }
    },

    /**
     * Puts the dance's poses on the beats, from the chosen frame and the playhead on, in place of the key poses there; locked ones stay.
     * One step of undo.
     */
    useFileAsDance(density: ImportDensity): void {
      try {
        const poses = found(density);
        const { keyPoses } = state.document.value;
        const [first, last] = [frameOf(poses[0].time), frameOf(poses[poses.length - 1].time)];
        const inside = ({ time }: KeyPose) => frameOf(time) >= first && frameOf(time) <= last;
        const still = keyPoses.filter((key) => key.locked || !inside(key));
        const taken = new Set(still.map(({ time }) => frameOf(time)));
        const placed: KeyPose[] = [];
        const onStage = idsOnStage(state).map((id) => ({ id }));
        for (const { time, rotations } of poses) {
          if (taken.has(frameOf(time))) continue;
          placed.push({ id: nextKeyId([...keyPoses, ...placed, ...onStage]), time, rotations });
        }
        if (still.length + placed.length > MAX_KEY_POSES) throw new Error('That would be too many key poses.');
        const keys = settleKeys(still, placed, state.duration.value);
        context.change('Key poses from file', (document) => ({ ...document, keyPoses: [...keys] }));
        state.selection.value = new Set(placed.map(({ id }) => id));
        context.notify('info', `${placed.length} key poses are on the timeline. Generate dances what is between them.`);
      } catch (error) {
        context.notify('error', messageOf(error));
      }
    },

    /** Takes eight beats of the dance, from the chosen frame on, as the starting clip. One step of undo. */
    useFileAsSeed(): void {
      try {
        const { clip, frame, name } = opened();
        const own = seedFromClip(clip, frame, state.grid.value?.tempo ?? 120, name);
        context.change('Starting clip from file', (document) => ({
          ...document,
          ownSeed: own,
          dials: { ...document.dials, seedClip: own.id },
        }));
        context.notify('info', `The dance starts as “${own.name}” now. Press Generate to see it.`);
      } catch (error) {
        context.notify('error', messageOf(error));
      }
    },
  };
}
