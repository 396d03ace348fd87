import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { framePose } from '../../web/core/motion';
import { forwardKinematics, JOINTS } from '../../web/core/skeleton';
import type { Motion } from '../../web/core/types';
import { cameraPath, FIELD_OF_VIEW, smooth, smoothAbove } from '../../web/video/camera-path';
import { framePlan, frameTime, VIDEO_CAMERAS, videoSize, ASPECTS } from '../../web/video/options';
import { barsPerShot, cutFrames, glowAt, shotsOf } from '../../web/video/shots';
import { wildMotion } from './support/wild-motion';

const grid = (tempo: number, seconds = 60, offset = 0.3) => {
  const beats = Array.from({ length: Math.floor((seconds * tempo) / 60) }, (_, i) => offset + (i * 60) / tempo);
  return { tempo, beatsPerBar: 4 as const, beats, downbeats: beats.filter((_, i) => i % 4 === 0) };
};

describe('beat cuts', () => {
  it('are on the frame nearest to a downbeat, at every quick song by two bars', () => {
    const music = grid(123);
    expect(barsPerShot(music.downbeats)).toBe(2);
    const plan = framePlan({ start: 0, end: 30 }, 30);
    const cuts = cutFrames(plan, music);
    expect(cuts[0].frame).toBe(0);
    expect(cuts.length).toBeGreaterThan(5);
    for (const { frame } of cuts.slice(1)) {
      const off = Math.min(...music.downbeats.map((time) => Math.abs(time - frameTime(plan, frame))));
      expect(off).toBeLessThanOrEqual(0.5 / 30 + 1e-9);
    }
  });

  it.each([
    [60, 1],
    [80, 1],
    [140, 2],
    [240, 4],
  ])('at %d beats a minute come every %d bars', (tempo, bars) => expect(barsPerShot(grid(tempo).downbeats)).toBe(bars));

  it('of a part of the song are those of the whole, shot for shot', () => {
    const music = grid(120);
    const whole = cutFrames(framePlan({ start: 0, end: 40 }, 30), music);
    const part = cutFrames(framePlan({ start: 10, end: 30 }, 30), music);
    for (const cut of part.slice(1)) expect(whole).toContainEqual({ frame: cut.frame + 300, number: cut.number });
    expect(part[0].number).toBe(whole.findLast(({ frame }) => frame <= 300 + 30)!.number);
  });

  it('leave no shot shorter than a second, and change the camera each time', () => {
    const plan = framePlan({ start: 0.2, end: 30.5 }, 60);
    const shots = shotsOf('cuts', plan, grid(120));
    expect(shots[0].from).toBe(0);
    expect(shots.at(-1)!.to).toBe(plan.frames);
    shots.forEach((shot, i) => {
      expect(shot.to - shot.from).toBeGreaterThanOrEqual(60);
      if (i > 0) {
        expect(shot.from).toBe(shots[i - 1].to);
        expect(shot.azimuth).not.toBe(shots[i - 1].azimuth);
      }
    });
  });

  it('come without a song too', () => {
    const cuts = cutFrames(framePlan({ start: 0, end: 12 }, 30), null);
    expect(cuts.map(({ frame }) => frame)).toEqual([0, 120, 240]);
  });
});

describe('smoothing', () => {
  it('keeps a straight line straight and neither lags nor leads', () => {
    const line = Float64Array.from({ length: 200 }, (_, i) => i * 0.1);
    const out = smooth(line, 1, 8);
    for (let i = 20; i < 180; i++) expect(out[i]).toBeCloseTo(line[i], 9);
  });

  it('above stays above', () => {
    let seed = 7;
    const values = Float64Array.from({ length: 300 }, () => (seed = (seed * 16807) % 2147483647) / 2147483647);
    const out = smoothAbove(values, 6);
    values.forEach((value, i) => expect(out[i]).toBeGreaterThanOrEqual(value - 1e-12));
  });
});

describe('the camera', () => {
  const motion: Motion = wildMotion(240, 5);
  const plan = framePlan({ start: 0.5, end: 7.5 }, 30);

  /** Joints of a frame as the camera of that frame sees them: -1..1 across and up. */
  function seen(path: ReturnType<typeof cameraPath>, aspect: number, frame: number): Vector3[] {
    const camera = new PerspectiveCamera(FIELD_OF_VIEW, aspect, 0.05, 120);
    camera.position.fromArray(path.position, frame * 3);
    camera.lookAt(new Vector3().fromArray(path.target, frame * 3));
    camera.updateMatrixWorld();
    const pose = framePose(motion, frameTime(plan, frame));
    const joints = forwardKinematics(pose.quaternions, pose.root);
    return JOINTS.map((_, joint) => new Vector3().fromArray(joints, joint * 3).project(camera));
  }

  for (const aspect of ASPECTS) {
    const { width, height } = videoSize(aspect, 720);
    it.each(['follow', 'front', 'orbit'] as const)(`keeps the whole body in ${aspect}: %s`, (kind) => {
      const path = cameraPath(motion, plan, width / height, kind, grid(120));
      let widest = 0;
      for (let frame = 0; frame < plan.frames; frame++)
        for (const { x, y } of seen(path, width / height, frame)) {
          widest = Math.max(widest, Math.abs(x), Math.abs(y));
        }
      expect(widest).toBeLessThan(1);
      // And does not stand miles away.
      expect(widest).toBeGreaterThan(0.6);
    });

    it(`keeps the upper body in ${aspect} whatever the shot`, () => {
      const path = cameraPath(motion, plan, width / height, 'cuts', grid(120));
      const upper = JOINTS.flatMap((name, i) => (/hip|knee|ankle|foot/.test(name) ? [] : [i]));
      for (let frame = 0; frame < plan.frames; frame++) {
        const points = seen(path, width / height, frame);
        for (const joint of upper) {
          expect(Math.abs(points[joint].x)).toBeLessThan(1);
          expect(Math.abs(points[joint].y)).toBeLessThan(1);
        }
      }
    });
  }

  it('stays above the floor, is a number, and is the same when asked again', () => {
    for (const kind of VIDEO_CAMERAS) {
      const path = cameraPath(motion, plan, 1, kind, grid(120));
      for (let frame = 0; frame < plan.frames; frame++) expect(path.position[frame * 3 + 1]).toBeGreaterThan(0.1);
      expect([...path.position, ...path.target, ...path.centre].every(Number.isFinite)).toBe(true);
      expect(cameraPath(motion, plan, 1, kind, grid(120))).toEqual(path);
    }
  });

  it('goes round once in eight bars', () => {
    const [shot] = shotsOf('orbit', framePlan({ start: 0, end: 16 }, 30), grid(120));
    expect(shot.turn).toBeCloseTo(2 * Math.PI, 6);
  });

  it('moves smoothly: no jump within a shot', () => {
    for (const kind of ['follow', 'front', 'orbit'] as const) {
      const { position } = cameraPath(motion, plan, 16 / 9, kind, grid(120));
      for (let i = 3; i < position.length; i += 3) {
        const step = Math.hypot(...[0, 1, 2].map((k) => position[i + k] - position[i + k - 3]));
        expect(step).toBeLessThan(0.2);
      }
    }
  });
});

describe('the glow', () => {
  it('is brightest on a downbeat and fades', () => {
    const music = grid(120);
    expect(glowAt(music.downbeats[2], music)).toBeCloseTo(0.9, 9);
    expect(glowAt(music.beats[1], music)).toBeCloseTo(0.45, 9);
    expect(glowAt(music.beats[1] + 0.2, music)).toBeCloseTo(0.45 * Math.exp(-0.9), 9);
    expect(glowAt(0.1, music)).toBe(0);
    expect(glowAt(3, null)).toBe(0);
  });
});

describe('the view on stage', () => {
  const motion = wildMotion(90, 3);
  const plan = framePlan({ start: 0, end: 2 }, 30);
  const view = {
    follows: true,
    position: [2, 1.5, 3] as [number, number, number],
    target: [0.1, 1, 0] as [number, number, number],
  };

  it('is kept, and goes with the dancer where it follows', () => {
    const stands = cameraPath(motion, plan, 16 / 9, 'stage', null, { ...view, follows: false });
    const goes = cameraPath(motion, plan, 16 / 9, 'stage', null, view);
    for (let frame = 0; frame < plan.frames; frame += 7)
      for (let axis = 0; axis < 3; axis++) {
        const dancer = axis === 1 ? 0 : goes.centre[frame * 2 + axis / 2];
        expect(stands.position[frame * 3 + axis]).toBeCloseTo(view.position[axis], 5);
        expect(stands.target[frame * 3 + axis]).toBeCloseTo(view.target[axis], 5);
        expect(goes.position[frame * 3 + axis]).toBeCloseTo(view.position[axis] + dancer, 5);
        expect(goes.target[frame * 3 + axis]).toBeCloseTo(view.target[axis] + dancer, 5);
      }
  });

  it('shows upright what a square shows, from further away', () => {
    const upright = cameraPath(motion, plan, 9 / 16, 'stage', null, { ...view, follows: false });
    const away = (at: ArrayLike<number>) => Math.hypot(...[0, 1, 2].map((k) => at[k] - view.target[k]));
    expect(away(upright.position.subarray(0, 3)) / away(view.position)).toBeCloseTo(16 / 9, 5);
  });

  it('is the camera that follows until it was turned', () => {
    const [untouched, follow] = (['stage', 'follow'] as const).map((name) => cameraPath(motion, plan, 1, name, null));
    expect(untouched).toEqual(follow);
  });
});
