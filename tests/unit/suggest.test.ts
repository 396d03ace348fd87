import { describe, expect, it } from 'vitest';
import { checkKeyPoses, createDocument } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';
import { setStrength, settleKeys, shiftKeys, toggleLock, editKeys } from '../../web/core/key-ops';
import { withinLimits } from '../../web/core/joint-limits';
import { angleBetween, axisAngleToQuaternion, poseToQuaternions, quaternionsToSixD } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import { spec } from '../../web/core/spec';
import { TIMBRE_SIZE } from '../../web/core/mfcc';
import {
  ALTERNATES,
  alternatePoses,
  keysThatStay,
  suggestionBeats,
  suggestPoses,
  type StepRunner,
  type SuggestRequest,
} from '../../web/core/suggest';
import { FASTEST_TURN, FORBIDDEN, MOST_TRIES, VISIBLE_DISTANCE } from '../../web/core/suggest-moving';
import { poseDistance, ROW_SIZE } from '../../web/core/suggest-pose';
import { temperatureOf, type StepInputs } from '../../web/core/suggest-step';
import type { BeatGrid, Features, KeyPose } from '../../web/core/types';

const SECONDS = 20;
const frames = SECONDS * 30;
const features: Features = {
  fps: 30,
  names: spec.features.names,
  frames,
  data: new Float32Array(frames * 15),
  timbre: Float32Array.from({ length: frames * TIMBRE_SIZE }, (_, i) => Math.sin(i * 12.9898)),
};
/** Half-second beats from 0; a pick-up beat before the first bar line at 0.5 s. */
const beats = Array.from({ length: 39 }, (_, i) => i / 2);
const grid: BeatGrid = { tempo: 120, beatsPerBar: 4, beats, downbeats: beats.filter((_, i) => i % 4 === 1) };
const whole = { start: 0, end: SECONDS };
const REST = new Array<number>(72).fill(0);
const pose = (turn: number, joint = 'left_shoulder') => {
  const rotations = [...REST];
  rotations[jointIndex(joint) * 3 + 2] = turn;
  return rotations;
};
const key = (id: string, time: number, more: Partial<KeyPose> = {}): KeyPose => ({
  id,
  time,
  rotations: pose(0.3),
  ...more,
});
const request = (more: Partial<SuggestRequest> = {}): SuggestRequest => ({
  features,
  grid,
  keyPoses: [],
  density: 'beat',
  range: whole,
  variation: 0.5,
  seed: 7,
  ...more,
});
const times = (list: number[]) => list.map((k) => beats[k]);

/** A network that raises the left arm by the code that the noise names; steps come one beat after the other. */
function fakeNetwork(steps: StepInputs[] = [], angle = (code: number) => -1.2 + code / 300): StepRunner {
  return async (inputs) => {
    steps.push(inputs);
    const batch = inputs.noise.dims[0];
    const poses = new Float32Array(batch * ROW_SIZE);
    const codes = new Float32Array(batch);
    for (let i = 0; i < batch; i++) {
      const noise = inputs.noise.data.subarray(i * 512, (i + 1) * 512);
      codes[i] = noise.indexOf(Math.max(...noise));
      poses.set(quaternionsToSixD(poseToQuaternions(pose(angle(codes[i])))), i * ROW_SIZE);
      poses[(i + 1) * ROW_SIZE - 2] = 0.9;
    }
    return { poses, codes };
  };
}

/** A network with codes for two parts: legs bow by the first half's code, the arm is raised by the second half's. */
function partsNetwork(steps: StepInputs[] = [], bow = (code: number) => code / 300): StepRunner {
  return async (inputs) => {
    steps.push(inputs);
    const batch = inputs.noise.dims[0];
    const poses = new Float32Array(batch * ROW_SIZE);
    const codes = new Float32Array(batch * 2);
    for (let i = 0; i < batch; i++) {
      for (const part of [0, 1]) {
        const noise = inputs.noise.data.subarray(i * 512 + part * 256, i * 512 + (part + 1) * 256);
        codes[i * 2 + part] = part * 256 + noise.indexOf(Math.max(...noise));
      }
      const both = pose(bow(codes[i * 2 + 1]));
      both[3] = bow(codes[i * 2]);
      poses.set(quaternionsToSixD(poseToQuaternions(both)), i * ROW_SIZE);
      poses[(i + 1) * ROW_SIZE - 2] = 0.9;
    }
    return { poses, codes };
  };
}

/** The same on a figure that leans another way on each of three beats, so that no pose stands still. */
function leaningNetwork(steps: StepInputs[] = [], angle?: (code: number) => number): StepRunner {
  const network = fakeNetwork(steps, angle);
  const leans = [0, 1, 2].map((lean) => quaternionsToSixD(poseToQuaternions(pose(lean, 'pelvis'))).subarray(0, 6));
  return async (inputs) => {
    const found = await network(inputs);
    const newest = inputs.poses.data.subarray(15 * ROW_SIZE, 15 * ROW_SIZE + 6);
    const before = leans.findIndex((lean) => lean.every((v, i) => Math.abs(v - newest[i]) < 1e-3));
    found.poses.set(leans[(before + 1) % 3]);
    return found;
  };
}

describe('the beats that get a pose', () => {
  it('are all, two in a bar, or the first of each bar', () => {
    expect(suggestionBeats(request())).toHaveLength(39);
    expect(times(suggestionBeats(request({ density: 'bar' })))).toEqual([
      0.5, 2.5, 4.5, 6.5, 8.5, 10.5, 12.5, 14.5, 16.5, 18.5,
    ]);
    expect(times(suggestionBeats(request({ density: 'half', range: { start: 0, end: 4 } })))).toEqual([
      0.5, 1.5, 2.5, 3.5,
    ]);
    const waltz: BeatGrid = { tempo: 120, beatsPerBar: 3, beats: beats.slice(0, 6), downbeats: [0, 1.5] };
    expect(times(suggestionBeats(request({ grid: waltz, density: 'half' })))).toEqual([0, 1, 1.5, 2.5]);
    expect(suggestionBeats(request({ grid: { ...grid, downbeats: [] }, density: 'bar' }))[1]).toBe(4);
  });

  it('keep clear of what stays, and only of that', () => {
    const keyPoses = [
      key('own', 2.1),
      key('old', 4, { suggested: true }),
      key('held', 6, { suggested: true, locked: true }),
    ];
    const found = times(suggestionBeats(request({ keyPoses })));
    expect(found).not.toContain(2);
    expect(found).toContain(2.5);
    expect(found).toContain(4);
    expect(found).not.toContain(6);
    // A suggestion outside the stretch stays too.
    const range = { start: 4.5, end: 8 };
    expect(keysThatStay(keyPoses, range).map(({ id }) => id)).toEqual(['own', 'old', 'held']);
    expect(times(suggestionBeats(request({ keyPoses, range })))[0]).toBe(4.5);
  });

  it('lie between own key poses where only gaps are asked for', () => {
    const keyPoses = [key('a', 3), key('b', 5), key('s', 9, { suggested: true })];
    expect(times(suggestionBeats(request({ keyPoses, gaps: true })))).toEqual([3.5, 4, 4.5]);
    expect(suggestionBeats(request({ keyPoses: [key('a', 3)], gaps: true }))).toEqual([]);
  });
});

describe('the variation dial', () => {
  it('is the temperature of the network: calm, as it was trained, bold', () => {
    for (const [variation, temperature] of [
      [0, 0.7],
      [0.5, 1],
      [1, 1.3],
      [-1, 0.7],
      [2, 1.3],
    ])
      expect(temperatureOf(variation)).toBeCloseTo(temperature, 12);
  });
});

describe('suggesting', () => {
  it('walks the beats one by one: each step has the poses before it and the music around it', async () => {
    const steps: StepInputs[] = [];
    const parts: number[] = [];
    const found = await suggestPoses(request({ range: { start: 0, end: 9 } }), leaningNetwork(steps), {
      onPose: ({ time }, fraction) => parts.push(time, fraction),
    });
    expect(found.map(({ time }) => time)).toEqual(beats.slice(0, 19));
    expect(parts.slice(-2)).toEqual([9, 1]);
    expect(steps).toHaveLength(19);
    const sum = (list: Float32Array) => list.reduce((a, b) => a + b, 0);
    expect(steps.map(({ pose_mask }) => sum(pose_mask.data))).toEqual([
      ...Array.from({ length: 16 }, (_, i) => i),
      16,
      16,
      16,
    ]);
    // Oldest first: the newest stands in the last row, and is the pose found one beat before.
    const newest = Array.from(steps[5].poses.data.subarray(15 * ROW_SIZE, 15 * ROW_SIZE + 144));
    quaternionsToSixD(poseToQuaternions(found[4].rotations)).forEach((v, i) => expect(newest[i]).toBeCloseTo(v, 5));
    expect(steps[5].pose_mask.data[10]).toBe(0);
    expect(steps[5].pose_mask.data[11]).toBe(1);
    // Beats k-20..k+6 of those that there are.
    expect(Array.from(steps[0].music_mask.data)).toEqual([...new Array(20).fill(0), ...new Array(7).fill(1)]);
    expect(steps[0].music.dims).toEqual([1, 27, 57]);
    expect(steps[2].music.data.subarray(18 * 57, 19 * 57)).toEqual(steps[1].music.data.subarray(19 * 57, 20 * 57));
    expect(steps[0].next_beats.data[0]).toBe(-1);
    expect(steps[0].temperature.data[0]).toBeCloseTo(1, 6);
  });

  it('leads to own key poses and goes on from them', async () => {
    const steps: StepInputs[] = [];
    const own = key('own', 5.1, { rotations: pose(1.5, 'pelvis') });
    const found = await suggestPoses(request({ keyPoses: [own], range: { start: 0, end: 8 } }), leaningNetwork(steps));
    expect(found.map(({ time }) => time)).not.toContain(5);
    expect(found).toHaveLength(16);
    expect(steps[0].next_beats.data[0]).toBeCloseTo(10.2, 6);
    expect(steps[9].next_beats.data[0]).toBeCloseTo(1.2, 5);
    expect(steps[11].next_beats.data[0]).toBe(-1);
    const wanted = quaternionsToSixD(poseToQuaternions(own.rotations));
    expect(Array.from(steps[3].next_pose.data)).toEqual(Array.from(wanted));
    // The step after it has it for its newest pose, with the root of the network.
    expect(Array.from(steps[11].poses.data.subarray(15 * ROW_SIZE, 15 * ROW_SIZE + 144))).toEqual(Array.from(wanted));
    expect(steps[11].poses.data[16 * ROW_SIZE - 2]).toBeCloseTo(0.9, 6);
  });

  it('does not look at a key pose that is too far ahead', async () => {
    const steps: StepInputs[] = [];
    await suggestPoses(request({ keyPoses: [key('own', 10)], range: { start: 0, end: 3 } }), leaningNetwork(steps));
    expect(steps[3].next_beats.data[0]).toBe(-1);
    expect(steps[4].next_beats.data[0]).toBe(16);
  });

  it('warms up before a stretch in the middle, and gives poses only inside', async () => {
    const steps: StepInputs[] = [];
    const range = { start: 10, end: 12 };
    const found = await suggestPoses(request({ range, density: 'bar' }), leaningNetwork(steps));
    expect(found.map(({ time }) => time)).toEqual([10.5]);
    expect(steps).toHaveLength(17);
    expect(steps[16].pose_mask.data.every((v) => v === 1)).toBe(true);
  });

  it('gives the same poses for the same seed, whatever the density where none stands still; others for another', async () => {
    const make = (more: Partial<SuggestRequest>) => suggestPoses(request(more), leaningNetwork());
    const every = await make({});
    expect(await make({})).toEqual(every);
    const bars = await make({ density: 'bar' });
    expect(bars.every((found) => every.some((each) => JSON.stringify(each) === JSON.stringify(found)))).toBe(true);
    const other = await make({ seed: 8 });
    expect(other.filter((found, i) => JSON.stringify(found) !== JSON.stringify(every[i])).length).toBeGreaterThan(30);
  });

  it('holds the limits of the joints', async () => {
    const found = await suggestPoses(
      request({ range: { start: 0, end: 2 } }),
      leaningNetwork([], () => 3),
    );
    const shoulder = jointIndex('left_shoulder');
    expect(withinLimits(shoulder, axisAngleToQuaternion(pose(3).slice(shoulder * 3, shoulder * 3 + 3)))).toBe(false);
    for (const { rotations } of found)
      for (let joint = 1; joint < 24; joint++)
        expect(withinLimits(joint, axisAngleToQuaternion(rotations.slice(joint * 3, joint * 3 + 3)))).toBe(true);
  });

  it('holds a root that runs away', async () => {
    const steps: StepInputs[] = [];
    const network = leaningNetwork(steps);
    const runaway: StepRunner = async (inputs) => {
      const found = await network(inputs);
      const before = inputs.poses.data.subarray(16 * ROW_SIZE - 3);
      found.poses.set([before[0] * 10 + 9, -5, before[2]], ROW_SIZE - 3);
      return found;
    };
    await suggestPoses(request({ range: { start: 0, end: 3 } }), runaway);
    const roots = steps.map(({ poses }) => Array.from(poses.data.subarray(16 * ROW_SIZE - 3)));
    expect(roots[1].map((v) => Math.round(v * 1e6) / 1e6)).toEqual([2, 0.1, 0]);
    expect(roots[6][0]).toBeCloseTo(12, 4);
  });

  it('stops when it is told to, and says why there is nothing to do', async () => {
    const controller = new AbortController();
    const stopped = suggestPoses(request(), leaningNetwork(), {
      onPose: ({ time }) => time === 3 && controller.abort(),
      signal: controller.signal,
    });
    await expect(stopped).rejects.toThrow(/abort/i);
    const attempt = (more: Partial<SuggestRequest>) => suggestPoses(request(more), leaningNetwork());
    await expect(attempt({ grid: { ...grid, beats: [], downbeats: [] } })).rejects.toThrow(/tap the tempo/);
    await expect(attempt({ gaps: true })).rejects.toThrow(/at least two key poses/);
    await expect(attempt({ range: { start: 3.1, end: 3.2 } })).rejects.toThrow(/another stretch/);
    await expect(attempt({ style: 'foxtrot' })).rejects.toThrow(/no style "foxtrot"/);
  });
});

describe('a dance that would stand still', () => {
  /** One pose for most codes; those over 400 have the figure turned. */
  const sleepy = (steps: StepInputs[] = [], awake = 400): StepRunner => {
    const network = fakeNetwork(steps, () => 0);
    return async (inputs) => {
      const found = await network(inputs);
      const turned = quaternionsToSixD(poseToQuaternions(pose(found.codes[0] / 100, 'pelvis')));
      if (found.codes[0] > awake) found.poses.set(turned.subarray(0, 6));
      return found;
    };
  };
  const ways = (list: readonly { rotations: readonly number[] }[]) =>
    list.slice(1).map(({ rotations }, i) => poseDistance(rotations, list[i].rotations));

  it('steps again with the code ruled out, and gives the same poses each time', async () => {
    const steps: StepInputs[] = [];
    const wanted = request({ density: 'half' });
    const found = await suggestPoses(wanted, sleepy(steps, 250));
    expect(found).toHaveLength(19);
    expect(Math.min(...ways(found))).toBeGreaterThanOrEqual(VISIBLE_DISTANCE);
    expect(steps.length).toBeGreaterThan(39);
    expect(steps.length).toBeLessThan(39 + 19 * (MOST_TRIES - 1));
    const again = steps.find(({ noise }) => noise.data.includes(FORBIDDEN))!;
    const before = steps[steps.indexOf(again) - 1];
    // The same step, but for the code that was taken and a little boldness.
    expect(again.poses.data).toEqual(before.poses.data);
    expect(again.noise.data.filter((v, i) => v !== before.noise.data[i])).toEqual(Float32Array.of(FORBIDDEN));
    expect(again.temperature.data[0]).toBeGreaterThan(before.temperature.data[0]);
    expect(await suggestPoses(wanted, sleepy([], 250))).toEqual(found);
  });

  it('rules out the codes of every part of the body', async () => {
    const steps: StepInputs[] = [];
    await suggestPoses(
      request({ density: 'half' }),
      partsNetwork(steps, () => 0),
    );
    const again = steps.find(({ noise }) => noise.data.includes(FORBIDDEN))!;
    const places = Array.from(again.noise.data).flatMap((v, i) => (v === FORBIDDEN ? [i] : []));
    expect(places).toHaveLength(2);
    expect(places[0]).toBeLessThan(256);
    expect(places[1]).toBeGreaterThanOrEqual(256);
  });

  it('asks less of poses that are close in time', async () => {
    const quick: BeatGrid = { ...grid, beats: beats.map((time) => time / 2), downbeats: [] };
    const slight = (steps: StepInputs[]): StepRunner => {
      const network = fakeNetwork(steps, () => 0);
      let count = 0;
      // Less than 3 cm from beat to beat.
      return async (inputs) => {
        const found = await network(inputs);
        const lean = pose(0.05 * count++, 'pelvis');
        found.poses.set(quaternionsToSixD(poseToQuaternions(lean)).subarray(0, 6));
        return found;
      };
    };
    const steps: StepInputs[] = [];
    const found = await suggestPoses(request({ grid: quick }), slight(steps));
    expect(Math.max(...ways(found))).toBeLessThan(VISIBLE_DISTANCE / 2);
    expect(steps).toHaveLength(39);
  });

  it('does not repeat the own key pose before it, nor the one right after it', async () => {
    const own = [key('a', 2, { rotations: REST }), key('b', 4, { rotations: REST })];
    const at = { keyPoses: own, density: 'half' as const, gaps: true, grid: { ...grid, downbeats: [1, 3] } };
    const found = await suggestPoses(request(at), sleepy([], 250));
    expect(found.map(({ time }) => time)).toEqual([3]);
    expect(poseDistance(found[0].rotations, REST)).toBeGreaterThanOrEqual(VISIBLE_DISTANCE);
  });

  it('does not sway to and fro over a few centimetres for long', async () => {
    const arms = (pelvis: number) => quaternionsToSixD(poseToQuaternions(pose(pelvis, 'pelvis'))).subarray(0, 6);
    // 5 cm to one side and back, beat by beat: each of them looks like a move. Codes over 250 bow.
    const swaying: StepRunner = async (inputs) => {
      const found = await fakeNetwork([], () => 0)(inputs);
      const newest = inputs.poses.data.subarray(15 * ROW_SIZE, 15 * ROW_SIZE + 6);
      const upright = Math.abs(newest[1]) < 0.05;
      found.poses.set(arms(found.codes[0] > 250 ? found.codes[0] / 300 : upright ? 0.1 : 0));
      return found;
    };
    const found = await suggestPoses(request({ variation: 0 }), swaying);
    expect(found).toHaveLength(39);
    for (let i = 2; i < found.length; i++) {
      const before = found.slice(i - 2, i).map(({ rotations }) => poseDistance(rotations, found[i].rotations));
      expect(Math.max(...before), `at ${found[i].time} s`).toBeGreaterThanOrEqual(VISIBLE_DISTANCE);
    }
  });

  it('asks more of poses that are a bar apart', async () => {
    // Arms up or down by a little; the farthest codes lift them high.
    const found = await suggestPoses(
      request({ density: 'bar' }),
      fakeNetwork([], (code) => (code > 300 ? code / 200 : code / 2000)),
    );
    const least = 1.5 * VISIBLE_DISTANCE;
    expect(Math.min(...ways(found))).toBeGreaterThan(least);
  });

  it('takes the pose that moves most where none moves enough, after a few tries', async () => {
    const steps: StepInputs[] = [];
    const found = await suggestPoses(
      request({ range: { start: 0, end: 1 } }),
      fakeNetwork(steps, (code) => code / 2000),
    );
    expect(found).toHaveLength(3);
    expect(steps).toHaveLength(1 + 2 * MOST_TRIES);
    const tried = steps.slice(1, 1 + MOST_TRIES).map(({ noise }) => noise.data.indexOf(Math.max(...noise.data)) / 2000);
    const first = steps[0].noise.data.indexOf(Math.max(...steps[0].noise.data)) / 2000;
    const best = Math.max(...tried.map((angle) => Math.abs(angle - first)));
    const arm = jointIndex('left_shoulder') * 3 + 2;
    expect(Math.abs(found[1].rotations[arm] - found[0].rotations[arm])).toBeCloseTo(best, 3);
  });
});

describe('a dance that would whirl round', () => {
  /** Faces the other way on every beat; codes over `calm` bow instead. */
  const whirling = (calm = 300): StepRunner => {
    const network = fakeNetwork([], () => 0);
    return async (inputs) => {
      const found = await network(inputs);
      const batch = inputs.noise.dims[0];
      const newest = inputs.poses.data.subarray(15 * ROW_SIZE, 15 * ROW_SIZE + 6);
      for (let i = 0; i < batch; i++) {
        const way = newest[0] > 0 ? 3 : 0;
        const turned = found.codes[i] > calm ? pose(found.codes[i] / 300, 'pelvis') : [0, way, 0, ...REST.slice(3)];
        found.poses.set(quaternionsToSixD(poseToQuaternions(turned)).subarray(0, 6), i * ROW_SIZE);
      }
      return found;
    };
  };
  const turn = (a: readonly number[], b: readonly number[]) =>
    angleBetween(axisAngleToQuaternion(a.slice(0, 3)), axisAngleToQuaternion(b.slice(0, 3)));

  it('turns no faster than a body can', async () => {
    const found = await suggestPoses(request(), whirling());
    expect(found).toHaveLength(39);
    for (let i = 1; i < found.length; i++)
      expect(turn(found[i].rotations, found[i - 1].rotations), `at ${found[i].time} s`).toBeLessThanOrEqual(
        FASTEST_TURN * 0.5 + 1e-3,
      );
    // There is time for it from bar to bar.
    const bars = await suggestPoses(request({ density: 'half' }), whirling(512));
    expect(turn(bars[1].rotations, bars[0].rotations)).toBeLessThan(0.01);
  });

  it('has alternates that turn no faster, where there are some', async () => {
    const at = key('s', 6, { suggested: true, rotations: pose(0) });
    const before = key('b', 5.5, { suggested: true, rotations: pose(0) });
    const others = await alternatePoses(request({ keyPoses: [before, at] }), at, whirling());
    expect(others).toHaveLength(ALTERNATES);
    for (const other of others) expect(turn(other, before.rotations)).toBeLessThanOrEqual(FASTEST_TURN * 0.5 + 1e-3);
    expect(await alternatePoses(request({ keyPoses: [before, at] }), at, whirling(512))).toHaveLength(ALTERNATES);
  });
});

describe('alternates', () => {
  const at = key('s', 6, { suggested: true, rotations: pose(0) });

  it('differ visibly from the pose and from each other, and are the same each time', async () => {
    const make = () => alternatePoses(request({ keyPoses: [at] }), at, fakeNetwork());
    const found = await make();
    expect(found).toHaveLength(ALTERNATES);
    const all = [at.rotations, ...found.slice(0, 3)];
    for (let i = 0; i < all.length; i++)
      for (let j = 0; j < i; j++) expect(poseDistance(all[i], all[j])).toBeGreaterThan(0.02);
    expect(await make()).toEqual(found);
  });

  it('forbids codes that are taken and asks again where poses look alike', async () => {
    const steps: StepInputs[] = [];
    // All codes but those over 500 give one and the same pose.
    const found = await alternatePoses(
      request({ keyPoses: [at] }),
      at,
      fakeNetwork(steps, (code) => (code > 500 ? 1 : 0.01)),
    );
    const batches = steps.filter(({ noise }) => noise.dims[0] > 1);
    expect(batches).toHaveLength(3);
    const forbidden = batches[2].noise.data.subarray(0, 512).filter((v) => v < -1e8).length;
    expect(forbidden).toBeGreaterThan(12);
    expect(found.length).toBe(ALTERNATES);
    expect(VISIBLE_DISTANCE).toBeGreaterThan(0);
  });

  it('forbids the codes of every part, and takes one for taken only where both are', async () => {
    const steps: StepInputs[] = [];
    const found = await alternatePoses(
      request({ keyPoses: [at] }),
      at,
      partsNetwork(steps, () => 0),
    );
    expect(found).toHaveLength(ALTERNATES);
    const batches = steps.filter(({ noise }) => noise.dims[0] > 1);
    expect(batches).toHaveLength(3);
    for (const [from, to] of [
      [0, 256],
      [256, 512],
    ]) {
      const forbidden = batches[2].noise.data.subarray(from, to).filter((v) => v === FORBIDDEN).length;
      // Sixteen samples; some share a part.
      expect(forbidden).toBeGreaterThan(12);
      expect(forbidden).toBeLessThanOrEqual(16);
    }
  });

  it('have what is on the timeline for their past, whoever made it', async () => {
    const steps: StepInputs[] = [];
    const before = key('b', 5.5, { suggested: true, rotations: pose(0.7) });
    await alternatePoses(request({ keyPoses: [before, at] }), at, fakeNetwork(steps));
    const last = steps.at(-1)!;
    expect(Array.from(last.poses.data.subarray(15 * ROW_SIZE, 15 * ROW_SIZE + 144))).toEqual(
      Array.from(quaternionsToSixD(poseToQuaternions(before.rotations))),
    );
  });
});

describe('the mark of a suggestion', () => {
  const keys = [key('s', 1, { suggested: true }), key('o', 2)];
  const ids = new Set(['s']);

  it('goes with the first edit of a hand', () => {
    const first = (list: readonly KeyPose[]) => list.find(({ id }) => id === 's')!;
    expect(first(editKeys(keys, ids, (each) => ({ ...each, rotations: pose(1) }))).suggested).toBeUndefined();
    expect(first(setStrength(keys, ids, 0.5)).suggested).toBeUndefined();
    expect(first(toggleLock(keys, ids)).suggested).toBeUndefined();
    expect(first(shiftKeys(keys, ids, 0.2, 10)).suggested).toBeUndefined();
    expect(first(settleKeys(keys, [key('n', 5)], 10)).suggested).toBe(true);
    expect(editKeys(keys, ids, (each) => each)).toBe(keys);
  });

  it('is kept in projects, and a damaged one costs only itself', () => {
    const song = { name: 'a.mp3', hash: 'ab', duration: 10 };
    const saved = JSON.parse(JSON.stringify({ ...createDocument(song), keyPoses: keys })) as { keyPoses: KeyPose[] };
    expect(parseDocument(saved).document.keyPoses).toEqual(keys);
    (saved.keyPoses[0] as unknown as Record<string, unknown>).suggested = 'maybe';
    const { document, repairs } = parseDocument(saved);
    expect(document.keyPoses).toEqual([key('s', 1), key('o', 2)]);
    expect(repairs).toHaveLength(1);
    expect(checkKeyPoses(keys, 10)).toEqual(keys);
  });
});
