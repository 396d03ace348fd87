/** Characters of the visitor's own: opened, kept, chosen. They belong to this browser, not to the project. */
import type { BoneGuess } from '../../core/avatar/guess';
import type { AvatarFigure } from '../../scene/avatar';
import { poseName } from '../../core/formats/pose-file';
import { gltfParts, mayBeAvatar } from '../avatar-file';
import type * as avatarOpen from '../avatar-open';
import type { AvatarInUse } from '../avatar-state';
import { createAvatarStore, MAX_AVATAR_BYTES, type AvatarStore, type KeptAvatar } from '../avatar-store';
import { messageOf, type Context } from '../context';
import { hashBytes } from '../hash';
import { bonesActions } from './avatar-bones';

type Opener = typeof avatarOpen;
/** What the word that a character dances offers. */
const CHECK = 'Check the bones';
const opener = (): Promise<Opener> => import('../avatar-open');

/** Options of the public call. */
export interface SetAvatarOptions {
  /** Bones whose guess is wrong or missing: our joint's name (spec.json) -> the name of the file's node. */
  bones?: Readonly<Record<string, string>>;
}

/** A file that is open and not used yet. */
interface Opened extends AvatarInUse {
  guess: BoneGuess;
  /** Whether the guess is to be looked at before it dances. */
  doubtful: boolean;
}

/** Actions on characters. */
export function avatarActions(context: Context, store: AvatarStore = createAvatarStore()) {
  const { state } = context;
  /** Bytes of characters that this browser could not keep. */
  const unkept = new Map<string, Uint8Array>();
  let turn = 0;
  let told = false;

  const list = (avatars: readonly KeptAvatar[]) =>
    (state.avatars.value = [...avatars].sort((a, b) => a.name.localeCompare(b.name)));
  const without = (ids: readonly string[]) => state.avatars.value.filter(({ id }) => !ids.includes(id));

  const choose = (id: string | null): void => void store.choose(id).catch(() => undefined);

  /** Puts a character on stage, or our own figure. */
  const show = (next: AvatarInUse | null): void => {
    const before = state.avatar.value;
    // A question about whoever goes, or is passed over, is answered by that.
    if (state.avatarMapping.value?.figure !== next?.figure) bones.actions.cancelBones();
    state.avatar.value = next;
    // It is about whoever danced then.
    state.notices.value = state.notices.value.filter(({ action }) => action?.label !== CHECK);
    if (before && before.figure !== next?.figure) before.figure.dispose();
  };

  /** Keeps what is known of a character; its bytes where they are new. */
  async function keep({ id, name, source }: AvatarInUse, isNew: boolean): Promise<void> {
    const kept: KeptAvatar = { id, name, map: source.map, size: source.bytes.length, usedAt: Date.now() };
    list([...without([id]), kept]);
    try {
      const gone = await store.put(kept, isNew ? source.bytes : undefined);
      if (gone.length > 0) list(without(gone));
      await store.choose(id);
      unkept.delete(id);
    } catch {
      if (!isNew) return;
      unkept.set(id, source.bytes);
      if (told) return;
      told = true;
      context.notify(
        'info',
        'This browser does not keep your character (private window or full disk): it dances now, and has to be opened again next time.',
      );
    }
  }

  /** Reads a file; nothing on the page changes. */
  async function open(file: File | Blob, options: SetAvatarOptions = {}): Promise<Opened> {
    if (file.size > MAX_AVATAR_BYTES) {
      throw new Error(
        `It has ${Math.round(file.size / 1e6)} MB, and at most ${MAX_AVATAR_BYTES / 1e6} can be used here: export it with smaller pictures.`,
      );
    }
    if (file.size === 0) throw new Error('This file is empty: choose another one.');
    const [bytes, parts] = await Promise.all([file.arrayBuffer().then((buffer) => new Uint8Array(buffer)), opener()]);
    const { rig, guess } = parts.readCharacter(bytes);
    const id = await hashBytes(bytes.buffer);
    const known = state.avatars.value.find((each) => each.id === id);
    const own = known && parts.mapFits(rig, known.map) ? [...known.map] : null;
    const map = parts.bonesByName(rig, own ?? guess.bones, options.bones ?? {});
    const plain = file instanceof File ? file.name.replace(/\.[a-z0-9]{2,5}$/i, '') : '';
    const name = known?.name || poseName(rig.title) || poseName(plain) || 'Character';
    const source = { bytes, name, map };
    const figure = await parts.openAvatar(source, rig);
    const { usable } = parts.judgeBones(rig, map);
    return {
      id,
      name,
      source,
      figure,
      guess,
      doubtful: !usable || (guess.by === 'shape' && !own && !options.bones),
    };
  }

  const use = (opened: AvatarInUse): void => {
    show(opened);
    void keep(opened, true);
    context.announce(`${opened.name} dances.`);
  };

  const bones = bonesActions(context, opener, {
    accept(mapping) {
      const { id, name, source, figure } = mapping;
      const isNew = state.avatar.value?.id !== id;
      const next = { id, name, figure, source: { ...source, map: mapping.map } };
      if (isNew) use(next);
      else {
        state.avatar.value = next;
        void keep(next, false);
      }
    },
  });

  /** Opens a file for the visitor: what is wrong becomes a message, and bones that are in doubt a question. */
  async function openCharacter(file: File): Promise<void> {
    const own = (turn += 1);
    state.avatarJob.value = file.name;
    try {
      const opened = await open(file);
      if (own !== turn) return opened.figure.dispose();
      if (opened.doubtful) await bones.askBones(opened, opened.guess);
      else {
        use(opened);
        context.notify('info', `“${opened.name}” dances now.`, {
          label: CHECK,
          run: () => void bones.checkBones(),
        });
      }
    } catch (error) {
      if (own === turn) context.notify('error', `“${file.name}” was not opened. ${messageOf(error)}`);
    } finally {
      if (own === turn) state.avatarJob.value = null;
    }
  }

  /** One of the kept characters; null where it cannot be had any more. */
  async function reopen(id: string): Promise<AvatarInUse | null> {
    const kept = state.avatars.value.find((each) => each.id === id);
    const bytes = unkept.get(id) ?? (await store.bytes(id).catch(() => null));
    if (!kept || !bytes) return null;
    const { name, map } = kept;
    const source = { bytes, name, map };
    const figure: AvatarFigure = await (await opener()).openAvatar(source);
    return { id, name, source, figure };
  }

  /** Lets one of the kept characters dance, or our own figure. */
  async function useAvatar(id: string | null): Promise<void> {
    const own = (turn += 1);
    state.avatarJob.value = null;
    if (id === null) {
      show(null);
      choose(null);
      context.announce('Posebeat’s figure dances.');
      return;
    }
    const name = state.avatars.value.find((each) => each.id === id)?.name ?? 'The character';
    state.avatarJob.value = name;
    try {
      const found = await reopen(id);
      if (own !== turn) return found?.figure.dispose();
      if (!found) throw new Error('This browser did not keep it: open its file again.');
      show(found);
      void keep(found, false);
      context.announce(`${name} dances.`);
    } catch (error) {
      if (own === turn) context.notify('error', `“${name}” cannot dance. ${messageOf(error)}`);
    } finally {
      if (own === turn) state.avatarJob.value = null;
    }
  }

  return {
    ...bones.actions,
    openCharacter,
    useAvatar,

    /** Opens a dropped glTF file: as a character or as a motion, and asks where it is both. */
    async openGltf(file: File, asMotion: (file: File) => unknown): Promise<void> {
      if (/\.vrm$/i.test(file.name) || file.size > MAX_AVATAR_BYTES || !mayBeAvatar(file)) return openCharacter(file);
      let parts = { character: false, motion: true };
      try {
        parts = gltfParts(new Uint8Array(await file.arrayBuffer()));
      } catch {
        // Whoever opens it says what is wrong.
      }
      if (!parts.character) asMotion(file);
      else if (!parts.motion) await openCharacter(file);
      else state.avatarQuestion.value = file;
    },

    /** Brings what this browser has kept, and the character that danced last. */
    async restoreAvatar(): Promise<void> {
      const kept = await store.load().catch(() => null);
      if (!kept) return;
      list([...kept.avatars, ...state.avatars.value.filter(({ id }) => unkept.has(id))]);
      if (kept.chosen && !state.avatar.value && state.avatarJob.value === null) await useAvatar(kept.chosen);
    },

    /** Forgets a character; it can be taken back for a moment. */
    async removeAvatar(id: string): Promise<void> {
      const gone = state.avatars.value.find((each) => each.id === id);
      if (!gone) return;
      const inUse = state.avatar.value?.id === id;
      const bytes = unkept.get(id) ?? (await store.bytes(id).catch(() => null));
      if (inUse) await useAvatar(null);
      list(without([id]));
      unkept.delete(id);
      await store.remove(id).catch(() => undefined);
      context.notify(
        'info',
        `“${gone.name}” is removed from this browser.`,
        bytes
          ? {
              label: 'Keep it',
              run: () => {
                list([...without([id]), gone]);
                void store.put(gone, bytes).catch(() => unkept.set(id, bytes));
                if (inUse) void useAvatar(id);
              },
            }
          : undefined,
      );
    },

    /**
     * For scripts: opens a file and lets it dance, or our own figure.
     * @throws Error with what is wrong, bones that are missing included; then nothing has changed
     */
    async setAvatar(
      file: File | Blob | null,
      options: SetAvatarOptions = {},
    ): Promise<{ name: string; height: number } | null> {
      if (file === null) {
        await useAvatar(null);
        return null;
      }
      if (!(file instanceof Blob)) throw new Error('setAvatar takes a File, a Blob or null.');
      turn += 1;
      const opened = await open(file, options);
      const { problems, notes, usable } = (await opener()).judgeBones(opened.figure.rig, [...opened.source.map]);
      if (!usable) {
        opened.figure.dispose();
        const wrong = [...problems, ...notes].filter((problem) => problem !== null).slice(0, 3);
        throw new Error(
          `Bones of this character could not be told. ${wrong.join(' ')} Say which they are with the option bones.`,
        );
      }
      use(opened);
      return { name: opened.name, height: opened.figure.height };
    },
  };
}
