import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { DEFAULT_TOOLS } from '../../web/core/default-tools';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../../web/core/skeleton';
import type { PoseTools } from '../../web/core/types';
import { PoseChange } from '../../web/scene/pose-change';

const KNEE = jointIndex('left_knee');
const HAND = jointIndex('left_wrist');
const FREE: PoseTools = { ...DEFAULT_TOOLS, limits: false, mirror: false, pins: new Set() };

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

function started() {
  const pointer = { holds: false };
  const heard: string[] = [];
  const change = new PoseChange({ holding: () => pointer.holds, changed: () => undefined }, true);
  change.load(new Array<number>(JOINT_COUNT * 3).fill(0));
  let last: number[] = [];
  change.edit.listen((rotations, phase) => {
    heard.push(phase);
    last = rotations;
  });
  const at = (joint: number) => [
    ...forwardKinematics(change.edit.quaternions, change.root).slice(joint * 3, joint * 3 + 3),
  ];
  return { change, pointer, heard, at, pose: () => last };
}

describe('changing the pose by the keyboard', () => {
  it('makes one change of quick turns, kept after a pause', () => {
    const { change, heard, pose } = started();
    change.nudge(KNEE, 'x', 0.2, FREE);
    vi.advanceTimersByTime(440);
    change.nudge(KNEE, 'x', 0.3, FREE);
    vi.advanceTimersByTime(440);
    expect(heard).toEqual(['start', 'change', 'change']);
    vi.advanceTimersByTime(20);
    expect(heard).toEqual(['start', 'change', 'change', 'commit']);
    expect(pose()[KNEE * 3]).toBeCloseTo(0.5, 5);
    change.nudge(KNEE, 'x', 0.1, FREE);
    expect(heard.slice(4)).toEqual(['start', 'change']);
  });

  it('adds quick moves up from where the joint was wanted, and a turn after them is a change of its own', () => {
    const { change, heard, at } = started();
    const from = at(HAND);
    for (let i = 0; i < 4; i++) change.nudgeBy(HAND, [0, -0.02, 0.01], FREE);
    for (let frame = 0; frame < 60 && change.update(1 / 60); frame++);
    at(HAND).forEach((c, i) => expect(c).toBeCloseTo(from[i] + [0, -0.08, 0.04][i], 2));
    expect(heard.filter((phase) => phase === 'start')).toHaveLength(1);
    change.nudge(KNEE, 'x', 0.2, FREE);
    expect(heard.slice(-3)).toEqual(['commit', 'start', 'change']);
  });

  it('is not kept while the pointer holds something', () => {
    const { change, pointer, heard } = started();
    change.nudge(KNEE, 'x', 0.2, FREE);
    pointer.holds = true;
    vi.advanceTimersByTime(1000);
    expect(heard).not.toContain('commit');
  });

  it('is taken back whole, and forgotten by the clock', () => {
    const { change, heard, pose } = started();
    change.nudgeBy(HAND, [0, -0.1, 0.1], FREE);
    change.cancel();
    expect(heard.at(-1)).toBe('cancel');
    pose().forEach((angle) => expect(angle).toBeCloseTo(0, 6));
    vi.advanceTimersByTime(1000);
    expect(heard.at(-1)).toBe('cancel');
  });
});

describe('where the edited figure stands', () => {
  it('goes with a move that is kept, stays for the same pose, and is the middle again for another', () => {
    const { change } = started();
    change.startMove(0, FREE);
    change.moveTo([0.2, change.root[1], 0]);
    while (change.update(1 / 60));
    change.keep();
    const [x] = Array.from(change.root);
    expect(x).toBeGreaterThan(0.05);
    let same: number[] = [];
    change.edit.listen((rotations) => (same = rotations));
    change.edit.start();
    change.cancel();
    change.load(same);
    expect(change.root[0]).toBeCloseTo(x, 6);
    change.load(same.map((angle, i) => (i === KNEE * 3 ? angle + 0.4 : angle)));
    expect(change.root[0]).toBe(0);
  });
});
