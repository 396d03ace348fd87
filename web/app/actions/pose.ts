/** The pose editor's draft: its own undo, apart from the document's. */
import { History } from '../../core/history';
import { framePose } from '../../core/motion';
import { quaternionsToPose } from '../../core/rotation';
import { mirrorPose } from '../../core/skeleton';
import { POSE_SIZE } from '../../core/document';
import type { Context } from '../context';
import { eulerToAxisAngle } from '../euler';

/** Actions on the pose in the editor. */
export function poseActions(
  context: Context,
  keys: { addKey: AddKey; updateKey(id: string, rotations: number[]): void },
) {
  const { state, services } = context;
  let history = new History<number[]>([]);
  let before: readonly number[] = [];

  const refresh = () => {
    const draft = state.draft.value;
    if (!draft) return;
    state.draft.value = {
      ...draft,
      rotations: history.present,
      canUndo: history.undoLabel !== null,
      canRedo: history.redoLabel !== null,
    };
  };
  const push = (rotations: number[], label: string) => {
    history.push(rotations, label);
    refresh();
  };

  const begin = (rotations: readonly number[], options: { keyId?: string; name?: string } = {}) => {
    services.player.pause();
    history = new History([...rotations]);
    state.draft.value = {
      rotations: history.present,
      keyId: options.keyId ?? null,
      name: options.name ?? '',
      joint: null,
      canUndo: false,
      canRedo: false,
    };
    state.panel.value = 'poses';
  };

  /** The pose of the dance at the playhead; null without a dance. */
  const poseNow = (): number[] | null => {
    const motion = state.dance.value?.motion;
    if (!motion) return null;
    return quaternionsToPose(framePose(motion, services.player.time()).quaternions);
  };

  return {
    /** Opens the editor with a pose, by default standing upright. */
    editPose: begin,

    /** Opens the editor with the pose of a key pose, at its time. */
    editKey(id: string): void {
      const key = state.document.value.keyPoses.find((each) => each.id === id);
      if (!key) return;
      begin(key.rotations, { keyId: id, name: key.name });
      services.player.seek(key.time);
    },

    /** Opens the editor with the dance's pose at the playhead. */
    poseFromDance(): void {
      const pose = poseNow();
      if (pose) begin(pose, { name: 'From the dance' });
      else context.notify('info', 'There is no dance to take a pose from yet: generate one first.');
    },

    /** Puts the dance's pose at the playhead on the timeline. */
    keepPoseHere(): void {
      const pose = poseNow();
      if (pose) keys.addKey(pose, services.player.time(), { name: 'From the dance', exact: true });
    },

    /** A gizmo drag: many changes, one step. */
    changePose(rotations: readonly number[], phase: 'start' | 'change' | 'commit' | 'cancel'): void {
      if (!state.draft.value || rotations.length !== POSE_SIZE) return;
      if (phase === 'start') {
        before = history.present;
        history.capture();
      } else if (phase === 'cancel') history.discard();
      else {
        if (!history.capturing) {
          before = history.present;
          history.capture();
        }
        history.preview([...rotations]);
        // A click on a ring turns nothing and must be no step.
        const turned = rotations.some((value, i) => Math.abs(value - before[i]) > 1e-6);
        if (phase === 'commit' && turned) history.commit('Rotate joint');
        else if (phase === 'commit') history.discard();
      }
      refresh();
    },

    /** Sets one joint by x, y, z degrees. */
    setJointDegrees(joint: number, degrees: readonly [number, number, number]): void {
      const next = [...history.present];
      const turn = eulerToAxisAngle(degrees);
      for (let axis = 0; axis < 3; axis += 1) next[joint * 3 + axis] = turn[axis];
      push(next, 'Rotate joint');
    },

    selectJoint(joint: number | null): void {
      const draft = state.draft.value;
      if (draft && draft.joint !== joint) state.draft.value = { ...draft, joint };
    },

    mirrorDraft: () => push(mirrorPose(history.present), 'Mirror pose'),

    resetJoint(joint: number): void {
      const next = [...history.present];
      next.fill(0, joint * 3, joint * 3 + 3);
      push(next, 'Reset joint');
    },

    undoPose(): void {
      history.undo();
      refresh();
    },

    redoPose(): void {
      history.redo();
      refresh();
    },

    /** Writes the draft to its key pose, or adds it at the playhead's nearest beat, and closes the editor. */
    keepDraft(): void {
      const draft = state.draft.value;
      if (!draft) return;
      const exists = state.document.value.keyPoses.some((key) => key.id === draft.keyId);
      if (draft.keyId && exists) keys.updateKey(draft.keyId, draft.rotations);
      else keys.addKey(draft.rotations, services.player.time(), { name: draft.name || 'My pose' });
      state.draft.value = null;
    },

    closeDraft(): void {
      state.draft.value = null;
    },
  };
}

type AddKey = (rotations: readonly number[], time: number, options?: { name?: string; exact?: boolean }) => string;
