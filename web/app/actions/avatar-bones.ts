/** The question which bone of a character is which of our joints; the character on the stage shows every answer at once. */
import type { BoneGuess } from '../../core/avatar/guess';
import type * as avatarOpen from '../avatar-open';
import type { AvatarInUse, AvatarMapping } from '../avatar-state';
import type { Context } from '../context';

type Opener = typeof avatarOpen;

/** Actions on the dialog of bones. */
export function bonesActions(
  { state }: Context,
  opener: () => Promise<Opener>,
  done: { accept(mapping: AvatarMapping): void },
) {
  let parts: Opener | null = null;

  /** Opens the dialog with a guess filled in. */
  async function askBones(avatar: AvatarInUse, { bones: guess, by }: BoneGuess): Promise<void> {
    parts = await opener();
    // One question at a time: a file that comes while another is asked about takes its place.
    if (state.avatarMapping.value?.figure !== avatar.figure) actions.cancelBones();
    const { rig } = avatar.figure;
    const map = [...avatar.source.map];
    state.avatarMapping.value = {
      ...avatar,
      bones: parts.boneChoices(rig),
      joints: parts.AVATAR_JOINTS,
      map,
      guess,
      byShape: by === 'shape',
      ...parts.judgeBones(rig, map),
      joint: null,
    };
  }

  const change = (map: number[]): void => {
    const open = state.avatarMapping.value;
    if (!open || !parts) return;
    open.figure.setMap(map);
    open.figure.mark(open.joint);
    state.avatarMapping.value = { ...open, map, ...parts.judgeBones(open.figure.rig, map) };
  };

  const actions = {
    /** Looks through the bones of the character that dances. */
    async checkBones(): Promise<void> {
      const avatar = state.avatar.value;
      if (!avatar) return;
      const guess = (await opener()).guessBones(avatar.figure.rig);
      if (state.avatar.value === avatar) await askBones(avatar, guess);
    },

    /** Gives a joint of ours another bone; -1 = none. */
    chooseBone(joint: number, node: number): void {
      const open = state.avatarMapping.value;
      if (open) change(open.map.map((each, i) => (i === joint ? node : each)));
    },

    /** Fills in what was guessed. */
    guessBones(): void {
      const open = state.avatarMapping.value;
      if (open) change([...open.guess]);
    },

    /** Shows on the stage where a joint's bone is; null = none. */
    pointAtBone(joint: number | null): void {
      const open = state.avatarMapping.value;
      if (!open || open.joint === joint) return;
      open.figure.mark(joint);
      state.avatarMapping.value = { ...open, joint };
    },

    /** Lets the character dance with the chosen bones. */
    acceptBones(): void {
      const open = state.avatarMapping.value;
      if (!open?.usable) return;
      open.figure.mark(null);
      state.avatarMapping.value = null;
      done.accept(open);
    },

    /** Leaves everything as it was. */
    cancelBones(): void {
      const open = state.avatarMapping.value;
      if (!open) return;
      open.figure.mark(null);
      state.avatarMapping.value = null;
      // A character that was on stage before has its former bones back; a new one goes.
      if (state.avatar.value?.figure === open.figure) open.figure.setMap(open.source.map);
      else open.figure.dispose();
    },
  };
  return { askBones, checkBones: actions.checkBones, actions };
}
