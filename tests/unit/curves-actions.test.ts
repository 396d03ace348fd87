import { describe, expect, it, vi } from 'vitest';
import { Player } from '../../web/audio/player';
import { curvesOnStage, intervalInHand } from '../../web/app/actions/curves';
import { createStore } from '../../web/app/store';
import { rotationChannel, CHANNELS } from '../../web/core/curves';
import { generateCurves } from '../../web/core/curves-dance';
import { writeBvh } from '../../web/core/formats/bvh-write';
import { TIMBRE_SIZE } from '../../web/core/mfcc';
import { angleBetween } from '../../web/core/rotation';
import { seedMotion } from '../../web/core/seed';
import { jointIndex } from '../../web/core/skeleton';
import type { Motion } from '../../web/core/types';
import { stepClip, steadyGrid } from './dance';
import { fakeReporter, fakeServices, settled, type DanceRequest, type Services } from './support/app';
import { fakeIntervals } from './support/curves';
import { fourPoses } from '../e2e/support/page';

const elbow = jointIndex('left_elbow');
const poses = fourPoses();

/** Makes real curves, without a model. */
async function makeCurves(request: DanceRequest) {
  const timbre = new Float32Array(request.features.frames * TIMBRE_SIZE);
  const made = await generateCurves({ ...request, features: { ...request.features, timbre } }, fakeIntervals);
  return { ...made, backend: 'wasm' as const, model: 'curves', windows: 1, milliseconds: 1 };
}

async function dancing(change: (services: Services) => void = () => undefined) {
  const services = fakeServices(new Player(() => ({}) as AudioContext));
  const light = services.engine.generate;
  const load = vi.spyOn(services.engine, 'load');
  const made = vi.spyOn(services.engine, 'generate').mockImplementation((request, onPartial, signal) => {
    return request.engine === 'curves' ? makeCurves(request) : light(request, onPartial, signal);
  });
  change(services);
  const store = createStore(services, fakeReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  store.setKeyPoses([1, 1.5, 2].map((time, i) => ({ time, rotations: poses[i] })));
  return { store, services, load, made };
}

async function withCurves() {
  const all = await dancing();
  await all.store.generate({ engine: 'curves' });
  await settled();
  return all;
}

const turn = (motion: Motion, time: number, joint = elbow) => {
  const at = (Math.round(time * 30) * 24 + joint) * 4;
  return motion.quaternions.slice(at, at + 4);
};

describe('the engine', () => {
  it('is the project’s: asked for, kept, undone, and its model loaded only then', async () => {
    const { store, load, made } = await dancing();
    await store.generate();
    expect(store.state.document.value).not.toHaveProperty('engine');
    expect(load.mock.calls.every(([, , engine]) => engine === undefined)).toBe(true);
    expect(made.mock.lastCall![0].engine).toBeUndefined();
    await store.generate({ engine: 'curves' });
    expect(store.state.document.value.engine).toBe('curves');
    expect(load.mock.lastCall![2]).toBe('curves');
    expect(store.state.dance.value?.curves).toBeDefined();
    expect(store.state.stale.value).toBe(false);
    // The other engine's dance is kept: it comes back with undo, without the network.
    const calls = made.mock.calls.length;
    store.undo();
    await settled();
    expect(store.state.document.value).not.toHaveProperty('engine');
    expect(store.state.dance.value?.curves).toBeUndefined();
    expect(store.state.stale.value).toBe(false);
    store.redo();
    await settled();
    expect(store.state.dance.value?.curves).toBeDefined();
    expect(made.mock.calls).toHaveLength(calls);
  });

  it('follows no key strength: the curves run through every key pose', async () => {
    const { store } = await withCurves();
    const before = store.state.dance.value!.motion;
    store.commitStrength(0.3);
    await settled();
    expect(store.state.dance.value!.motion).toBe(before);
    expect(store.state.stale.value).toBe(false);
    for (const [i, time] of [1, 1.5, 2].entries()) {
      const { shown } = curvesOnStage(store.state)!;
      const k = shown.anchors.indexOf(store.state.document.value.keyPoses[i].id);
      expect(shown.times[k]).toBe(time);
    }
  });

  it('asks for ranges with takes of their own in the same go', async () => {
    const { store, made } = await withCurves();
    await store.regenerateRange({ start: 4, end: 7 });
    expect(made.mock.lastCall![0].takes).toMatchObject([{ from: 120, to: 210 }]);
    expect(made.mock.lastCall![0].range).toBeUndefined();
    expect(store.state.stale.value).toBe(false);
    await store.generate({ range: { start: 8, end: 9 }, seed: 9 });
    expect(made.mock.lastCall![0].takes).toMatchObject([{ from: 120 }, { from: 240, to: 270, seed: 9 }]);
  });
});

describe('comparing the engines', () => {
  it('puts the dance of the other engine beside the one at hand, through the same key poses, and ends cleanly', async () => {
    const { store } = await withCurves();
    const { dance, compare, document } = store.state;
    const curved = dance.value!;
    await store.compareEngines();
    await settled();
    expect(compare.value).toMatchObject({ beside: true, shown: 'b' });
    expect(compare.value!.dance.curves).toBe(curved.curves);
    expect(compare.value!.report).not.toBeNull();
    expect(dance.value!.curves).toBeUndefined();
    expect(dance.value!.inputs!.keyPoses).toEqual(curved.inputs!.keyPoses);
    expect(document.value).not.toHaveProperty('engine');
    store.showCompared('a');
    expect(compare.value).toMatchObject({ beside: false, shown: 'a' });
    store.toggleBeside();
    expect(compare.value).toMatchObject({ beside: true, shown: 'b' });
    store.keepHeld();
    await settled();
    expect(compare.value).toBeNull();
    expect(document.value.engine).toBe('curves');
    expect(dance.value!.curves).toBe(curved.curves);
  });
});

describe('a change of a curve', () => {
  /** The interval that begins at the first key pose. */
  const first = (store: Awaited<ReturnType<typeof withCurves>>['store']) =>
    store.state.dance.value!.curves!.anchors.indexOf(store.state.document.value.keyPoses[0].id);

  it('moves the figure while it is dragged, and is one step of undo', async () => {
    const { store } = await withCurves();
    const before = store.state.dance.value!.motion;
    const interval = first(store);
    store.beginCurveDrag();
    for (const angle of [0.2, 0.4]) {
      store.previewCurve(interval, elbow, {
        knots: [
          [0, 0, angle],
          [0, 0, 0],
        ],
      });
    }
    const live = store.state.dance.value!.motion;
    const knot = 1 + 1 / 6;
    expect(angleBetween(turn(before, knot), turn(live, knot))).toBeCloseTo(0.4, 4);
    store.commitCurveDrag();
    expect(store.state.undoLabel.value).toBe('Edit curve');
    expect(store.state.document.value.curveEdits).toHaveLength(1);
    expect(store.state.stale.value).toBe(false);
    store.undo();
    expect(store.state.document.value).not.toHaveProperty('curveEdits');
    expect(angleBetween(turn(store.state.dance.value!.motion, knot), turn(before, knot))).toBeLessThan(1e-4);
    store.redo();
    expect(angleBetween(turn(store.state.dance.value!.motion, knot), turn(live, knot))).toBeLessThan(1e-4);
    // What the drag did not touch is the very same.
    for (const time of [1, 1.5, 5]) expect(turn(live, time)).toEqual(turn(before, time));
    expect(turn(live, knot, 3)).toEqual(turn(before, knot, 3));
  });

  it('never happened when its drag is cancelled', async () => {
    const { store } = await withCurves();
    const [document, before] = [store.state.document.value, store.state.dance.value!.motion];
    store.beginCurveDrag();
    store.previewCurve(first(store), jointIndex('left_shoulder'), { tension: 1 });
    expect(store.state.dance.value!.motion.quaternions).not.toEqual(before.quaternions);
    store.discardCurveDrag();
    expect(store.state.document.value).toBe(document);
    expect(store.state.dance.value!.motion.quaternions).toEqual(before.quaternions);
    store.previewCurve(0, elbow, { tension: 1 });
    expect(store.state.document.value).toBe(document);
  });

  it('sets tension, and goes back to what was generated', async () => {
    const { store } = await withCurves();
    const interval = first(store);
    store.changeCurve(interval, elbow, { tension: 0.7 });
    store.changeCurve(interval, elbow, { bias: -0.2 });
    expect(store.state.document.value.curveEdits).toEqual([
      { from: expect.any(String), to: expect.any(String), track: 'left_elbow', tension: 0.7, bias: -0.2 },
    ]);
    const { shown, base } = curvesOnStage(store.state)!;
    const at = interval * 3 * CHANNELS + rotationChannel(elbow);
    expect(shown.shape[at]).toBeCloseTo(0.7, 6);
    expect(base.shape[at]).toBe(0);
    store.resetCurve(elbow, interval);
    expect(store.state.document.value).not.toHaveProperty('curveEdits');
  });

  it('stays on its beats when the grid is moved, on fillers and on key poses', async () => {
    const { store } = await withCurves();
    const { anchors } = store.state.dance.value!.curves!;
    const filler = anchors.findIndex((anchor, k) => typeof anchor === 'number' && anchor > 6 && k + 1 < anchors.length);
    store.changeCurve(filler, elbow, { tension: 1 });
    store.changeCurve(first(store), elbow, { tension: 1 });
    const edits = store.state.document.value.curveEdits!;
    for (const ripple of [true, false]) {
      store.toggleRipple(ripple);
      store.nudgeBeats(1, 'frame');
      expect(store.state.document.value.curveEdits).toEqual(edits);
    }
    await store.generate();
    const { shown, base } = curvesOnStage(store.state)!;
    const changed = shown.shape.reduce((count, value, i) => count + (value === base.shape[i] ? 0 : 1), 0);
    expect(changed).toBe(8);
  });

  it('goes with its key pose', async () => {
    const { store } = await withCurves();
    store.changeCurve(first(store), elbow, { tension: 1 });
    store.deleteKeys(new Set([store.state.document.value.keyPoses[1].id]));
    expect(store.state.document.value).not.toHaveProperty('curveEdits');
    store.undo();
    expect(store.state.document.value.curveEdits).toHaveLength(1);
  });

  it('never passes to another key pose, whatever takes its place; what stays keeps it', async () => {
    const { store } = await withCurves();
    const edited = () => store.state.document.value.curveEdits ?? [];
    const anchors = () => store.state.dance.value!.curves!.anchors;
    const keys = () => store.state.document.value.keyPoses;
    store.changeCurve(first(store), elbow, { tension: 1 });
    const kept = edited();
    // The first two are what they were, the third is another.
    store.setKeyPoses([1, 1.5, 2].map((time, i) => ({ time, rotations: poses[i === 2 ? 3 : i] })));
    expect(edited()).toEqual(kept);
    // Other poses at other times in their places.
    store.setKeyPoses([1.2, 1.7, 2.2].map((time, i) => ({ time, rotations: poses[3 - i] })));
    expect(edited()).toEqual([]);
    store.undo();
    expect(edited()).toEqual(kept);
    // Even while the curves of a pose that is gone are on stage still.
    store.deleteKeys(new Set(keys().map(({ id }) => id)));
    store.addKey(poses[3], 4, { exact: true });
    const { motion } = store.state.dance.value!;
    store.changeCurve(1, elbow, { tension: 0.5 });
    expect(edited()).toEqual([]);
    expect(store.state.dance.value!.motion).toBe(motion);
    expect(store.state.notices.value.at(-1)?.text).toMatch(/is gone/);
    expect(anchors()).not.toContain(keys()[0].id);
  });

  it.each(['pasted', 'duplicated', 'copied by a drag'])('never passes to a key pose that is %s', async (way) => {
    const { store } = await withCurves();
    const keys = () => store.state.document.value.keyPoses;
    const { anchors } = store.state.dance.value!.curves!;
    // The last one is gone, but the dance on stage still runs through it.
    store.deleteKeys(new Set([keys()[2].id]));
    store.selectKey(keys()[0].id);
    if (way === 'pasted') {
      store.copyKeys();
      store.seek(4);
      store.pasteKeys(true);
    } else if (way === 'duplicated') store.duplicateKeys();
    else {
      store.beginMove();
      store.previewMove(2, keys()[0].id, true, true);
      store.commitMove();
    }
    expect(keys()).toHaveLength(3);
    const copy = keys().find(({ id }) => store.state.selection.value.has(id))!;
    expect(anchors).not.toContain(copy.id);
  });

  it('never passes to a key pose out of an animation file', async () => {
    const { store } = await withCurves();
    const { keyPoses } = store.state.document.value;
    const { anchors } = store.state.dance.value!.curves!;
    // The last ones are gone, but the dance on stage still runs through them.
    store.deleteKeys(new Set(keyPoses.slice(1).map(({ id }) => id)));
    const steps = seedMotion(stepClip(), steadyGrid(10, 120, 0), 240);
    await store.importPoseFile(new File([writeBvh(steps, { units: 'm' })], 'steps.bvh'));
    store.useFileAsDance('beat');
    const placed = [...store.state.selection.value];
    expect(placed.length).toBeGreaterThan(3);
    for (const id of placed) expect(anchors).not.toContain(id);
  });

  it('goes with a key pose that another is dragged onto, but stays while the drag only passes over it', async () => {
    const { store } = await withCurves();
    const keys = () => store.state.document.value.keyPoses;
    store.changeCurve(first(store), elbow, { tension: 1 });
    const last = keys()[2].id;
    const [gone] = [keys()[1].id];
    store.selectKey(last);
    store.beginMove();
    store.previewMove(-0.5, last, true);
    expect(keys().map(({ id }) => id)).not.toContain(gone);
    store.previewMove(0.5, last, true);
    expect(store.state.document.value.curveEdits).toHaveLength(1);
    store.previewMove(-0.5, last, true);
    store.commitMove();
    expect(store.state.document.value).not.toHaveProperty('curveEdits');
    store.undo();
    expect(store.state.document.value.curveEdits).toHaveLength(1);
  });

  it('goes with suggestions that give way to others', async () => {
    const { store, services } = await withCurves();
    services.suggester = {
      load: async () => undefined,
      alternates: async () => [],
      suggest: async (_, { onPoses }) => {
        onPoses?.(
          [1, 1.5, 2].map((time, i) => ({ time, rotations: poses[3 - i] })),
          1,
        );
        return { backend: 'wasm', model: 'suggest', steps: 3, milliseconds: 1 };
      },
    };
    store.setKeyPoses([1, 1.5, 2].map((time, i) => ({ time, rotations: poses[i], suggested: true })));
    await store.generate();
    store.changeCurve(first(store), elbow, { tension: 1 });
    const before = store.state.document.value;
    expect(before.curveEdits).toHaveLength(1);
    await store.suggestKeyPoses();
    expect(store.state.document.value).not.toHaveProperty('curveEdits');
    const ids = store.state.document.value.keyPoses.map(({ id }) => id);
    expect(before.keyPoses.filter(({ id }) => ids.includes(id))).toEqual([]);
    store.undo();
    expect(store.state.document.value).toEqual(before);
  });

  it('is in a dance that is made anew, and in the one that is kept for the next visit', async () => {
    const saved: { curves?: unknown; curveEdits?: readonly unknown[]; motion: Motion }[] = [];
    const { store, services } = await withCurves();
    services.storage.saveDance = async (dance) => void saved.push(dance);
    store.changeCurve(first(store), elbow, { tension: 1 });
    const { motion } = store.state.dance.value!;
    expect(saved.at(-1)!.curveEdits).toHaveLength(1);
    expect(saved.at(-1)!.motion).toBe(motion);
    await store.generate();
    await settled();
    expect(store.state.dance.value!.motion.quaternions).toEqual(motion.quaternions);
    expect(saved.at(-1)!.curves).toBeDefined();
  });
});

describe('the interval in hand', () => {
  it('is the one at the playhead', async () => {
    const { store } = await withCurves();
    const { times } = store.state.dance.value!.curves!;
    store.seek(2.5);
    const here = intervalInHand(store.state);
    expect(times[here]).toBeLessThanOrEqual(2.5);
    expect(times[here + 1]).toBeGreaterThan(2.5);
    store.stepCurveInterval(1);
    expect(intervalInHand(store.state)).toBe(here + 1);
    expect(store.state.time.value).toBeCloseTo((times[here + 1] + times[here + 2]) / 2, 6);
    store.seek(0);
    store.stepCurveInterval(-1);
    expect(intervalInHand(store.state)).toBe(0);
    expect(intervalInHand(store.state, 999)).toBe(times.length - 2);
  });
});
