import { describe, expect, it } from 'vitest';
import type { PoseDraft } from '../../web/app/pose-state';
import type { Dance } from '../../web/app/state';
import { chainPosition, jointChain } from '../../web/core/joint-path';
import { emptyMotion, frameView } from '../../web/core/motion';
import { poseToQuaternions, quaternionsToPose } from '../../web/core/rotation';
import { forwardKinematics, jointIndex } from '../../web/core/skeleton';
import type { KeyPose, Motion } from '../../web/core/types';
import { standingRoot } from '../../web/scene/body-points';
import { PATH_CAPACITY, PATH_MARK } from '../../web/scene/path-picture';
import {
  createPicture,
  draftStretch,
  draftTime,
  fillPicture,
  ghostsAround,
  keysWithDraft,
  markPicture,
} from '../../web/ui/stage/overlay-data';

const pose = (joint: string, turn: [number, number, number]): number[] => {
  const rotations = new Array<number>(72).fill(0);
  turn.forEach((angle, axis) => (rotations[jointIndex(joint) * 3 + axis] = angle));
  return rotations;
};
const KEYS: KeyPose[] = [
  { id: 'a', time: 1, rotations: pose('left_hip', [-1.2, 0, 0]) },
  { id: 'b', time: 2, rotations: pose('right_shoulder', [0, 0, 1]) },
  { id: 'c', time: 3, rotations: pose('left_shoulder', [0, 0.9, 0]) },
];
const draft = (rotations: number[], keyId: string | null): PoseDraft =>
  ({ rotations, keyId, name: '', joint: null, canUndo: false, canRedo: false }) as PoseDraft;

/** Walks along x at half a metre a second, hopping at two seconds. */
function walking(): Motion {
  const motion = emptyMotion(150);
  for (let frame = 0; frame < 150; frame++) {
    motion.root.set([frame / 60, frame === 60 ? 1.4 : 0.955, 0.25], frame * 3);
    motion.quaternions.set(poseToQuaternions(pose('right_elbow', [0, Math.sin(frame / 9), 0])), frame * 96);
  }
  return motion;
}
const danced = (motion: Motion, kind: Dance['kind'] = 'generated') => ({ motion, kind }) as Dance;
/** Where a joint of a pose is when the pose stands in the editor. */
function shownAt(rotations: number[], joint: number): number[] {
  const quaternions = poseToQuaternions(rotations);
  return [...forwardKinematics(quaternions, standingRoot(quaternions)).subarray(joint * 3, joint * 3 + 3)];
}

describe('ghosts', () => {
  it('are the neighbours, each where it is danced', () => {
    const ghosts = ghostsAround(KEYS, 1.6, walking(), true);
    expect(ghosts.map(({ kind, rotations }) => [kind, rotations])).toEqual([
      ['before', KEYS[0].rotations],
      ['after', KEYS[1].rotations],
    ]);
    expect(ghosts[0].root![0]).toBeCloseTo(0.5, 5);
    expect(ghosts[1].root![0]).toBeCloseTo(1, 5);
    expect(ghosts[1].root![1]).toBeCloseTo(1.4, 5);
  });

  it('stand on the floor where the dance was not made for them, and at the centre without a dance', () => {
    const standing = standingRoot(poseToQuaternions(KEYS[1].rotations));
    expect(ghostsAround(KEYS, 1.6, walking(), false)[1].root![1]).toBeCloseTo(standing[1], 5);
    expect(ghostsAround(KEYS, 1.6, null, false)[1].root).toEqual(standing);
  });

  it('are missing where there is no neighbour', () => {
    expect(ghostsAround(KEYS, 0, null, false).map(({ kind }) => kind)).toEqual(['after']);
    expect(ghostsAround(KEYS, 9, null, false).map(({ kind }) => kind)).toEqual(['before']);
    expect(ghostsAround([], 1, null, false)).toEqual([]);
  });
});

describe('the path through an edited pose', () => {
  const edited = pose('right_shoulder', [0.3, 0.4, 0.8]);
  const hand = jointIndex('right_hand');

  it('is danced at the key pose, or at the playhead for a new one', () => {
    expect(draftTime(draft(edited, 'c'), KEYS, 0.4)).toBe(3);
    expect(draftTime(draft(edited, null), KEYS, 0.4)).toBe(0.4);
    expect(
      keysWithDraft(draft(edited, 'b'), KEYS, 0.4)
        .map(({ time }) => time)
        .sort(),
    ).toEqual([1, 2, 3]);
    expect(
      keysWithDraft(draft(edited, null), KEYS, 0.4)
        .map(({ time }) => time)
        .sort(),
    ).toEqual([0.4, 1, 2, 3]);
  });

  for (const [name, dance] of [
    ['the dance', danced(walking())],
    ['SLERP without a dance', null],
    ['SLERP where only the starting clip plays', danced(walking(), 'preview')],
  ] as const) {
    it(`goes through the hand of the edited figure: ${name}`, () => {
      const stretch = draftStretch(draft(edited, 'b'), KEYS, dance, 0)!;
      const at = 60 - stretch.first;
      const point = new Float32Array(3);
      chainPosition(stretch.motion, at, jointChain(hand), point);
      shownAt(edited, hand).forEach((value, k) => expect(point[k]).toBeCloseTo(value, 4));
    });
  }

  it('is the dance itself out of the reach of the change', () => {
    const motion = walking();
    const stretch = draftStretch(draft(edited, 'b'), KEYS.slice(1, 2), danced(motion), 0)!;
    const far = quaternionsToPose(frameView(stretch.motion, 5).quaternions);
    const wanted = quaternionsToPose(frameView(motion, 5 + stretch.first).quaternions);
    wanted.forEach((value, i) => expect(far[i]).toBeCloseTo(value, 5));
  });

  it('says nothing for a lone pose without a dance', () => {
    expect(draftStretch(draft(edited, null), [], null, 1)).toBeNull();
  });
});

describe('the picture of a path', () => {
  it('takes a window of the points and knows the playhead between frames', () => {
    const picture = createPicture();
    const points = Float32Array.from({ length: 300 }, (_, i) => i);
    fillPicture(picture, points, 10, 20, 50, 1.05, 30);
    expect(picture.count).toBe(30);
    expect([...picture.points.subarray(0, 3)]).toEqual([30, 31, 32]);
    expect(picture.now).toBeCloseTo(11.5);
    fillPicture(picture, new Float32Array(3 * 1000), 0, 0, 1000, 1, 30);
    expect(picture.count).toBe(PATH_CAPACITY);
  });

  it('marks every third frame, beats over dots and key poses over beats', () => {
    const picture = createPicture();
    picture.count = 61;
    const grid = { tempo: 120, beatsPerBar: 4 as const, beats: [0, 0.5, 1, 1.5, 2, 2.5, 3], downbeats: [0, 2] };
    markPicture(picture, 30, 30, grid, KEYS);
    const at = (seconds: number) => picture.marks[Math.round(seconds * 30) - 30];
    expect(at(1)).toBe(PATH_MARK.key);
    expect(at(1.5)).toBe(PATH_MARK.beat);
    expect(at(2)).toBe(PATH_MARK.key);
    expect(at(2.5)).toBe(PATH_MARK.beat);
    expect(at(3)).toBe(PATH_MARK.key);
    expect(picture.marks.slice(0, 61).filter((mark) => mark === PATH_MARK.tick)).toHaveLength(16);
    // The dots stay on the song's frames while the window moves.
    markPicture(picture, 31, 30, null, []);
    expect(picture.marks[2]).toBe(PATH_MARK.tick);
  });
});
