import { AnimationMixer, Vector3 } from 'three';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';
import { describe, expect, it } from 'vitest';
import { readBvh } from '../../web/core/formats/bvh-read';
import { writeBvh } from '../../web/core/formats/bvh-write';
import { quaternionToZyx } from '../../web/core/formats/euler-zyx';
import { resampleMotion } from '../../web/core/motion-resample';
import { REST } from '../../web/core/rest';
import { angleBetween, axisAngleToQuaternion, multiply } from '../../web/core/rotation';
import { JOINT_COUNT, JOINTS } from '../../web/core/skeleton';
import { anyTurn, farthest, jointsOf, noise, wildMotion } from './support/wild-motion';

/** What three makes of a file: joint positions at a time, in our order. */
function inThree(text: string) {
  const { skeleton, clip } = new BVHLoader().parse(text);
  const root = skeleton.bones[0];
  const mixer = new AnimationMixer(root);
  mixer.clipAction(clip).play();
  const at = (seconds: number) => {
    mixer.setTime(Math.min(seconds, clip.duration - 1e-7));
    root.updateMatrixWorld(true);
    return JOINTS.flatMap((name) => skeleton.getBoneByName(name)!.getWorldPosition(new Vector3()).toArray());
  };
  return { clip, at, bones: skeleton.bones };
}

const turn = (zyx: readonly number[]) => {
  const [z, y, x] = [2, 1, 0].map((axis, k) => {
    const vector = [0, 0, 0];
    vector[axis] = zyx[k];
    return axisAngleToQuaternion(vector);
  });
  return multiply(z, multiply(y, x));
};

describe('Euler angles', () => {
  it('stand for the rotation that they come from, whatever came before', () => {
    const random = noise(3);
    for (let i = 0; i < 3000; i++) {
      const q = anyTurn(random);
      const zyx = quaternionToZyx(q, [random() * 20 - 10, random() * 20 - 10, random() * 20 - 10]);
      expect(angleBetween(turn(zyx), q)).toBeLessThan(1e-6);
    }
  });

  it('stand for it at the lock too, and go on as they were there', () => {
    for (const pitch of [Math.PI / 2, -Math.PI / 2]) {
      for (const roll of [-2, 0, 0.7]) {
        const q = multiply(axisAngleToQuaternion([0, 0, roll]), axisAngleToQuaternion([0, pitch, 0]));
        const zyx = quaternionToZyx(q, [roll + 0.3, pitch, 0.3 * Math.sign(pitch)]);
        expect(angleBetween(turn(zyx), q)).toBeLessThan(1e-5);
        expect(zyx[0]).toBeCloseTo(roll + 0.3, 4);
      }
    }
  });

  it('turn through the lock without a jump', () => {
    let before: [number, number, number] = [0, 0, 0];
    for (let degrees = 0; degrees <= 720; degrees += 3) {
      const zyx = quaternionToZyx(axisAngleToQuaternion([0, (degrees * Math.PI) / 180, 0]), before);
      expect(Math.max(...zyx.map((angle, k) => Math.abs(angle - before[k])))).toBeLessThan(0.06);
      before = zyx;
    }
    expect(before[1]).toBeCloseTo(4 * Math.PI, 5);
  });
});

describe('BVH', () => {
  const motion = wildMotion(91, 11);

  it.each(['m', 'cm'] as const)('is the same dance in three, within a millimetre in every frame (%s)', (units) => {
    const scale = units === 'cm' ? 100 : 1;
    const { clip, at } = inThree(writeBvh(motion, { units }));
    // three counts one frame time more than there is between the first frame and the last.
    expect(clip.tracks[0].times).toHaveLength(motion.frames);
    expect(clip.duration).toBeCloseTo((motion.frames - 1) / motion.fps, 6);
    let most = 0;
    for (let frame = 0; frame < motion.frames; frame++) {
      const theirs = at(frame / motion.fps).map((value) => value / scale);
      most = Math.max(most, farthest(theirs, jointsOf(motion, frame)));
    }
    expect(most).toBeLessThan(1e-3);
  });

  it('has the first and the last pose to a ten-thousandth of a degree', () => {
    const { clip } = inThree(writeBvh(motion, { units: 'm' }));
    for (const track of clip.tracks) {
      const [name, property] = track.name.split('.');
      const joint = JOINTS.indexOf(name);
      if (joint < 0) continue;
      for (const frame of [0, motion.frames - 1]) {
        if (property !== 'quaternion') continue;
        const at = (frame * JOINT_COUNT + joint) * 4;
        const theirs = track.values.subarray(frame * 4, frame * 4 + 4);
        expect(angleBetween(theirs, motion.quaternions.subarray(at, at + 4))).toBeLessThan(2e-6);
      }
    }
  });

  it('rests in the T-pose, with end sites at head, hands and toes', () => {
    const { bones } = inThree(writeBvh(motion, { units: 'm' }));
    const rest = JOINTS.flatMap((name) => {
      let bone = bones.find((each) => each.name === name) ?? null;
      const place = new Vector3();
      for (; bone; bone = bone.parent as typeof bone) {
        const offset = (bone as unknown as { offset?: Vector3 }).offset ?? bone.position;
        place.add(offset);
      }
      return place.toArray();
    });
    const text = writeBvh(motion, { units: 'm' });
    expect(text.match(/End Site/g)).toHaveLength(5);
    // The root's own place is in the channels.
    expect(
      farthest(
        rest.map((value, i) => (i % 3 === 1 ? value + REST[1] : value)),
        REST,
      ),
    ).toBeLessThan(1e-5);
  });

  it('runs at 60 frames a second with the old frames in every second place', () => {
    const fast = resampleMotion(motion, 60);
    expect(fast.frames).toBe(181);
    const { at } = inThree(writeBvh(fast, { units: 'm' }));
    for (const frame of [0, 33, 90]) expect(farthest(at(frame / 30), jointsOf(motion, frame))).toBeLessThan(1e-3);
    const { clips } = readBvh(writeBvh(fast, { units: 'cm' }));
    expect(clips[0].fps).toBeCloseTo(60, 6);
    expect(clips[0].frames).toBe(181);
  });

  it('never spins between frames: no angle jumps by more than the body turns', () => {
    const smooth = resampleMotion(wildMotion(61, 5), 240);
    const lines = writeBvh(smooth, { units: 'm' })
      .split('\n')
      .slice(-smooth.frames - 1, -1);
    const rows = lines.map((line) => line.split(' ').map(Number));
    let most = 0;
    for (let i = 1; i < rows.length; i++) {
      for (let k = 3; k < rows[i].length; k++) most = Math.max(most, Math.abs(rows[i][k] - rows[i - 1][k]));
    }
    expect(most).toBeLessThan(185);
  });

  it('refuses a dance without frames', () => {
    expect(() => writeBvh(wildMotion(0, 1), { units: 'm' })).toThrow('no frames');
  });
});

describe('resampling', () => {
  it('keeps first and last frame and the duration where the rates divide', () => {
    const motion = wildMotion(31, 2);
    for (const fps of [60, 120]) {
      const out = resampleMotion(motion, fps);
      expect((out.frames - 1) / out.fps).toBeCloseTo(1, 9);
      expect(farthest(jointsOf(out, 0), jointsOf(motion, 0))).toBeLessThan(1e-6);
      expect(farthest(jointsOf(out, out.frames - 1), jointsOf(motion, 30))).toBeLessThan(1e-5);
    }
    expect(resampleMotion(motion, 24).frames).toBe(25);
    expect(resampleMotion(wildMotion(33, 2), 24).frames).toBe(26);
    expect(resampleMotion(motion, 30)).toBe(motion);
  });
});
