/** Puts the parts together. */
import { h, render } from 'preact';
import { createApi } from './app/api';
import { createAssets } from './app/assets';
import { createEngine } from './app/engine';
import { createListener } from './app/listener';
import { createReporter } from './app/report-client';
import { createStorage } from './app/storage';
import { createStore } from './app/store';
import { createTabs } from './app/tabs';
import { Player } from './audio/player';
import { App } from './ui/App';
import { bindShortcuts } from './ui/shortcuts';
import { Thumbnails } from './ui/thumbs';
import type { Backend } from './workers/protocol';
import './style.css';
import './style-layout.css';
import './style-timeline.css';
import './style-beats.css';
import './style-ranges.css';
import './style-panels.css';
import './style-pose.css';
import './style-library.css';
import './style-report.css';
import './style-project.css';
import './style-phone.css';

const asked = new URLSearchParams(location.search).get('backend');
const forcedBackend: Backend | undefined = asked === 'wasm' || asked === 'webgpu' ? asked : undefined;

const tabs = createTabs();
const store = createStore(
  {
    player: new Player(),
    listener: createListener(),
    engine: createEngine((model) => store.modelMoved(model)),
    storage: createStorage('posebeat', () => tabs.writes.value),
    tabs,
    assets: createAssets(document.baseURI),
    forcedBackend,
  },
  createReporter(),
);
const thumbnails = new Thumbnails();

window.posebeat = createApi(store, store.start());
void store.loadOwnPoses();
// Another tab may have saved some.
window.addEventListener('focus', () => void store.loadOwnPoses());
bindShortcuts(store, window);
for (const gesture of ['pointerdown', 'keydown'])
  window.addEventListener(gesture, () => store.unlock(), { capture: true });
render(h(App, { store, thumbnails }), document.getElementById('app')!);

// Pictures wait until the stage has had its first frames.
void store.whenReady().then(async () => {
  const { createThumbnailer } = await import('./scene/thumbnails');
  thumbnails.connect(createThumbnailer(), () => store.whenCalm());
});
