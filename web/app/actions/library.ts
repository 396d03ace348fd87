/** The visitor's own poses: saved, renamed, deleted, exported and imported. */
import { framePose } from '../../core/motion';
import {
  freeName,
  newPoses,
  poseName,
  readPoseFile,
  writePoseFile,
  MAX_POSE_FILE_BYTES,
} from '../../core/formats/pose-file';
import { quaternionsToPose } from '../../core/rotation';
import { messageOf, type Context } from '../context';
import { saveFile } from '../download';
import { createPoseStore, OWN_GROUP, type OwnPose, type PoseStore } from '../pose-store';

/** Name of the file that own poses are exported to. */
const EXPORT_NAME = 'my-poses.json';

/** Actions on the visitor's own poses. */
export function libraryActions(context: Context, store: PoseStore = createPoseStore()) {
  const { state, services } = context;
  let told = false;
  let made = 0;

  const keep = (work: Promise<void>): void => {
    work.catch(() => {
      if (told) return;
      told = true;
      context.notify(
        'info',
        'This browser does not keep your poses (private window or full disk): export them before you leave.',
      );
    });
  };
  const names = () => new Set(state.ownPoses.value.map((pose) => pose.name));
  const newId = (): string =>
    `own-${Date.now().toString(36)}-${(made += 1)}-${Math.floor(Math.random() * 1e9).toString(36)}`;
  /** Puts poses where their times say; one that is there already is replaced. */
  const put = (poses: readonly OwnPose[]): void => {
    const ids = new Set(poses.map((pose) => pose.id));
    const others = state.ownPoses.value.filter((pose) => !ids.has(pose.id));
    state.ownPoses.value = [...poses, ...others].sort((a, b) => b.savedAt - a.savedAt);
    keep(store.put(poses));
  };
  /** The newest time so far and one more: clocks may stand still or go back. */
  const now = (): number => Math.max(Date.now(), (state.ownPoses.value[0]?.savedAt ?? 0) + 1);

  const saveOwnPose = (rotations: readonly number[], name: string): string => {
    const pose: OwnPose = {
      id: newId(),
      name: freeName(poseName(name) || 'My pose', names()),
      group: OWN_GROUP,
      rotations: [...rotations],
      savedAt: now(),
    };
    put([pose]);
    context.notify('info', `“${pose.name}” is in My poses.`);
    return pose.id;
  };

  return {
    saveOwnPose,

    /** Brings what this browser has kept; also what another tab has saved since. */
    async loadOwnPoses(): Promise<void> {
      const kept = await store.load().catch(() => null);
      if (!kept) return;
      const here = new Map(state.ownPoses.value.map((pose) => [pose.id, pose]));
      // The same arrays stay, and with them their pictures.
      const poses = kept.map((pose) => {
        const known = here.get(pose.id);
        return known && known.name === pose.name ? known : pose;
      });
      const same = poses.length === here.size && poses.every((pose) => here.get(pose.id) === pose);
      if (!same) state.ownPoses.value = poses;
    },

    /** Saves the pose in the editor. */
    saveDraftPose(name?: string): void {
      const draft = state.draft.value;
      if (draft) saveOwnPose(draft.rotations, name ?? draft.name);
    },

    /** Saves a key pose of the timeline. */
    saveKeyPose(id: string): void {
      const key = state.document.value.keyPoses.find((each) => each.id === id);
      if (key) saveOwnPose(key.rotations, key.name ?? 'Key pose');
    },

    /** Saves the dance's pose at the playhead. */
    saveDancePose(): void {
      const motion = state.onStage.value?.motion;
      if (!motion || motion.frames === 0) {
        context.notify('info', 'There is no dance to take a pose from yet: generate one first.');
        return;
      }
      const pose = quaternionsToPose(framePose(motion, services.player.time()).quaternions);
      saveOwnPose(pose, 'From the dance');
    },

    /** Gives an own pose another name; an empty one changes nothing. */
    renameOwnPose(id: string, text: string): void {
      const pose = state.ownPoses.value.find((each) => each.id === id);
      const name = poseName(text);
      if (!pose || !name || name === pose.name) return;
      const others = names();
      others.delete(pose.name);
      put([{ ...pose, name: freeName(name, others) }]);
    },

    /** Deletes an own pose; the message brings it back. */
    deleteOwnPose(id: string): void {
      const pose = state.ownPoses.value.find((each) => each.id === id);
      if (!pose) return;
      state.ownPoses.value = state.ownPoses.value.filter((each) => each.id !== id);
      keep(store.remove(id));
      context.notify('info', `“${pose.name}” is deleted.`, {
        label: 'Undo',
        run: () => put([{ ...pose, name: freeName(pose.name, names()) }]),
      });
    },

    /** Offers all own poses as one file. */
    exportOwnPoses(): void {
      const poses = state.ownPoses.value;
      if (poses.length === 0) {
        context.notify('info', 'There is nothing to export yet: save a pose to My poses first.');
        return;
      }
      saveFile(new Blob([writePoseFile(poses)], { type: 'application/json' }), EXPORT_NAME);
    },

    /** Adds the poses of such a file; a wrong file becomes a message and changes nothing. */
    async importOwnPoses(file: File): Promise<void> {
      try {
        if (file.size > MAX_POSE_FILE_BYTES) throw new Error('This file is too large for a file of poses.');
        let raw: unknown;
        try {
          raw = JSON.parse(await file.text());
        } catch {
          throw new Error('This file is damaged or of another kind: choose one that was exported from “My poses”.');
        }
        const { poses, broken } = readPoseFile(raw);
        const { added, duplicates } = newPoses(state.ownPoses.value, poses);
        const start = now() + added.length;
        put(added.map((pose, i) => ({ ...pose, id: newId(), group: OWN_GROUP, savedAt: start - i })));
        const count = (n: number) => `${n} pose${n === 1 ? '' : 's'}`;
        const parts = [added.length > 0 ? `${count(added.length)} added to My poses.` : 'No new poses in this file.'];
        if (duplicates > 0) parts.push(`${count(duplicates)} ${duplicates === 1 ? 'was' : 'were'} there already.`);
        if (broken > 0) parts.push(`${count(broken)} could not be read.`);
        state.panel.value = 'poses';
        context.notify('info', parts.join(' '));
      } catch (error) {
        context.notify('error', messageOf(error));
      }
    },
  };
}

/** The actions on own poses. */
export type LibraryActions = ReturnType<typeof libraryActions>;
