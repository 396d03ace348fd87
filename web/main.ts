/** Puts the parts together. */
import { h, render } from 'preact';
import { createApi } from './app/api';
import { createAssets } from './app/assets';
import { noAvatarStore } from './app/avatar-store';
import { answerMessages, embedWish, noStorage, type Frame } from './app/embed';
import { createEngine } from './app/engine';
import { followAddress } from './app/link-address';
import { createListener } from './app/listener';
import { keepOffline, offlineBrowser } from './app/offline';
import { createReporter } from './app/report-client';
import { createStorage } from './app/storage';
import { createStore } from './app/store';
import { createSuggester } from './app/suggester';
import { createTabs } from './app/tabs';
import { Player } from './audio/player';
import { App } from './ui/App';
import { EmbedApp } from './ui/share/EmbedApp';
import { bindShortcuts, SHORTCUTS } from './ui/shortcuts';
import { Thumbnails } from './ui/thumbs';
import type { Backend } from './workers/protocol';
import './style.css';
import './style-layout.css';
import './style-timeline.css';
import './style-beats.css';
import './style-ranges.css';
import './style-suggest.css';
import './style-panels.css';
import './style-pose.css';
import './style-library.css';
import './style-report.css';
import './style-curves.css';
import './style-project.css';
import './style-export.css';
import './style-video.css';
import './style-share.css';
import './style-figure.css';
import './style-avatar.css';
import './style-phone.css';
import './style-contrast.css';

const asked = new URLSearchParams(location.search).get('backend');
const forcedBackend: Backend | undefined = asked === 'wasm' || asked === 'webgpu' ? asked : undefined;

const { embedded, origin } = wish();

/** How the page shall show itself; a frame that cannot says why instead of staying empty. */
function wish() {
  try {
    return embedWish(location.search);
  } catch (error) {
    document.getElementById('app')!.textContent = (error as Error).message;
    throw error;
  }
}

const tabs = embedded ? undefined : createTabs();
const store = createStore(
  {
    player: new Player(),
    listener: createListener(),
    engine: createEngine((model) => store.modelMoved(model)),
    suggester: createSuggester(),
    // The dance of somebody's link takes no place of the visitor's own work until it is changed.
    storage: tabs ? createStorage('posebeat', () => tabs.writes.value && !store.isGuest.value) : noStorage(),
    tabs,
    assets: createAssets(document.baseURI),
    avatarStore: embedded ? noAvatarStore() : undefined,
    forcedBackend,
  },
  createReporter(),
);
const thumbnails = new Thumbnails();

window.posebeat = createApi(store, store.start(location.hash));
bindShortcuts(store, window, embedded ? SHORTCUTS.filter(({ group }) => group === 'Play') : SHORTCUTS);
for (const gesture of ['pointerdown', 'keydown'])
  window.addEventListener(gesture, () => store.unlock(), { capture: true });

/** The page inside another one: nothing to be kept, nothing to be edited. */
function openEmbedded(): void {
  render(h(EmbedApp, { store }), document.getElementById('app')!);
  answerMessages(window.posebeat, window as unknown as Frame, origin);
}

async function openWhole(): Promise<void> {
  void store.loadOwnPoses();
  // Another tab may have saved some.
  window.addEventListener('focus', () => void store.loadOwnPoses());
  void store.countAside();
  void store.restoreAvatar();
  followAddress(store, window);
  render(h(App, { store, thumbnails }), document.getElementById('app')!);
  // Pictures wait until the stage has had its first frames.
  await store.whenReady();
  const { createThumbnailer } = await import('./scene/thumbnails');
  thumbnails.connect(createThumbnailer(), () => store.whenCalm());
  const browser = import.meta.env.PROD ? offlineBrowser(window) : null;
  await store.whenCalm();
  if (browser) await keepOffline(store, browser);
}

if (embedded) openEmbedded();
else void openWhole();
