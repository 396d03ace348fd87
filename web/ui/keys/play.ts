import type { Shortcut } from './shortcut';

/** Keys that play the dance and step through it. */
export const PLAY_SHORTCUTS: readonly Shortcut[] = [
  { id: 'play', keys: ['Space'], label: 'Play or pause', group: 'Play', run: (store) => store.togglePlay() },
  { id: 'frame-back', keys: [','], label: 'One frame back', group: 'Play', run: (store) => store.stepFrame(-1) },
  { id: 'frame-on', keys: ['.'], label: 'One frame on', group: 'Play', run: (store) => store.stepFrame(1) },
  { id: 'key-back', keys: ['<'], label: 'Previous key pose', group: 'Play', run: (store) => store.stepKey(-1) },
  { id: 'key-on', keys: ['>'], label: 'Next key pose', group: 'Play', run: (store) => store.stepKey(1) },
  { id: 'loop', keys: ['L'], label: 'Loop on or off', group: 'Play', run: (store) => store.toggleLoop() },
];
