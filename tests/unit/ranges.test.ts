import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { Player } from '../../web/audio/player';
import { rangeName, shortRangeName } from '../../web/app/range-name';
import { documentOnStage } from '../../web/app/on-stage';
import { recipeOf } from '../../web/app/recipe';
import { measureDance } from '../../web/app/report';
import type { Reporter } from '../../web/app/report-client';
import { createStore, type Store } from '../../web/app/store';
import type { ProjectDocument } from '../../web/core/document';
import { finishDance, type UncorrectedDance } from '../../web/core/finish';
import { jerkPerFrame, jointPositions } from '../../web/core/metrics';
import { motionToAxisAngle, sliceMotion } from '../../web/core/motion';
import type { Motion } from '../../web/core/types';
import { generateMotion, type RunWindow } from '../../web/core/windows';
import { poseWith, slerpNetwork, stepClip } from './dance';
import type { DanceRequest, Services } from './support/app';
import { fakeServices, settled } from './support/app';

const arms = poseWith({ left_shoulder: [0, 0, 0.9], right_shoulder: [0, 0, -0.9] });
const lunge = poseWith({ left_elbow: [0, -1.2, 0], right_hip: [-0.6, 0, 0], right_knee: [0.8, 0, 0] });

/** A report worker that really finishes dances. */
const realReporter = (): Reporter => ({
  measure: async (motion, keyPoses, grid, part) => measureDance(motion, keyPoses, grid, part),
  async finish({ uncorrected, keyPoses }, { strength }) {
    await settled();
    const motion = finishDance(uncorrected, keyPoses, strength);
    return { motion, report: measureDance(motion, keyPoses, null) };
  },
  plot: () => Promise.resolve(),
});

/** Interpolation that passes a fifth of the way beside the key poses, towards the T-pose, as a real network passes beside them. */
const besideKeys: RunWindow = (inputs) => {
  const upright = [1, 0, 0, 0, 1, 0];
  const keyPoses = inputs.keyPoses.map((value, i) => 0.8 * value + 0.2 * upright[i % 6]);
  return slerpNetwork({ ...inputs, keyPoses });
};

/** A page with a song of ten seconds (bars of two), two key poses and a network of plain interpolation. */
async function page(change: (services: Services) => void = () => undefined, network: RunWindow = slerpNetwork) {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  const requests: DanceRequest[] = [];
  services.assets.seeds = async () => [stepClip()];
  services.engine.generate = async (request, onPartial, signal) => {
    requests.push(request);
    let uncorrected: UncorrectedDance | undefined;
    const motion = await generateMotion(request, network, {
      signal,
      onUncorrected: (made) => (uncorrected = structuredClone(made)),
      onPartial,
    });
    await settled();
    signal.throwIfAborted();
    return { motion, uncorrected, backend: 'wasm', model: 'light', windows: 1, milliseconds: 5 };
  };
  change(services);
  const store = createStore(services, realReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  /** What was asked of the network since the last look. */
  const asked = () =>
    requests.splice(0).map(({ range, options }) => (range ? `${range.from}-${range.to} #${options.seed}` : 'whole'));
  return { store, services, requests, asked };
}

const start = async (store: Store) => {
  store.setKeyPoses([
    { time: 1, rotations: arms },
    { time: 6, rotations: lunge },
  ]);
  await store.generate();
  await calm();
};
const calm = async () => {
  for (let i = 0; i < 3; i++) await settled();
};
const danceOf = (store: Store) => store.state.dance.value!.motion;
const documentOf = (store: Store) => store.state.document.value;
const same = (a: Motion, b: Motion) => {
  // Comparing bytes is much quicker than comparing lists of numbers.
  expect(Buffer.compare(Buffer.from(a.root.buffer), Buffer.from(b.root.buffer))).toBe(0);
  expect(Buffer.compare(Buffer.from(a.quaternions.buffer), Buffer.from(b.quaternions.buffer))).toBe(0);
};
const differ = (a: Motion, b: Motion, from: number, to: number) =>
  sliceMotion(a, from, to)
    .quaternions.map((v, i) => Math.abs(v - b.quaternions[from * 96 + i]))
    .reduce((most, v) => Math.max(most, v), 0);

/** The dance that a page makes of a document in one go. */
async function madeAtOnce(document: ProjectDocument): Promise<Motion> {
  const { store } = await page();
  await store.openDocument(structuredClone(document), null);
  await store.generate();
  await calm();
  expect(store.state.stale.value).toBe(false);
  return danceOf(store);
}

describe('a range made anew', () => {
  it('is one step of undo, asks for that range only, and leaves all around it alone', async () => {
    const { store, asked } = await page();
    await start(store);
    const before = danceOf(store);
    expect(asked()).toEqual(['whole']);
    await store.regenerateRange({ start: 4, end: 8 });
    expect(asked()).toEqual(['120-240 #2']);
    expect(documentOf(store).ranges).toEqual([
      { id: 'r1', start: 4, end: 8, takes: [{ id: 't1', seed: 2, variation: 0.6 }], chosen: 't1' },
    ]);
    const after = danceOf(store);
    expect(differ(before, after, 140, 220)).toBeGreaterThan(0.05);
    const [old, now] = [motionToAxisAngle(before), motionToAxisAngle(after)];
    const outside = (t: number) => t < 120 || t >= 240;
    const turned = now.map((angle, i) => (outside(Math.floor(i / 72)) ? Math.abs(angle - old[i]) : 0));
    expect(turned.reduce((most, angle) => Math.max(most, angle), 0)).toBeLessThan(1e-6);
    expect(after.root.filter((_, i) => outside(Math.floor(i / 3)))).toEqual(
      before.root.filter((_, i) => outside(Math.floor(i / 3))),
    );
    store.undo();
    same(danceOf(store), before);
    expect(documentOf(store).ranges).toEqual([]);
    store.redo();
    same(danceOf(store), after);
    expect(asked()).toEqual([]);
    expect(store.state.stale.value).toBe(false);
  });

  it('gets another take each time, and takes made before come back without the network', async () => {
    const { store, asked } = await page(undefined, besideKeys);
    await start(store);
    const none = danceOf(store);
    await store.regenerateRange({ start: 4, end: 8 });
    const first = danceOf(store);
    await store.regenerateRange({ start: 4.01, end: 8 }); // the same range but for a frame
    const second = danceOf(store);
    expect(documentOf(store).ranges.map(({ takes, chosen }) => [takes.length, chosen])).toEqual([[2, 't2']]);
    expect(differ(first, second, 140, 220)).toBeGreaterThan(0.02);
    // A second range elsewhere: the first one's takes stay as good as they were.
    await store.regenerateRange({ start: 0, end: 1.5 });
    expect(asked()).toEqual(['whole', '120-240 #2', '120-240 #3', '0-45 #2']);
    await store.chooseTake('r1', 't1');
    await calm();
    same(sliceMotion(danceOf(store), 45, 300), sliceMotion(first, 45, 300));
    await store.chooseTake('r1', null);
    await calm();
    same(sliceMotion(danceOf(store), 45, 300), sliceMotion(none, 45, 300));
    store.setLoop({ start: 4, end: 8 });
    await store.stepTake(1);
    await store.stepTake(1);
    await calm();
    same(sliceMotion(danceOf(store), 45, 300), sliceMotion(second, 45, 300));
    await store.deleteTake('r1', 't2');
    await calm();
    expect(documentOf(store).ranges[0]).toMatchObject({ chosen: 't1', takes: [{ id: 't1' }] });
    await store.deleteTake('r1', 't1');
    await store.deleteRange('r2');
    await calm();
    same(danceOf(store), none);
    expect(asked()).toEqual([]);
    expect(store.state.stale.value).toBe(false);
  });

  it('that later ranges lie over is made anew below them', async () => {
    const { store, asked } = await page();
    await start(store);
    await store.regenerateRange({ start: 3, end: 6 });
    await store.regenerateRange({ start: 5, end: 9 });
    asked();
    await store.chooseTake('r1', null);
    expect(asked()).toEqual(['150-270 #2']);
    same(danceOf(store), await madeAtOnce(documentOf(store)));
    await store.chooseTake('r1', 't1');
    await calm();
    expect(asked()).toEqual([]);
    same(danceOf(store), await madeAtOnce(documentOf(store)));
  });

  it('that is cancelled or fails leaves document, dance and undo as they were', async () => {
    let fail = false;
    const { store } = await page((services) => {
      const make = services.engine.generate;
      services.engine.generate = (request, ...rest) =>
        fail ? Promise.reject(new Error('The network is tired.')) : make(request, ...rest);
    });
    await start(store);
    const before = [documentOf(store), store.state.dance.value, store.state.undoLabel.value];
    const making = store.regenerateRange({ start: 4, end: 8 });
    await Promise.resolve();
    expect(documentOf(store).ranges).toHaveLength(1);
    store.cancel();
    await making;
    expect([documentOf(store), store.state.dance.value, store.state.undoLabel.value]).toEqual(before);
    fail = true;
    await store.regenerateRange({ start: 4, end: 8 });
    expect([documentOf(store), store.state.dance.value, store.state.undoLabel.value]).toEqual(before);
    expect(store.state.notices.value.at(-1)?.text).toBe('The network is tired.');
    expect(store.state.generation.value.status).toBe('idle');
  });

  it('needs a range that is worth it', async () => {
    const { store, asked } = await page();
    await start(store);
    asked();
    await store.regenerateRange();
    expect(store.state.notices.value.at(-1)?.text).toMatch(/Select a range first/);
    await store.regenerateRange({ start: 4, end: 4.1 });
    expect(store.state.notices.value.at(-1)?.text).toMatch(/too short/);
    await store.stepTake(1);
    expect(store.state.notices.value.at(-1)?.text).toMatch(/no takes here/);
    expect(asked()).toEqual([]);
    expect(documentOf(store).ranges).toEqual([]);
  });

  it('joins without a pop, also where two ranges overlap or touch', async () => {
    const { store } = await page();
    await start(store);
    const before = danceOf(store);
    for (const [from, to] of [
      [2, 5],
      [4, 7],
      [7, 9],
    ]) {
      await store.regenerateRange({ start: from, end: to });
    }
    const after = danceOf(store);
    const jerk = (motion: Motion) => jerkPerFrame(motion, true);
    const speed = (motion: Motion) => {
      const p = jointPositions(motion);
      return Array.from({ length: motion.frames - 1 }, (_, t) => {
        let fastest = 0;
        for (let i = t * 72; i < t * 72 + 72; i += 3) {
          fastest = Math.max(fastest, Math.hypot(p[i + 72] - p[i], p[i + 73] - p[i + 1], p[i + 74] - p[i + 2]) * 30);
        }
        return fastest;
      });
    };
    const [limitJerk, limitSpeed] = [Math.max(...jerk(before)) * 1.3, Math.max(...speed(before)) * 1.3];
    for (const seconds of [2, 4, 5, 7, 9]) {
      const join = seconds * 30;
      expect(Math.max(...jerk(after).subarray(join - 4, join + 3)), `jerk at ${seconds} s`).toBeLessThan(limitJerk);
      expect(Math.max(...speed(after).slice(join - 3, join + 3)), `speed at ${seconds} s`).toBeLessThan(limitSpeed);
    }
  });
});

describe('the dance of a document', () => {
  it('is the same whether it was reached by editing or made in one go', async () => {
    const { store } = await page();
    await start(store);
    await store.regenerateRange({ start: 4, end: 8 });
    store.commitStrength(0.6);
    await calm();
    await store.regenerateRange({ start: 4, end: 8 });
    await store.regenerateRange({ start: 7, end: 10 });
    same(danceOf(store), await madeAtOnce(documentOf(store)));
    await store.chooseTake('r1', 't1');
    store.selectKey('k2');
    store.setKeyStrength(0.3);
    await calm();
    expect(store.state.stale.value).toBe(false);
    same(danceOf(store), await madeAtOnce(documentOf(store)));
    await store.showTake(5);
    await calm();
    same(danceOf(store), await madeAtOnce(documentOf(store)));
  });

  it('follows the strength of a key pose at once, and undo of it, without the network', async () => {
    const { store, asked } = await page(undefined, besideKeys);
    await start(store);
    await store.regenerateRange({ start: 4, end: 8 });
    const firm = danceOf(store);
    asked();
    store.selectKey('k2');
    store.setKeyStrength(0);
    await calm();
    expect(differ(firm, danceOf(store), 170, 190)).toBeGreaterThan(0.001);
    store.undo();
    await calm();
    same(danceOf(store), firm);
    expect(asked()).toEqual([]);
  });

  it('of a trimmed song is made, changed and measured inside the trim', async () => {
    const { store, asked, requests } = await page();
    await start(store);
    store.setTrim({ start: 2, end: 8 });
    expect(store.state.stale.value).toBe(true);
    await store.regenerateRange({ start: 6, end: 10 });
    expect(requests.map(({ trim }) => trim)).toEqual([undefined, { from: 60, to: 240 }, { from: 60, to: 240 }]);
    expect(asked()).toEqual(['whole', 'whole', '180-240 #2']);
    const made = danceOf(store);
    expect(made.frames).toBe(300);
    for (const t of [0, 59]) same(sliceMotion(made, t, t + 1), sliceMotion(made, 60, 61));
    for (const t of [240, 299]) same(sliceMotion(made, t, t + 1), sliceMotion(made, 239, 240));
    same(made, await madeAtOnce(documentOf(store)));
    expect(store.reportNow().consistencyPerKey.map(({ time }) => time)).toEqual([6]);
    await store.regenerateRange({ start: 8.5, end: 10 });
    expect(store.state.notices.value.at(-1)?.text).toMatch(/outside the part that is danced/);
    while (store.state.undoLabel.value) store.undo();
    while (store.state.redoLabel.value) store.redo();
    await calm();
    same(danceOf(store), made);
  });

  it('comes back after a reload, up to date and ready for more takes', async () => {
    const saved: { document?: ProjectDocument; dance?: unknown } = {};
    const first = await page((services) => {
      services.storage.saveDance = async (dance) => void (saved.dance = structuredClone(dance));
    });
    await start(first.store);
    await first.store.regenerateRange({ start: 4, end: 8 });
    const [before, document] = [danceOf(first.store), structuredClone(documentOf(first.store))];
    const { store, asked } = await page((services) => {
      services.storage.load = async () => ({ document, dance: saved.dance as never });
      services.storage.loadSong = async () => new File(['song'], 'a.mp3');
    });
    same(danceOf(store), before);
    expect(store.state.stale.value).toBe(false);
    await store.regenerateRange({ start: 4, end: 8 });
    expect(asked()).toEqual(['120-240 #3']);
    await store.chooseTake('r1', 't1');
    await calm();
    same(danceOf(store), before);
    expect(asked()).toEqual([]);
  });

  it('after any edits is the same again when all is undone and redone', async () => {
    const edit = fc.oneof(
      fc.record({
        type: fc.constant('range' as const),
        at: fc.integer({ min: 0, max: 7 }),
        long: fc.integer({ min: 1, max: 3 }),
      }),
      fc.record({ type: fc.constant('step' as const), by: fc.constantFrom(-1 as const, 1 as const) }),
      fc.record({ type: fc.constant('strength' as const), to: fc.constantFrom(0, 0.5, 1) }),
      fc.record({ type: fc.constant('delete' as const) }),
      fc.record({ type: fc.constant('undo' as const) }),
    );
    await fc.assert(
      fc.asyncProperty(fc.array(edit, { minLength: 1, maxLength: 6 }), async (edits) => {
        const { store, asked } = await page();
        await start(store);
        const first = [documentOf(store), danceOf(store)] as const;
        const steps = store.state.undoLabel.value;
        for (const each of edits) {
          const range = documentOf(store).ranges.at(-1);
          if (each.type === 'range') await store.regenerateRange({ start: each.at, end: each.at + each.long });
          else if (each.type === 'step' && range) await store.stepTake(each.by, range.id);
          else if (each.type === 'strength') store.commitStrength(each.to);
          else if (each.type === 'delete' && range) await store.deleteRange(range.id);
          else if (each.type === 'undo' && documentOf(store) !== first[0]) store.undo();
          await calm();
        }
        while (store.state.redoLabel.value) store.redo();
        await calm();
        const last = [documentOf(store), danceOf(store)] as const;
        same(last[1], await madeAtOnce(last[0]));
        asked();
        while (documentOf(store) !== first[0]) store.undo();
        await calm();
        expect(store.state.undoLabel.value).toBe(steps);
        same(danceOf(store), first[1]);
        while (store.state.redoLabel.value) store.redo();
        await calm();
        expect(documentOf(store)).toBe(last[0]);
        same(danceOf(store), last[1]);
        expect(asked()).toEqual([]);
      }),
      { numRuns: 5 },
    );
  }, 120_000);
});

describe('a comparison', () => {
  it('holds a dance as A, shows what is worked on as B, and loses neither', async () => {
    const { store } = await page();
    await start(store);
    const a = danceOf(store);
    const { state } = store;
    store.compare();
    expect(state.compare.value).toMatchObject({ shown: 'b' });
    await store.regenerateRange({ start: 4, end: 8 });
    const b = danceOf(store);
    store.compare();
    same(state.onStage.value!.motion, a);
    same(danceOf(store), b);
    expect(state.stale.value).toBe(false);
    store.compare();
    same(state.onStage.value!.motion, b);
    store.compare();
    // Work shows: an edit while A is on stage brings B back.
    await store.chooseTake('r1', null);
    expect(state.compare.value?.shown).toBe('b');
    await store.chooseTake('r1', 't1');
    store.compare();
    store.keepHeld();
    expect(state.compare.value).toBeNull();
    expect(documentOf(store).ranges).toEqual([]);
    same(danceOf(store), a);
    store.undo();
    same(danceOf(store), b);
    store.compare();
    store.leaveCompare();
    same(state.onStage.value!.motion, b);
  });
});

describe('the report of compared dances', () => {
  it('is that of the dance on stage, with its own key poses and beats', async () => {
    const { store } = await page();
    await start(store);
    const { state } = store;
    const reported = () => state.report.value?.consistencyPerKey.map(({ time }) => time);
    store.compare();
    const [first] = documentOf(store).keyPoses;
    store.selectKey(first.id);
    store.deleteKeys();
    await store.generate();
    await calm();
    expect(reported()).toEqual([6]);
    const b = state.report.value;
    store.compare();
    await calm();
    expect(reported()).toEqual([1, 6]);
    expect(documentOnStage(state).keyPoses).toHaveLength(2);
    // Beats that change meanwhile are those of B.
    store.nudgeBeats(1, 'frame');
    store.showCompared('a');
    await calm();
    expect(reported()).toEqual([1, 6]);
    // What the page's API tells is of the dance of now, whichever is on stage.
    expect(store.reportNow().consistencyPerKey).toHaveLength(1);
    store.undo();
    store.showCompared('b');
    await calm();
    expect(state.report.value).toEqual(b);
    store.compare();
    store.keepHeld();
    await calm();
    expect(reported()).toEqual([1, 6]);
  });
});

describe('the recipe of a dance', () => {
  it('clips ranges to the trim and lets one over everything take the place of what is below', async () => {
    const { store } = await page();
    const range = (start: number, end: number, seed: number) => ({
      id: `r${seed}`,
      start,
      end,
      takes: [{ id: 't1', seed, variation: 0.5 }],
      chosen: 't1',
    });
    const ranges = [range(0, 3, 2), range(1, 10, 3), range(9, 10, 4), { ...range(4, 6, 5), chosen: null }];
    const document: ProjectDocument = { ...documentOf(store), ranges, trim: { start: 2, end: 9 } };
    expect(recipeOf(document, 300)).toEqual({
      trim: { from: 60, to: 270 },
      base: { seed: 3, variation: 0.5 },
      ranges: [],
    });
    expect(recipeOf({ ...document, trim: null }, 300).ranges.map(({ from, to, seed }) => [from, to, seed])).toEqual([
      [0, 90, 2],
      [30, 300, 3],
      [270, 300, 4],
    ]);
  });
});

describe('the name of a range', () => {
  const beats = Array.from({ length: 20 }, (_, i) => i / 2 + 0.25);
  const grid = { tempo: 120, beatsPerBar: 4 as const, beats, downbeats: beats.filter((_, i) => i % 4 === 0) };
  it.each([
    [{ start: 2.25, end: 6.25 }, '2–3', 'bars 2–3'],
    [{ start: 0.25, end: 2.25 }, '1', 'bar 1'],
    [{ start: 6.25, end: 10 }, '4–5', 'bars 4–5'],
    [{ start: 2.75, end: 6.25 }, '0:02.7–0:06.2', '0:02.7–0:06.2'],
  ])('of %o is %s', (range, short, long) => {
    expect(shortRangeName(grid, range)).toBe(short);
    expect(rangeName(grid, range)).toBe(long);
  });
});
