/** Copying poses and limbs, across key poses. */
import { asOwn } from '../../core/key-ops';
import { copyLimb, limbOf, LIMBS, OTHER_SIDE, type Limb } from '../../core/pose-tools';
import type { Context } from '../context';
import { limbLabel } from '../limb-labels';
import type { PoseDesk } from './pose-draft';
import { limitWord, withinTools, type PoseMath } from './pose-limits';

/** Actions on the pose clipboard. */
export function poseClipboardActions(context: Context, desk: PoseDesk, math: PoseMath) {
  const { state } = context;

  /** What is copied, put onto a pose. */
  const pasted = (rotations: readonly number[], onto?: Limb): number[] => {
    const clip = state.poseClip.value!;
    return clip.limb ? copyLimb(clip.rotations, rotations, clip.limb, onto) : [...clip.rotations];
  };
  const nothing = () => desk.say('Nothing is copied yet.');

  return {
    /** Copies the pose in the editor, or one limb of it. */
    copyPose(limb: Limb | null = null): void {
      const draft = state.draft.value;
      if (!draft) return;
      state.poseClip.value = { rotations: [...draft.rotations], limb, name: draft.name || 'Copied pose' };
      desk.say(limb ? `${limbLabel(limb)} copied.` : 'Pose copied.');
    },

    /** Copies the limb of the chosen joint. */
    copyLimbOfJoint(): void {
      const joint = state.draft.value?.joint ?? null;
      const limb = joint === null ? null : limbOf(joint);
      if (limb) this.copyPose(limb);
      else if (state.draft.value) desk.say('Choose a joint of an arm, a leg, the torso or the head first.');
    },

    /**
     * Pastes onto the pose in the editor. A limb goes where it came from, or mirrored to the other side when that one is chosen.
     * @param onto the limb to give it to, by default that of the chosen joint where it fits
     */
    pastePose(onto?: Limb): void {
      const draft = state.draft.value;
      const clip = state.poseClip.value;
      if (!draft) return;
      if (!clip) return nothing();
      const chosen = onto ?? (draft.joint === null ? null : limbOf(draft.joint));
      const other = clip.limb !== null && chosen !== clip.limb && chosen === OTHER_SIDE[clip.limb];
      const target = clip.limb && other ? OTHER_SIDE[clip.limb] : (clip.limb ?? undefined);
      const members = target && LIMBS[target];
      const { rotations, limited } = withinTools(context, math, pasted(desk.present, target), members);
      desk.push(rotations, target ? 'Paste limb' : 'Paste pose');
      desk.say([target ? `${limbLabel(target)} pasted.` : 'Pose pasted.', limitWord(limited)].join(' ').trim());
    },

    /** Pastes onto the key poses selected on the timeline, in one step; locked ones stay as they are. */
    pastePoseOntoKeys(): void {
      const clip = state.poseClip.value;
      if (!clip) return nothing();
      const ids = new Set(
        state.document.value.keyPoses
          .filter((key) => state.selection.value.has(key.id) && !key.locked)
          .map((key) => key.id),
      );
      if (ids.size === 0) {
        context.notify('info', 'Select key poses that are not locked to paste the pose onto them.');
        return;
      }
      context.change('Paste pose', (document) => ({
        ...document,
        keyPoses: document.keyPoses.map((key) =>
          ids.has(key.id)
            ? { ...asOwn(key), rotations: withinTools(context, math, pasted(key.rotations)).rotations }
            : key,
        ),
      }));
      context.announce(`Pasted onto ${ids.size} key pose${ids.size === 1 ? '' : 's'}.`);
    },
  };
}
