/** Dances as links: made from the project at hand, and opened without losing what is there. */
import { computed, effect } from '@preact/signals';
import type { ProjectDocument } from '../../core/document';
import { parseDocument } from '../../core/document-read';
import { readLink, writeLink, type SharedProject } from '../../core/formats/share-link';
import { standIn } from '../../core/stand-in';
import { isAbort, messageOf, type Context } from '../context';
import type { SavedDance } from '../ports';
import type { DanceActions } from './dance';
import type { DemoActions } from './demo';
import type { ProjectActions } from './project';
import type { SongActions } from './song';
import { onSong } from './song-offers';

/** Longer links are not made, characters: browsers take more, but not much else does. */
export const MAX_LINK = 8000;
/** Longer links may be cut by chat programs, characters. */
export const SAFE_LINK = 2000;
const STEP = 'Open link';

/** Actions on links. `others` are the groups of actions that opening one needs. */
export function shareActions(
  context: Context,
  others: { songs: SongActions; demo: DemoActions; dance: DanceActions; project: ProjectActions },
) {
  const { state, services, history } = context;
  const { songs, demo, dance, project } = others;

  /** The project of the link as it was sent, while another song stands in for its own. */
  let sent: ProjectDocument | null = null;
  /** What was there before the link. */
  let former: ProjectDocument | null = null;

  const isGuest = computed(() => {
    const guest = state.guest.value;
    return guest !== null && sameButCamera(guest, state.document.value);
  });

  effect(() => {
    const { value: document } = state.document;
    const done = state.song.value?.demo === false || (former !== null && document === former);
    if (!state.wanted.peek() || !done) return;
    if (document === former) songs.awaitSong(null);
    state.wanted.value = null;
    sent = null;
  });

  /** The project that was kept here last, and its dance. */
  async function kept(): Promise<{ document: ProjectDocument; dance: SavedDance | null } | null> {
    try {
      const saved = await services.storage.load();
      return saved && { document: parseDocument(saved.document).document, dance: saved.dance };
    } catch {
      return null;
    }
  }

  /** True when somebody would miss it. */
  const isWork = (document: ProjectDocument, original: ProjectDocument | null) =>
    document.song !== null && !(original && project.sameWork(document, original));

  /** The dance of a link to a song that is not here, to the demo's song. */
  async function showOnDemo({ document }: SharedProject, original: ProjectDocument | null): Promise<void> {
    if (!original) throw new Error('The demo’s song could not be loaded.');
    sent = document;
    const shown = standIn(document, original);
    await demo.showDemo({ document: shown, step: STEP });
    state.wanted.value = document.song;
    songs.awaitSong(document.song ? document : null);
  }

  async function show(shared: SharedProject, original: ProjectDocument | null): Promise<void> {
    const { document } = shared;
    const { song } = document;
    sent = null;
    state.wanted.value = null;
    const here = state.song.value?.reference;
    if (song && here?.hash === song.hash) {
      history.push(onSong(document, here), STEP);
      context.sync();
    } else if (song && original?.song?.hash === song.hash) await demo.showDemo({ document, step: STEP });
    else if (!song || !(await project.openDocument(document, null))) await showOnDemo(shared, original);
  }

  /** Back to what was there before the link, its dance too. */
  async function bringBack(document: ProjectDocument, saved: SavedDance | null): Promise<void> {
    if (history.undoLabel === STEP || history.undoLabel === 'Open project') history.undo();
    else history.push(document, 'Bring back a project');
    context.sync();
    await songs.followDocument();
    if (saved && !dance.bringBack()) dance.restoreDance(saved);
  }

  /**
   * Opens a link; a damaged one becomes a notice and changes nothing. What was there is one step of undo away, and kept aside in this
   * browser.
   * @param hash - The part of the address from `#` on.
   * @param first - The page opens with it: what was kept here last is what was there.
   * @returns false when nothing was opened
   */
  async function openLink(hash: string, first = false): Promise<boolean> {
    try {
      const shared = readLink(hash);
      const original = await demo.demoDocument();
      const saved = first ? await kept() : null;
      const before = first ? (saved?.document ?? original) : history.present;
      const owned = before !== null && !isGuest.value && isWork(before, original);
      if (first && before) history.reset(before);
      if (owned)
        await services.storage.setAside?.(before).then(
          (count) => (state.aside.value = count),
          () => undefined,
        );
      await show(shared, original);
      former = before;
      state.guest.value = history.present;
      tell(shared, owned ? { document: before, dance: saved?.dance ?? null } : null);
      // Without a gesture browsers let a page dance, but not sound.
      if (first) services.player.setMuted(true);
      services.player.play();
      if (state.stale.value) void dance.generateForPage().then(() => compareModels(shared.model));
      return true;
    } catch (error) {
      if (!isAbort(error)) context.notify('error', messageOf(error));
      return false;
    }
  }

  function tell(
    { repairs }: SharedProject,
    owned: { document: ProjectDocument; dance: SavedDance | null } | null,
  ): void {
    if (repairs.length > 0) context.notify('info', `Opened with repairs. ${repairs.join(' ')}`);
    context.announce('The dance of the link is open.');
    if (!owned) return;
    context.notify('info', 'The dance of the link is open. Your own project is kept.', {
      label: 'Undo',
      run: () => void bringBack(owned.document, owned.dance),
    });
  }

  /** Another model makes another dance of the same poses. */
  function compareModels(model: string): void {
    const own = state.dance.value?.result?.model;
    if (!isGuest.value || !model || !own || own === model) return;
    context.notify(
      'info',
      `This dance was made by another model (${model}; here it is ${own}): it may move differently.`,
    );
  }

  return {
    openLink,

    /** True while the page shows the dance of a link that nobody has changed: it is not kept in this browser. */
    isGuest,

    /**
     * The project at hand as an address.
     * @param page - Address of the page; what stands after its path is left out.
     * @throws Error when it would be too long for an address
     */
    shareLink(page: string): string {
      const document = sent && isGuest.value ? sent : state.document.value;
      const hash = writeLink(document, state.dance.value?.result?.model ?? state.model.value?.model ?? '');
      const link = new URL(page);
      const address = `${link.origin === 'null' ? 'file://' : link.origin}${link.pathname}${hash}`;
      if (address.length <= MAX_LINK) return address;
      const count = (value: number) => value.toLocaleString('en');
      throw new Error(
        `This dance is too long for a link (${count(address.length)} characters, at most ${count(MAX_LINK)}): save the project as a .posebeat file and send that.`,
      );
    },

    /** Opens or closes the panel with the link. */
    toggleShare: (open = !state.shareOpen.value) => (state.shareOpen.value = open),

    /** The visitor goes on with the demo's song. */
    dismissWanted: () => (state.wanted.value = null),

    /** How many projects were put aside in this browser when a link was opened. */
    async countAside(): Promise<void> {
      state.aside.value = (await services.storage.countAside?.().catch(() => 0)) ?? 0;
    },

    /** Opens the project that was put aside last, as one step that can be undone; errors become notices. */
    async openAside(): Promise<void> {
      try {
        const last = await services.storage.takeAside?.();
        if (!last) return;
        state.aside.value = last.left;
        const { document } = parseDocument(last.document);
        if (!(await project.openDocument(document, null))) {
          context.notify('info', `Now drop “${document.song?.name ?? ''}”, the song of this project.`);
        } else if (state.stale.value && (state.song.value?.buffer || state.song.value?.demo))
          void dance.generateForPage();
      } catch (error) {
        if (!isAbort(error)) context.notify('error', messageOf(error));
      }
    },
  };
}

/** Actions on links. */
export type ShareActions = ReturnType<typeof shareActions>;

/** The same parts, but for where the visitor looks from. */
function sameButCamera(a: ProjectDocument, b: ProjectDocument): boolean {
  if (a === b) return true;
  const names = new Set([...Object.keys(a), ...Object.keys(b)] as (keyof ProjectDocument)[]);
  return [...names].every((name) => name === 'camera' || a[name] === b[name]);
}
