/** Blending the pose in the editor with another one. */
import { blendPoses, headingOfPose, turnPose } from '../../core/pose-tools';
import type { Context } from '../context';
import type { PoseDesk } from './pose-draft';
import { limitWord, withinTools, type PoseMath } from './pose-limits';

/** Another pose to blend with: the neighbouring key pose, `clip` (what was copied), `pose:` and an id of the library, `key:` and an id. */
export type BlendSource = 'previous' | 'next' | 'clip' | `pose:${string}` | `key:${string}`;

const LABEL = 'Blend poses';

/** Actions of the blend slider. */
export function poseBlendActions(context: Context, desk: PoseDesk, math: PoseMath) {
  const { state, services } = context;

  /** The key pose before or after the one in the editor. */
  const neighbour = (side: 'previous' | 'next') => {
    const { keyPoses } = state.document.value;
    const own = keyPoses.find((key) => key.id === state.draft.value?.keyId);
    const time = own?.time ?? services.player.time();
    const others = keyPoses.filter((key) => key !== own);
    return side === 'previous'
      ? others.findLast((key) => key.time <= time)
      : others.find((key) => (own ? key.time >= time : key.time > time));
  };

  const find = (source: BlendSource): { name: string; rotations: readonly number[] } | null => {
    if (source === 'clip') {
      const clip = state.poseClip.value;
      return clip && clip.limb === null ? clip : null;
    }
    if (source === 'previous' || source === 'next') {
      const key = neighbour(source);
      return key ? { name: key.name ?? 'Key pose', rotations: key.rotations } : null;
    }
    const id = source.slice(source.indexOf(':') + 1);
    if (source.startsWith('key:')) {
      const key = state.document.value.keyPoses.find((each) => each.id === id);
      return key ? { name: key.name ?? 'Key pose', rotations: key.rotations } : null;
    }
    const pose = [...state.ownPoses.value, ...state.poses.value].find((each) => each.id === id);
    if (!pose) return null;
    // A pose of the library stands nowhere in particular: it is taken as it looks from where the figure looks.
    const towards = headingOfPose(desk.base(LABEL)) - headingOfPose(pose.rotations);
    return { name: pose.name, rotations: turnPose(pose.rotations, towards) };
  };

  return {
    /** Whether there is such a pose to blend with now. */
    canBlend: (source: BlendSource): boolean => find(source) !== null,

    /**
     * Shows the pose on its way to another one; it is one step however far the slider went.
     * @param amount 0..1
     */
    blendWith(source: BlendSource, amount: number): void {
      const draft = state.draft.value;
      const other = find(source);
      if (!draft) return;
      if (!other) {
        desk.say('There is no such pose to blend with.');
        return;
      }
      const base = desk.base(LABEL);
      const mixed = blendPoses(base, other.rotations, amount);
      const { rotations, limited } = amount > 0 ? withinTools(context, math, mixed) : { rotations: mixed, limited: [] };
      desk.attempt(rotations, LABEL);
      state.poseBlend.value = { name: other.name, amount };
      state.poseWord.value = limitWord(limited);
    },

    /** Keeps the blend as a step. */
    keepBlend(): void {
      if (!state.poseBlend.value) return;
      const { name, amount } = state.poseBlend.value;
      desk.settle();
      desk.say(`Blended ${Math.round(amount * 100)}% with ${name}.`);
    },

    /** Takes the blend back. Returns false when there is none. */
    cancelBlend(): boolean {
      return state.poseBlend.value !== null && desk.discard();
    },
  };
}
