/** Saves the document by itself: soon after a change, at the latest some seconds later, and at once when the page goes away. */
import { effect } from '@preact/signals';
import type { ProjectDocument } from '../core/document';
import type { Context } from './context';
import { isFull } from './storage';

/** Waits until nothing changed for this long, milliseconds. */
const DELAY = 600;
/** A drag that goes on and on is saved in between, milliseconds. */
const LONGEST_DELAY = 3000;
/** With this many key poses a project is worth asking the browser to keep it through its own clean-ups. */
const WORTH_KEEPING = 3;

/** The document's keeper. */
export interface Autosave {
  /** Saves what is not saved yet. */
  flush(): Promise<void>;
  /** The document as it was last opened or saved, to tell whether there is work of this tab's own. */
  readonly settled: ProjectDocument | null;
  /** Takes a document as saved already: it came from storage. */
  settle(document: ProjectDocument): void;
}

/** Starts saving; `save` is what the visitor can do when this browser cannot. */
export function startAutosave(context: Context, save: () => void): Autosave {
  const { state, services } = context;
  let settled: ProjectDocument | null = null;
  /** On its way into storage, or refused by it. */
  let unsaved: ProjectDocument | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  let waitingSince = 0;
  let told = false;
  let askedToPersist = false;

  const write = async (): Promise<void> => {
    clearTimeout(timer);
    timer = undefined;
    const document = state.document.value;
    if (!settled || document === settled || !document.song || services.tabs?.writes.value === false) return;
    settled = unsaved = document;
    try {
      await services.storage.saveDocument(document);
      if (unsaved === document) unsaved = null;
      state.unkept.value = false;
      persistOnce(document);
    } catch (error) {
      state.unkept.value = true;
      if (told) return;
      told = true;
      context.notify(
        'error',
        isFull(error)
          ? 'The disk is full: this browser no longer keeps your work. Save the project as a file, then make some room.'
          : 'This browser does not keep your work (private window?): save the project as a file before you leave.',
        { label: 'Save the project', run: save },
      );
    }
  };

  /** Some browsers ask the visitor: once, and only when there is something to lose. */
  const persistOnce = (document: ProjectDocument) => {
    if (askedToPersist || document.keyPoses.length < WORTH_KEEPING || state.song.value?.demo) return;
    askedToPersist = true;
    services.storage.persist?.().catch(() => undefined);
  };

  effect(() => {
    const document = state.document.value;
    if (!state.ready.value || !document.song) return;
    // What the page opened with is not the visitor's work.
    settled ??= document;
    if (document === settled) return;
    if (timer === undefined) waitingSince = performance.now();
    clearTimeout(timer);
    const left = LONGEST_DELAY - (performance.now() - waitingSince);
    timer = setTimeout(() => void write(), Math.min(DELAY, Math.max(0, left)));
  });

  /** The page goes away: what is not saved for good is noted, since nothing that takes time may come to its end. */
  const leave = () => {
    const document = state.document.value;
    const writes = services.tabs?.writes.value !== false;
    if (settled && document.song && writes && (document !== settled || unsaved)) {
      services.storage.noteDocument?.(document);
    }
    void write();
  };
  if (typeof window !== 'undefined') {
    window.addEventListener('pagehide', leave);
    document.addEventListener('visibilitychange', () => document.visibilityState === 'hidden' && leave());
  }

  return {
    flush: write,
    get settled() {
      return settled;
    },
    settle(document) {
      settled = document;
      unsaved = null;
    },
  };
}
