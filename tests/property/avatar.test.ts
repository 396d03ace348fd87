import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { checkBones } from '../../web/core/avatar/bones';
import { guessBones } from '../../web/core/avatar/guess';
import { AvatarRetargeter } from '../../web/core/avatar/retarget';
import { readAvatarRig } from '../../web/core/avatar/rig';
import { worldOf } from '../../web/core/formats/gltf-tree';
import { frameView } from '../../web/core/motion';
import { axisAngleToQuaternion } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import {
  anonymousGlb,
  avatarFile,
  bodyOf,
  mixamoName,
  type Build,
  type FileOptions,
} from '../unit/support/avatar-rigs';
import { jointsOf, wildMotion } from '../unit/support/wild-motion';

const between = (min: number, max: number) => fc.double({ min, max, noNaN: true });
/** Bodies from a child's to a giant's, with limbs that need not fit each other. */
const builds: fc.Arbitrary<Build> = fc.record({
  thigh: between(0.25, 0.55),
  shin: between(0.25, 0.55),
  ankleHeight: between(0.05, 0.13),
  foot: between(0.09, 0.17),
  toes: between(0.04, 0.09),
  hips: between(0.06, 0.13),
  back: between(0.3, 0.6),
  backBones: fc.integer({ min: 1, max: 6 }),
  upperArm: between(0.2, 0.35),
  forearm: between(0.18, 0.32),
  shoulders: between(0.12, 0.25),
  armDrop: between(0, 0.9),
  neck: between(0.05, 0.12),
  head: between(0.15, 0.3),
});
/** Those whose limbs fit each other as people's do. */
const people = fc
  .tuple(builds, between(0.8, 1.25), between(0.75, 1.1), between(0.4, 0.7))
  .map(([build, shin, forearm, collar]) => ({
    ...build,
    shin: build.thigh * shin,
    forearm: build.upperArm * forearm,
    shoulders: 0.03 + build.upperArm * collar,
  }));
const files: fc.Arbitrary<Partial<FileOptions>> = fc.record({
  axes: fc.constantFrom('world', 'along', 'wild'),
  facing: fc.constantFrom([0, 0, 0, 1], [0, 1, 0, 0], [0, Math.SQRT1_2, 0, Math.SQRT1_2]),
  armature: fc.record({
    rotation: fc.constantFrom([0, 0, 0, 1], axisAngleToQuaternion<number[]>([-Math.PI / 2, 0, 0])),
    scale: fc.constantFrom(1, 0.01),
  }),
});
const LIMBS = ['left', 'right'].flatMap((side) => [
  [`${side}_shoulder`, `${side}_elbow`],
  [`${side}_elbow`, `${side}_wrist`],
  [`${side}_hip`, `${side}_knee`],
  [`${side}_knee`, `${side}_ankle`],
]);

describe('avatars of any build', () => {
  it('point arms and legs where ours point, in the air', () => {
    fc.assert(
      fc.property(builds, files, fc.nat(1000), (build, options, seed) => {
        const rig = readAvatarRig(avatarFile(bodyOf(build), { name: mixamoName, ...options }));
        const { bones, by } = guessBones(rig);
        expect(by).toBe('names');
        expect(checkBones(rig, bones).filter(({ blocking }) => blocking)).toEqual([]);
        const retargeter = new AvatarRetargeter(rig, bones);
        const dance = wildMotion(1, seed);
        dance.root[1] = 3;
        const frame = retargeter.frame(frameView(dance, 0), retargeter.createFrame());
        const local = rig.tree.rotations.map((rotation) => [...rotation]);
        retargeter.nodes.forEach((node, i) => (local[node] = Array.from(frame.rotations.subarray(i * 4, i * 4 + 4))));
        const { positions } = worldOf(rig.tree, local);
        const ours = jointsOf(dance, 0);
        for (const [from, to] of LIMBS) {
          const way = (points: ArrayLike<number>, a: number, b: number) => {
            const v = [0, 1, 2].map((k) => points[b * 3 + k] - points[a * 3 + k]);
            return v.map((value) => value / Math.hypot(...v));
          };
          const [a, b] = [jointIndex(from), jointIndex(to)];
          const [mine, theirs] = [way(ours, a, b), way(positions, bones[a], bones[b])];
          expect(Math.hypot(...mine.map((value, k) => value - theirs[k]))).toBeLessThan(1e-4);
        }
      }),
      { numRuns: 60, seed: 7 },
    );
  });

  it('are found by their shape alone', () => {
    fc.assert(
      fc.property(people, (build) => {
        const rig = readAvatarRig(anonymousGlb(build));
        const { bones, by } = guessBones(rig);
        const keys = bodyOf(build).map(({ key }) => key);
        expect(by).toBe('shape');
        const found = ['left_hip', 'left_knee', 'left_ankle', 'right_shoulder', 'right_elbow', 'right_wrist', 'head'];
        expect(found.map((joint) => keys[bones[jointIndex(joint)]])).toEqual([
          'leftThigh',
          'leftShin',
          'leftFoot',
          'rightUpperArm',
          'rightForearm',
          'rightHand',
          'head',
        ]);
      }),
      { numRuns: 60, seed: 7 },
    );
  });
});
