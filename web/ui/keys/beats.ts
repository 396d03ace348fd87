import type { Shortcut } from './shortcut';

/** Keys that correct the beats. */
export const BEAT_SHORTCUTS: readonly Shortcut[] = [
  {
    id: 'tap',
    keys: ['T'],
    label: 'Tap the tempo along with the song',
    group: 'Beats',
    run: (store, event) => {
      if (!event.repeat) store.tapTempo(event.timeStamp);
    },
  },
  {
    id: 'beats-earlier',
    keys: ['['],
    label: 'All beats 10 ms earlier',
    group: 'Beats',
    run: (store) => store.nudgeBeats(-1, 'fine'),
  },
  {
    id: 'beats-later',
    keys: [']'],
    label: 'All beats 10 ms later',
    group: 'Beats',
    run: (store) => store.nudgeBeats(1, 'fine'),
  },
  {
    id: 'beats-frame-earlier',
    keys: ['{'],
    label: 'All beats one frame earlier',
    group: 'Beats',
    run: (store) => store.nudgeBeats(-1, 'frame'),
  },
  {
    id: 'beats-frame-later',
    keys: ['}'],
    label: 'All beats one frame later',
    group: 'Beats',
    run: (store) => store.nudgeBeats(1, 'frame'),
  },
  {
    id: 'metronome',
    keys: ['K'],
    label: 'A click on every beat',
    group: 'Beats',
    run: (store) => store.toggleMetronome(),
  },
];
