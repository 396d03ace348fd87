import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { Player } from '../../web/audio/player';
import { createStore } from '../../web/app/store';
import { frameOf } from '../../web/core/document';
import { lastKeyTime } from '../../web/core/key-ops';
import { fakeReporter, fakeServices, SONG_SECONDS } from '../unit/support/app';

const time = fc.double({ min: -1, max: SONG_SECONDS + 1, noNaN: true });
const seconds = fc.double({ min: -6, max: 6, noNaN: true });
const direction = fc.constantFrom(-1 as const, 1 as const);
const number = fc.nat({ max: 9 });

/** Everything that a visitor can do to key poses; numbers choose key poses from those there are. */
const step = fc.oneof(
  fc.record({ do: fc.constant('add' as const), time, exact: fc.boolean() }),
  fc.record({ do: fc.constant('select' as const), number, extend: fc.boolean() }),
  fc.record({ do: fc.constant('selectTo' as const), number }),
  fc.record({ do: fc.constant('band' as const), time, seconds }),
  fc.record({ do: fc.constant('all' as const) }),
  fc.record({
    do: fc.constant('drag' as const),
    number,
    moves: fc.array(seconds, { maxLength: 4 }),
    exact: fc.boolean(),
    copy: fc.boolean(),
    keep: fc.boolean(),
  }),
  fc.record({ do: fc.constant('nudge' as const), direction, unit: fc.constantFrom('beat' as const, 'frame' as const) }),
  fc.record({ do: fc.constant('time' as const), number, time }),
  fc.record({ do: fc.constant('delete' as const) }),
  fc.record({ do: fc.constant('lock' as const) }),
  fc.record({ do: fc.constant('strength' as const), values: fc.array(fc.double({ min: 0, max: 1, noNaN: true })) }),
  fc.record({ do: fc.constant('distribute' as const) }),
  fc.record({ do: fc.constant('duplicate' as const) }),
  fc.record({ do: fc.constant('copy' as const) }),
  fc.record({ do: fc.constant('cut' as const) }),
  fc.record({ do: fc.constant('paste' as const), time }),
  fc.record({ do: fc.constant('snap' as const) }),
  fc.record({ do: fc.constant('mirror' as const) }),
  fc.record({ do: fc.constant('undo' as const) }),
  fc.record({ do: fc.constant('redo' as const) }),
);
type Step = typeof step extends fc.Arbitrary<infer T> ? T : never;

async function openStore() {
  const store = createStore(fakeServices(new Player(() => ({}) as AudioContext)), fakeReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  return store;
}
type Store = Awaited<ReturnType<typeof openStore>>;

function run(store: Store, each: Step, canUndo: boolean): void {
  const keys = store.state.document.value.keyPoses;
  const id = (at: number) => keys[at % Math.max(1, keys.length)]?.id ?? 'nobody';
  if (each.do === 'add') store.addKey(new Array<number>(72).fill(0.1), each.time, { exact: each.exact });
  else if (each.do === 'select') store.selectKey(id(each.number), each.extend);
  else if (each.do === 'selectTo') store.selectTo(id(each.number));
  else if (each.do === 'band') store.selectBetween(each.time, each.time + each.seconds);
  else if (each.do === 'all') store.selectAll();
  else if (each.do === 'drag') {
    store.beginMove();
    for (const move of each.moves) store.previewMove(move, id(each.number), each.exact, each.copy);
    if (each.keep) store.commitMove();
    else store.discardMove();
  } else if (each.do === 'nudge') store.nudgeKeys(each.direction, each.unit);
  else if (each.do === 'time') store.setKeyTime(id(each.number), each.time);
  else if (each.do === 'delete') store.deleteKeys();
  else if (each.do === 'lock') store.toggleLock();
  else if (each.do === 'strength') {
    for (const value of each.values) store.previewKeyStrength(value);
    store.setKeyStrength(each.values[0] ?? 1);
  } else if (each.do === 'distribute') store.distributeKeys();
  else if (each.do === 'duplicate') store.duplicateKeys();
  else if (each.do === 'copy') store.copyKeys();
  else if (each.do === 'cut') store.cutKeys();
  else if (each.do === 'paste') {
    store.seek(each.time);
    store.pasteKeys();
  } else if (each.do === 'snap') store.cycleSnap();
  else if (each.do === 'mirror') store.mirrorKeys();
  else if (each.do === 'redo') store.redo();
  else if (canUndo) store.undo();
}

describe('key poses, whatever is done to them', () => {
  it('stay in order, one a frame, inside the song; locked ones stay; undoing all and redoing all changes no bit', async () => {
    await fc.assert(
      fc.asyncProperty(fc.array(step, { maxLength: 40 }), async (steps) => {
        const store = await openStore();
        const { state } = store;
        // Bringing the song is a step too; it is not about key poses.
        const song = state.undoLabel.value;
        const undoable = () => state.undoLabel.value !== song;
        const first = JSON.stringify(state.document.value);
        for (const each of steps) {
          const before = state.document.value.keyPoses.filter((key) => key.locked);
          run(store, each, undoable());
          const keys = state.document.value.keyPoses;
          for (let i = 0; i < keys.length; i += 1) {
            expect(keys[i].time).toBeGreaterThanOrEqual(0);
            expect(keys[i].time).toBeLessThanOrEqual(lastKeyTime(SONG_SECONDS));
            if (i > 0) expect(frameOf(keys[i].time)).toBeGreaterThan(frameOf(keys[i - 1].time));
          }
          expect(new Set(keys.map((key) => key.id)).size).toBe(keys.length);
          for (const id of state.selection.value) expect(keys.some((key) => key.id === id)).toBe(true);
          if (['undo', 'redo', 'lock'].includes(each.do)) continue;
          for (const key of before) expect(keys).toContain(key);
        }
        while (state.redoLabel.value !== null) store.redo();
        const last = JSON.stringify(state.document.value);
        while (undoable()) store.undo();
        expect(JSON.stringify(state.document.value)).toBe(first);
        while (state.redoLabel.value !== null) store.redo();
        expect(JSON.stringify(state.document.value)).toBe(last);
      }),
      { numRuns: 60 },
    );
  }, 120_000);
});
