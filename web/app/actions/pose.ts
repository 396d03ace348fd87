/** The pose editor: opening, keeping and leaving a pose; its tools are in the files beside this one. */
import { POSE_SIZE } from '../../core/document';
import { framePose } from '../../core/motion';
import { quaternionsToPose } from '../../core/rotation';
import type { PoseTools } from '../../core/types';
import { jointLabel } from '../../scene/pose-edit';
import type { Context } from '../context';
import { poseBlendActions } from './pose-blend';
import { poseClipboardActions } from './pose-clipboard';
import { poseDesk } from './pose-draft';
import { poseShapeActions } from './pose-shape';
import type { PoseMath } from './pose-limits';

/** Actions on the pose in the editor. */
export function poseActions(context: Context, keys: Keys, math: PoseMath) {
  const { state, services } = context;
  const desk = poseDesk(context);

  const setPoseTools = (change: Partial<PoseTools>, word: string): void => {
    state.poseTools.value = { ...state.poseTools.value, ...change };
    desk.say(word);
  };

  const begin = (rotations: readonly number[], options: { keyId?: string; name?: string } = {}) => {
    services.player.pause();
    desk.open(rotations, options);
  };

  /** The pose of the dance at the playhead; null without a dance. */
  const poseNow = (): number[] | null => {
    const motion = state.onStage.value?.motion;
    if (!motion || motion.frames === 0) return null;
    return quaternionsToPose(framePose(motion, services.player.time()).quaternions);
  };
  const noDance = () => context.notify('info', 'There is no dance to take a pose from yet: generate one first.');

  /** Closes the editor where the draft has become a key pose; where a locked one is in its place it stays open. */
  const placed = (id: string) => {
    if (id) desk.keep(id);
  };

  return {
    ...poseShapeActions(context, desk, math),
    ...poseClipboardActions(context, desk, math),
    ...poseBlendActions(context, desk, math),

    /** Opens the editor with a pose. */
    editPose: begin,

    /** Opens the editor with the pose of a key pose, at its time. */
    editKey(id: string): void {
      const key = state.document.value.keyPoses.find((each) => each.id === id);
      if (!key) return;
      if (key.locked) {
        context.notify('info', 'This key pose is locked: unlock it to change it.');
        return;
      }
      begin(key.rotations, { keyId: id, name: key.name });
      services.player.seek(key.time);
    },

    /** Opens the editor with the dance's pose at the playhead. */
    poseFromDance(): void {
      const pose = poseNow();
      if (pose) begin(pose, { name: 'From the dance' });
      else noDance();
    },

    /** Gives the pose in the editor the shape that the dance has at the playhead. */
    takePoseOfDance(): void {
      const pose = poseNow();
      if (pose) desk.push(pose, 'Take the pose of the dance');
      else noDance();
    },

    /** Puts the dance's pose at the playhead on the timeline. */
    keepPoseHere(): void {
      const pose = poseNow();
      if (pose) keys.addKey(pose, services.player.time(), { name: 'From the dance', exact: true });
    },

    /** A drag of the gizmo: many changes, one step. */
    changePose(rotations: readonly number[], phase: 'start' | 'change' | 'commit' | 'cancel'): void {
      if (!state.draft.value || rotations.length !== POSE_SIZE) return;
      const label = state.poseTools.value.mode === 'move' ? 'Move joint' : 'Rotate joint';
      if (phase === 'start') desk.settle();
      else if (phase === 'cancel') desk.discard();
      else desk.attempt([...rotations], label);
      if (phase === 'commit') desk.settle();
    },

    selectJoint(joint: number | null): void {
      const draft = state.draft.value;
      if (!draft || draft.joint === joint) return;
      state.draft.value = { ...draft, joint };
      state.poseWord.value = '';
    },

    /** Dragging a joint turns it, or moves it with the body following. */
    setPoseMode: (mode: PoseTools['mode']) => setPoseTools({ mode }, mode === 'move' ? 'Move joints.' : 'Turn joints.'),

    /** Turns and moves go along the joint's own axes or the world's. */
    toggleSpace(): void {
      const space = state.poseTools.value.space === 'local' ? 'world' : 'local';
      setPoseTools({ space }, space === 'world' ? 'World axes.' : 'The joint’s own axes.');
    },

    toggleLimits(): void {
      const limits = !state.poseTools.value.limits;
      setPoseTools({ limits }, limits ? 'Joint limits on.' : 'Joint limits off: anything goes.');
    },

    toggleMirrorEdit(): void {
      const mirror = !state.poseTools.value.mirror;
      setPoseTools({ mirror }, mirror ? 'Both sides move, mirrored.' : 'Each side moves alone.');
    },

    toggleBalance(): void {
      const balance = !state.poseTools.value.balance;
      setPoseTools({ balance }, balance ? 'Balance shown.' : 'Balance hidden.');
    },

    /** Pins the chosen joint where it is, or lets it go. */
    togglePin(joint: number | null = state.draft.value?.joint ?? null): void {
      if (!state.draft.value) return;
      if (joint === null) {
        desk.say('Choose a joint to pin first.');
        return;
      }
      const pins = new Set(state.poseTools.value.pins);
      const gone = pins.delete(joint);
      if (!gone) pins.add(joint);
      setPoseTools({ pins }, gone ? `${jointLabel(joint)} is free.` : `${jointLabel(joint)} stays where it is.`);
    },

    undoPose: desk.undo,
    redoPose: desk.redo,

    /** Writes the draft to its key pose, or adds it at the playhead's nearest beat, and closes the editor. */
    keepDraft(): void {
      desk.settle();
      const draft = state.draft.value;
      if (!draft) return;
      const own = state.document.value.keyPoses.find((key) => key.id === draft.keyId);
      if (own?.locked) {
        context.notify('info', 'This key pose is locked: unlock it to change it.');
        return;
      }
      if (own) {
        keys.updateKey(own.id, draft.rotations);
        desk.keep(own.id);
      } else if (state.duration.value === 0) {
        context.notify('info', 'Drop a song first: poses are placed on its beats.');
      } else {
        placed(keys.addKey(draft.rotations, services.player.time(), { name: draft.name || 'My pose' }));
      }
    },

    /** Puts the draft on the timeline at a time. A new pose is thereby kept; of a key pose it is a copy, and editing goes on. */
    dropDraftAt(time: number): void {
      desk.settle();
      const draft = state.draft.value;
      if (!draft) return;
      const copy = state.document.value.keyPoses.some((key) => key.id === draft.keyId);
      const id = keys.addKey(draft.rotations, time, { name: draft.name || 'My pose', exact: true });
      if (!copy) placed(id);
    },

    /** Leaves the editor; what was changed in it can be brought back. */
    closeDraft: desk.drop,
  };
}

/** What the editor needs of the timeline. */
interface Keys {
  addKey(rotations: readonly number[], time: number, options?: { name?: string; exact?: boolean }): string;
  updateKey(id: string, rotations: readonly number[]): void;
}
