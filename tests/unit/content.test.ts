import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { parseDocument } from '../../web/core/document-read';
import { decodeMotion } from '../../web/core/formats/motion-binary';
import { withinLimits } from '../../web/core/joint-limits';
import { consistencyError, jointSpeed } from '../../web/core/metrics';
import { angleBetween, axisAngleToQuaternion, poseToQuaternions, rotateVector } from '../../web/core/rotation';
import { seedMotion } from '../../web/core/seed';
import { forwardKinematics, JOINTS, jointIndex, mirrorPose, OFFSETS, worldRotations } from '../../web/core/skeleton';
import { spec } from '../../web/core/spec';
import type { LibraryPose, SeedClip } from '../../web/core/types';

const file = (path: string) => readFileSync(new URL(`../../public/${path}`, import.meta.url));
const json = (path: string): unknown => JSON.parse(file(path).toString('utf8'));
const { poses } = json('library/poses.json') as { poses: LibraryPose[] };
const { clips } = json('library/seeds.json') as { clips: SeedClip[] };

const ORIGIN = [0, 0, 0];
const degrees = (radians: number) => (radians * 180) / Math.PI;
const joint = (rotations: readonly number[], name: string) => {
  const at = jointIndex(name) * 3;
  return rotations.slice(at, at + 3);
};
const positions = (rotations: readonly number[]) => forwardKinematics(poseToQuaternions(rotations), ORIGIN);
const distance = (a: ArrayLike<number>, b: ArrayLike<number>, i: number) =>
  Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]);
/** Mean distance of the joints of two poses whose pelvises lie on each other, metres. */
function poseDistance(a: readonly number[], b: readonly number[]): number {
  const [p, q] = [positions(a), positions(b)];
  let sum = 0;
  for (let i = 0; i < p.length; i += 3) sum += distance(p, q, i);
  return (sum * 3) / p.length;
}

/** What no body can do, in words; empty when the pose is possible. */
function impossible(rotations: readonly number[]): string[] {
  const wrong: string[] = [];
  for (const side of ['left', 'right']) {
    const [bend, ...rest] = joint(rotations, `${side}_knee`);
    if (bend < 0 || degrees(bend) > 151) wrong.push(`${side} knee bends ${degrees(bend)}`);
    if (Math.hypot(...rest) > 0.01) wrong.push(`${side} knee twists`);
    // The forearm may fold to the front of the upper arm only (+Z in its rest frame).
    const forearm = rotateVector(
      axisAngleToQuaternion(joint(rotations, `${side}_elbow`)),
      OFFSETS[jointIndex(`${side}_wrist`)],
    );
    if (forearm[2] < -0.01) wrong.push(`${side} elbow bends backwards`);
    if (degrees(Math.hypot(...joint(rotations, `${side}_ankle`))) > 90) wrong.push(`${side} ankle`);
    if (degrees(Math.hypot(...joint(rotations, `${side}_wrist`))) > 85) wrong.push(`${side} wrist`);
    if (degrees(Math.hypot(...joint(rotations, `${side}_collar`))) > 50) wrong.push(`${side} collar`);
  }
  for (const name of ['spine1', 'spine2', 'spine3', 'neck', 'head']) {
    if (degrees(Math.hypot(...joint(rotations, name))) > 48) wrong.push(name);
  }
  return wrong;
}

/** Horizontal distance from the centre of mass to the nearest point of the area between the feet, metres. */
function offBalance(rotations: readonly number[]): number {
  const points = positions(rotations);
  const world = worldRotations(poseToQuaternions(rotations));
  const at = (i: number) => [points[i * 3], points[i * 3 + 1], points[i * 3 + 2]];
  const shares: [string, string, number][] = [
    ['pelvis', 'spine2', 0.26],
    ['spine2', 'neck', 0.23],
    ['neck', 'head', 0.08],
  ];
  for (const side of ['left', 'right']) {
    shares.push([`${side}_shoulder`, `${side}_elbow`, 0.028], [`${side}_elbow`, `${side}_hand`, 0.022]);
    shares.push([`${side}_hip`, `${side}_knee`, 0.1], [`${side}_knee`, `${side}_ankle`, 0.0465]);
    shares.push([`${side}_ankle`, `${side}_foot`, 0.0145]);
  }
  const total = shares.reduce((sum, [, , share]) => sum + share, 0);
  const mass = [0, 2].map((axis) =>
    shares.reduce(
      (sum, [a, b, share]) => sum + (share / total) * ((at(jointIndex(a))[axis] + at(jointIndex(b))[axis]) / 2),
      0,
    ),
  );
  const soles: number[][] = [];
  for (const [ankle, toe] of [
    [7, 10],
    [8, 11],
  ]) {
    const rotation = world.slice(ankle * 4, ankle * 4 + 4);
    const heel = rotateVector(rotation, [0, -0.06, -0.05]).map((value, k) => value + at(ankle)[k]);
    const tip = rotateVector(world.slice(toe * 4, toe * 4 + 4), [0, 0, 0.06]).map((value, k) => value + at(toe)[k]);
    soles.push(heel, at(toe), tip);
  }
  const floor = Math.min(...soles.map((point) => point[1]));
  const support = soles.filter((point) => point[1] < floor + 0.06);
  // Frank-Wolfe: walk to the nearest point of the convex hull of the support points.
  let [x, z] = [support[0][0], support[0][2]];
  for (let step = 0; step < 400; step++) {
    const [gx, gz] = [x - mass[0], z - mass[1]];
    const best = support.reduce((a, b) => (a[0] * gx + a[2] * gz < b[0] * gx + b[2] * gz ? a : b));
    const rate = 2 / (step + 2);
    x += rate * (best[0] - x);
    z += rate * (best[2] - z);
  }
  return Math.hypot(x - mass[0], z - mass[1]);
}

describe('the pose library', () => {
  it('has at least 60 poses in groups of four and more, each with its own id and name', () => {
    expect(poses.length).toBeGreaterThanOrEqual(60);
    const groups = [...new Set(poses.map((pose) => pose.group))];
    expect(groups.length).toBeGreaterThanOrEqual(10);
    for (const group of groups) {
      expect(poses.filter((pose) => pose.group === group).length, group).toBeGreaterThanOrEqual(4);
    }
    // A group keeps together: the library shows it under one heading.
    expect(poses.filter((pose, i) => pose.group !== poses[i - 1]?.group)).toHaveLength(groups.length);
    expect(new Set(poses.map((pose) => pose.id)).size).toBe(poses.length);
    expect(new Set(poses.map((pose) => pose.name)).size).toBe(poses.length);
    for (const { id } of poses) expect(id).toMatch(/^[a-z0-9-]+$/);
  });
  it.each(poses.map((pose) => [pose.name, pose] as const))('%s is a pose that a body can take', (_, pose) => {
    expect(pose.rotations).toHaveLength(JOINTS.length * 3);
    for (let i = 0; i < pose.rotations.length; i += 3) {
      expect(Math.hypot(...pose.rotations.slice(i, i + 3))).toBeLessThanOrEqual(Math.PI + 1e-3);
    }
    expect(impossible(pose.rotations)).toEqual([]);
  });
  // The limits are those of anybody; who dances is a little more supple.
  const SUPPLE = 8;
  it.each(poses.map((pose) => [pose.name, pose] as const))('%s stays inside the joints’ limits', (_, pose) => {
    const quaternions = poseToQuaternions(pose.rotations);
    const beyond = JOINTS.filter((_, i) => !withinLimits(i, quaternions.slice(i * 4, i * 4 + 4), SUPPLE));
    expect(beyond).toEqual([]);
  });
  const low = ['kneeling-reach', 'kneel', 'dip'];
  const standing = poses.filter((pose) => !['Jumps', 'Street'].includes(pose.group) && !low.includes(pose.id));
  it.each(standing.map((pose) => [pose.name, pose] as const))('%s stands: its weight is over its feet', (_, pose) => {
    expect(offBalance(pose.rotations)).toBeLessThan(0.03);
  });
  it('shows no pose twice, not even as a mirror image', () => {
    for (const [i, a] of poses.entries()) {
      for (const b of poses.slice(i + 1)) {
        const least = Math.min(
          poseDistance(a.rotations, b.rotations),
          poseDistance(mirrorPose(a.rotations), b.rotations),
        );
        expect(least, `${a.name} and ${b.name}`).toBeGreaterThan(0.05);
      }
    }
  });
  it('is asymmetric: nobody stands like a tailor’s dummy', () => {
    const references = ['t-pose', 'a-pose'];
    for (const { id, name, rotations } of poses) {
      const lopsided = poseDistance(rotations, mirrorPose(rotations));
      if (references.includes(id)) expect(lopsided, name).toBeLessThan(1e-6);
      else expect(lopsided, name).toBeGreaterThan(0.02);
    }
  });
});

const TEMPO = 120;
const grid = {
  tempo: TEMPO,
  beatsPerBar: 4 as const,
  beats: Array.from({ length: 64 }, (_, i) => i / 2),
  downbeats: Array.from({ length: 16 }, (_, i) => i * 2),
};

describe.each(clips.map((clip) => [clip.name, clip] as const))('the starting clip %s', (_, clip) => {
  const frames = (clip.beats * 60 * spec.fps) / TEMPO;
  const motion = seedMotion(clip, grid, frames);
  const points = Array.from({ length: frames }, (_, t) =>
    forwardKinematics(motion.quaternions.subarray(t * 96, t * 96 + 96), motion.root.subarray(t * 3, t * 3 + 3)),
  );

  it('has beats x rate poses that a body can take, and starts in the middle of the floor', () => {
    expect(clip.poses).toHaveLength(clip.beats * clip.rate);
    expect(clip.root).toHaveLength(clip.beats * clip.rate);
    expect([clip.root[0][0], clip.root[0][2]]).toEqual([0, 0]);
    for (const pose of clip.poses) expect(impossible(pose)).toEqual([]);
  });
  it('goes round without a jump', () => {
    const turns = clip.poses.map((pose, i) => {
      const [a, b] = [pose, clip.poses[(i + 1) % clip.poses.length]].map((p) => poseToQuaternions(p));
      return Math.max(...JOINTS.map((_, j) => angleBetween(a.slice(j * 4, j * 4 + 4), b.slice(j * 4, j * 4 + 4))));
    });
    expect(turns.at(-1)).toBeLessThanOrEqual(Math.max(...turns.slice(0, -1)));
    const steps = clip.root.map((place, i) => distance(place, clip.root[(i + 1) % clip.root.length], 0));
    expect(steps.at(-1)).toBeLessThanOrEqual(Math.max(...steps.slice(0, -1)) * 1.2);
  });
  it('keeps planted feet where they are and nothing below the floor', () => {
    for (const toe of [10, 11]) {
      let stand: number[][] = [];
      const end = () => {
        // The first and the last frame of a stand belong to the landing and the push.
        const inner = stand.slice(1, -1);
        for (const place of inner)
          expect(Math.hypot(place[0] - inner[0][0], place[1] - inner[0][1])).toBeLessThan(0.01);
        stand = [];
      };
      for (const frame of points) {
        const height = frame[toe * 3 + 1];
        expect(height).toBeGreaterThan(spec.skeleton.toeHeight - 0.01);
        if (height < spec.skeleton.toeHeight + 0.003) stand.push([frame[toe * 3], frame[toe * 3 + 2]]);
        else end();
      }
      end();
    }
  });
  it('is lively: each beat is a new picture, at the speed of a dance', () => {
    for (let beat = 0; beat < clip.beats; beat++) {
      const next = clip.poses[((beat + 1) % clip.beats) * clip.rate];
      expect(poseDistance(clip.poses[beat * clip.rate], next)).toBeGreaterThan(0.04);
    }
    const speed = jointSpeed(motion);
    const mean = speed.reduce((sum, value) => sum + value, 0) / speed.length;
    expect(mean).toBeGreaterThan(0.35);
    expect(mean).toBeLessThan(1.1);
  });
});

it('has at least six starting clips, each with its own id', () => {
  expect(clips.length).toBeGreaterThanOrEqual(6);
  expect(new Set(clips.map((clip) => clip.id)).size).toBe(clips.length);
});

describe('the demo', () => {
  const song = file('demo/song.mp3');
  const { document, repairs } = parseDocument(json('demo/demo.json'));
  const dance = decodeMotion(file('demo/dance.bin'));

  it('is a sound project for its song, which is small enough to open a page with', () => {
    expect(repairs).toEqual([]);
    expect(document.song?.hash).toBe(createHash('sha256').update(song).digest('hex'));
    expect(song.length).toBeLessThan(1.4e6);
    expect(clips.map((clip) => clip.id)).toContain(document.dials.seedClip);
  });
  it('has its key poses, all from the library, on beats', () => {
    expect(document.keyPoses.length).toBeGreaterThanOrEqual(10);
    const library = new Map(poses.map((pose) => [pose.name, pose.rotations]));
    for (const key of document.keyPoses) {
      expect(document.grid?.beats).toContain(key.time);
      expect(key.rotations).toEqual(library.get(key.name ?? ''));
    }
  });
  it('has a dance of the song’s length that goes through every key pose', () => {
    expect(dance.fps).toBe(spec.fps);
    expect(dance.frames).toBe(Math.ceil((document.song?.duration ?? 0) * spec.fps));
    expect(consistencyError(dance, document.keyPoses)).toBeLessThan(1e-3);
  });
});
