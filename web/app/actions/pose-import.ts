/** Taking a pose from an animation file: the file is read, a frame chosen, and that becomes a pose like any other. */
import { poseOfFrame } from '../../core/formats/pose-sequence';
import { breathe, messageOf, type Context } from '../context';
import { isJson, jsonKindOf, readPoseClips } from '../pose-reader';
import type { LibraryActions } from './library';

interface Keys {
  addKey(rotations: readonly number[], time: number, options?: { name?: string; exact?: boolean }): string;
}
interface Editor {
  editPose(rotations: readonly number[], options?: { name?: string }): void;
}

/** Actions on the file that a pose is taken from. */
export function poseImportActions(context: Context, library: LibraryActions, keys: Keys, editor: Editor) {
  const { state, services } = context;
  let reading = 0;

  const chosen = () => {
    const open = state.poseImport.value;
    if (!open) return null;
    const clip = open.clips[open.clip];
    const plain = open.file.replace(/(\.curves)?\.[a-z0-9]{2,5}$/i, '');
    return { rotations: poseOfFrame(clip, open.frame), name: clip.frames > 1 ? `${plain} ${open.frame + 1}` : plain };
  };

  return {
    /** Opens a file of poses or of an animation; a wrong file becomes a message and changes nothing. */
    async importPoseFile(file: File): Promise<void> {
      const turn = (reading += 1);
      if (isJson(file)) {
        const kind = await jsonKindOf(file).catch(() => null);
        if (turn !== reading) return;
        // What is none of ours gets the words of the poses.
        if (kind === null || kind === 'poses') return library.importOwnPoses(file);
      }
      state.poseImportJob.value = file.name;
      try {
        // The message is painted before the reading begins.
        await breathe();
        const { kind, clips } = await readPoseClips(file);
        if (turn !== reading) return;
        state.poseImport.value = { file: file.name, kind, clips, clip: 0, frame: 0 };
        state.panel.value = 'poses';
        state.sheetOpen.value = true;
        context.announce(`${file.name} is open: choose a frame.`);
        if (state.draft.value) context.notify('info', 'Close the pose in the editor to choose a frame of the file.');
      } catch (error) {
        if (turn === reading) context.notify('error', `“${file.name}” was not opened. ${messageOf(error)}`);
      } finally {
        if (turn === reading) state.poseImportJob.value = null;
      }
    },

    /** Chooses an animation of the file. */
    chooseClip(clip: number): void {
      const open = state.poseImport.value;
      if (open?.clips[clip]) state.poseImport.value = { ...open, clip, frame: 0 };
    },

    /** Chooses a frame; outside the animation the nearest. */
    chooseFrame(frame: number): void {
      const open = state.poseImport.value;
      if (!open) return;
      const last = open.clips[open.clip].frames - 1;
      const next = Math.min(Math.max(0, Math.round(frame)), last);
      if (next !== open.frame) state.poseImport.value = { ...open, frame: next };
    },

    /** Closes the file. */
    closePoseImport(): void {
      reading += 1;
      state.poseImport.value = null;
      state.poseImportJob.value = null;
    },

    /** Opens the editor with the chosen frame; the file stays open behind it. */
    editFrame(): void {
      const pose = chosen();
      if (pose) editor.editPose(pose.rotations, { name: pose.name });
    },

    /** Puts the chosen frame on the timeline, at the playhead's nearest beat. */
    placeFrame(): void {
      const pose = chosen();
      if (!pose) return;
      if (state.duration.value === 0) {
        context.notify('info', 'Drop a song first: poses are placed on its beats.');
        return;
      }
      keys.addKey(pose.rotations, services.player.time(), { name: pose.name });
    },

    /** Saves the chosen frame to the library. */
    saveFrame(): void {
      const pose = chosen();
      if (pose) library.saveOwnPose(pose.rotations, pose.name);
    },
  };
}
