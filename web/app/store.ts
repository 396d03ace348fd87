/** The store: signals, and the only actions that write them. */
import { batch, effect } from '@preact/signals';
import { createDocument, type ProjectDocument } from '../core/document';
import { isLink } from '../core/formats/share-link';
import { History } from '../core/history';
import type { BeatGrid, Features } from '../core/types';
import { avatarActions } from './actions/avatar';
import { beatActions } from './actions/beats';
import { cameraActions } from './actions/camera';
import { compareActions } from './actions/compare';
import { curveActions, withOwnCurves } from './actions/curves';
import { danceActions } from './actions/dance';
import { demoActions } from './actions/demo';
import { exportActions } from './actions/export';
import { keyActions } from './actions/keys';
import { layoutActions } from './actions/layout';
import { libraryActions } from './actions/library';
import { motionImportActions } from './actions/motion-import';
import { lookActions } from './actions/look';
import { overlayActions } from './actions/overlays';
import { playbackActions } from './actions/playback';
import { poseActions } from './actions/pose';
import { poseImportActions } from './actions/pose-import';
import { pictureActions } from './actions/picture';
import { projectActions } from './actions/project';
import { rangeActions } from './actions/ranges';
import { shareActions } from './actions/share';
import { songActions } from './actions/song';
import { stillActions } from './actions/stills';
import { suggestActions } from './actions/suggest';
import { tabActions } from './actions/tabs';
import { tourActions } from './actions/tour';
import { viewActions } from './actions/view';
import { tapActions } from './actions/tap';
import { trimActions } from './actions/trim';
import { videoActions } from './actions/video';
import { updateActions } from './actions/update';
import { startAutosave } from './autosave';
import type { Context, Services } from './context';
import { tuningActions } from './actions/tuning';
import { DanceCache } from './dance-cache';
import { poseMath } from './pose-math';
import type { Reporter } from './report-client';
import { createState } from './state';

/** Info notices go by themselves, milliseconds; errors stay until dismissed. */
const INFO_LIFETIME = 7000;
/** One with a button stays long enough to be reached by keyboard. */
const ACTION_LIFETIME = 20_000;

/** Puts state and actions together. */
export function createStore(services: Services, reporter: Reporter) {
  const state = createState();
  const history = new History<ProjectDocument>(createDocument());
  let notices = 0;

  const context: Context = {
    state,
    services,
    history,
    sync() {
      batch(() => {
        state.document.value = history.present;
        state.undoLabel.value = history.undoLabel;
        state.redoLabel.value = history.redoLabel;
        const ids = new Set(history.present.keyPoses.map((key) => key.id));
        const chosen = [...state.selection.value].filter((id) => ids.has(id));
        if (chosen.length !== state.selection.value.size) state.selection.value = new Set(chosen);
      });
    },
    change(label, edit) {
      history.push(withOwnCurves(edit(history.present)), label);
      context.sync();
    },
    notify(kind, text, action) {
      const id = (notices += 1);
      const others = state.notices.value.filter((notice) => notice.text !== text);
      state.notices.value = [...others, { id, kind, text, ...(action ? { action } : {}) }];
      if (kind === 'info') {
        setTimeout(
          () => (state.notices.value = state.notices.value.filter((notice) => notice.id !== id)),
          action ? ACTION_LIFETIME : INFO_LIFETIME,
        );
      }
    },
    announce: (text) => (state.announcement.value = text),
    analysed: () => analysed(),
  };

  const cache = new DanceCache(() => state.frames.value);
  const dance = danceActions(context, reporter, cache);
  const tuning = tuningActions(context, reporter, dance, cache);
  const beats = beatActions(context, dance.measureShown);
  const ranges = rangeActions(context, dance);
  const compare = compareActions(context, dance);
  const keys = keyActions(context);
  const view = viewActions(context);
  const curves = curveActions(context, dance, cache, view.revealTime);
  const playback = playbackActions(context, view.revealTime);
  const pose = poseActions(context, keys, poseMath);
  const library = libraryActions(context, services.poseStore);
  const songs = songActions(context, dance);
  const demo = demoActions(context, songs, dance);
  const project = projectActions(context, songs, demo, dance);
  const share = shareActions(context, { songs, demo, dance, project });
  const autosave = startAutosave(context, () => void project.saveProject(true));
  const tabs = tabActions(context, autosave, project);

  /** Features and beats of the whole song, waiting for the analysis where it still runs. */
  function analysed(): Promise<{ features: Features; grid: BeatGrid }> {
    return new Promise((resolve, reject) => {
      const stop = effect(() => {
        const song = state.song.value;
        if (song?.complete && song.features && song.grid) {
          resolve({ features: song.features, grid: song.grid });
          queueMicrotask(() => stop());
        } else if (!song) {
          reject(new Error('There is no song yet: drop one first.'));
          queueMicrotask(() => stop());
        } else if (!song.buffer && !song.demo) {
          reject(new Error(`Drop “${song.reference.name}” first: its sound is not kept in this browser.`));
          queueMicrotask(() => stop());
        }
      });
    });
  }

  /** Undo in the pose editor works on the pose, elsewhere on the project. */
  const undo = () => {
    if (state.draft.value) pose.undoPose();
    else {
      keys.undo();
      void songs.followDocument();
    }
  };
  const redo = () => {
    if (state.draft.value) pose.redoPose();
    else {
      keys.redo();
      void songs.followDocument();
    }
  };

  const when = (condition: () => boolean) =>
    new Promise<void>((resolve) => {
      const stop = effect(() => {
        if (!condition()) return;
        resolve();
        queueMicrotask(() => stop());
      });
    });
  /** Resolves when the page has opened. */
  const whenReady = () => when(() => state.ready.value);
  /** Resolves when no song is on its way in and no dance is being made. */
  const whenCalm = () => when(() => state.songJob.value === null && state.generation.value.status === 'idle');

  return {
    state,
    ...dance,
    ...tuning,
    ...curves,
    ...ranges,
    ...compare,
    ...pictureActions(context, dance),
    ...suggestActions(context, dance.generateForPage),
    ...keys,
    ...beats,
    ...tapActions(context, beats),
    ...trimActions(context),
    ...playback,
    ...pose,
    ...library,
    ...poseImportActions(context, library, keys, pose),
    ...songs,
    ...project,
    ...share,
    ...updateActions(context, autosave),
    /** Opens the page; with the end of an address that is a link, with its dance. */
    start: (link = '') => project.start(isLink(link) ? () => share.openLink(link, true) : undefined),
    ...exportActions(context),
    ...avatarActions(context, services.avatarStore),
    ...motionImportActions(context),
    ...videoActions(context),
    ...stillActions(context),
    ...demo,
    ...tabs,
    ...view,
    ...cameraActions(context),
    ...tourActions(context),
    ...lookActions(context),
    ...overlayActions(context),
    ...layoutActions(context),
    undo,
    redo,
    whenReady,
    whenCalm,
    notify: context.notify,
    announce: context.announce,
  };
}

/** State and actions of the page. */
export type Store = ReturnType<typeof createStore>;
