import { describe, expect, it } from 'vitest';
import { CHANNELS, emptyCurves, rotationChannel, sampleCurves, type CurveDance } from '../../web/core/curves';
import {
  applyEdits,
  findEdit,
  intervalOf,
  rippleEdits,
  withEdit,
  withoutOrphans,
  type CurveEdit,
} from '../../web/core/curves-edit';
import { createDocument } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';
import { angleBetween } from '../../web/core/rotation';
import { jointIndex } from '../../web/core/skeleton';
import { key, poseWith } from './dance';

const elbow = jointIndex('left_elbow');
/** Four key knots: two of the visitor's, two on beats. */
const dance = (): CurveDance => emptyCurves([0, 1, 2, 3], 3, ['k1', 'k2', 4, 6]);
const turn: CurveEdit = {
  from: 'k2',
  to: 4,
  track: 'left_elbow',
  knots: [
    [0, 0, 0.5],
    [0, 0, 0],
  ],
};

describe('an edit of a curve', () => {
  it('turns the joint at its knot by just that much, and leaves key poses, other joints and other stretches alone', () => {
    const curves = dance();
    const before = sampleCurves(curves, 30);
    const after = sampleCurves(applyEdits(curves, [turn]), 30);
    const q = (motion: typeof before, frame: number, joint: number) =>
      motion.quaternions.subarray((frame * 24 + joint) * 4, (frame * 24 + joint) * 4 + 4);
    expect(angleBetween(q(before, 40, elbow), q(after, 40, elbow))).toBeCloseTo(0.5, 5);
    for (const frame of [0, 30, 60, 89]) {
      expect(angleBetween(q(before, frame, elbow), q(after, frame, elbow))).toBeCloseTo(0, 5);
    }
    // One knot reaches two knots to either side.
    expect(angleBetween(q(before, 15, elbow), q(after, 15, elbow))).toBeCloseTo(0, 6);
    expect(angleBetween(q(before, 75, elbow), q(after, 75, elbow))).toBeCloseTo(0, 6);
    expect(angleBetween(q(before, 40, elbow + 1), q(after, 40, elbow + 1))).toBe(0);
    expect(curves.inner[2 * CHANNELS + rotationChannel(elbow) + 3]).toBe(1);
  });

  it('moves the root, and sets tension, continuity and bias of all of a joint', () => {
    const way: CurveEdit = {
      from: 'k1',
      to: 'k2',
      track: 'root',
      knots: [
        [0, 0.1, 0],
        [0.2, 0, 0],
      ],
      tension: 0.5,
    };
    const made = applyEdits(dance(), [way, { ...turn, continuity: -0.25, bias: 1 }]);
    expect([...made.inner.slice(0, 3)]).toEqual([0, expect.closeTo(0.1, 6), 0]);
    expect(made.inner[CHANNELS]).toBeCloseTo(0.2, 6);
    expect([...made.shape.slice(0, 4)]).toEqual([0.5, 0.5, 0.5, 0]);
    const at = (which: number) => (3 + which) * CHANNELS + rotationChannel(elbow);
    expect([...made.shape.slice(at(1), at(1) + 5)]).toEqual([-0.25, -0.25, -0.25, -0.25, 0]);
    expect([...made.shape.slice(at(2), at(2) + 4)]).toEqual([1, 1, 1, 1]);
  });

  it('waits while its key poses are not neighbours', () => {
    const other = emptyCurves([0, 1, 2], 3, ['k1', 'k2', 5]);
    expect(intervalOf(other, turn)).toBe(-1);
    expect(sampleCurves(applyEdits(other, [turn]), 30)).toEqual(sampleCurves(other, 30));
    expect(intervalOf(dance(), { from: 'k2', to: 4.01 })).toBe(1);
  });

  it('takes the place of the former one, and goes when it changes nothing any more', () => {
    const two = withEdit(withEdit([], turn), { ...turn, track: 'head', bias: 0.5 });
    expect(two).toHaveLength(2);
    const changed = withEdit(two, { ...turn, tension: 1 });
    expect(changed).toHaveLength(2);
    expect(findEdit(changed, dance(), 1, elbow)?.tension).toBe(1);
    const blank: CurveEdit = { from: 'k2', to: 4, track: 'left_elbow' };
    expect(withEdit(changed, blank)).toHaveLength(1);
    expect(withEdit(two.slice(1), blank)).toHaveLength(1);
  });

  it('goes along with its beats, and goes for good with a key pose', () => {
    // Beats half as far apart from now on: beat 4 was at 2 s, which is beat 8 of the new count.
    const moved = rippleEdits(
      [turn],
      (beat) => beat / 2,
      (time) => time,
      (time) => time * 4,
    );
    expect(moved[0]).toMatchObject({ from: 'k2', to: 8 });
    const still = [turn];
    expect(
      rippleEdits(
        still,
        (beat) => beat,
        (time) => time,
        (time) => time,
      ),
    ).toBe(still);
    expect(withoutOrphans(still, [key(1, poseWith({}))])).toEqual([]);
    expect(withoutOrphans(still, [{ ...key(1, poseWith({})), id: 'k2' }])).toBe(still);
  });
});

describe('a document', () => {
  const read = (extra: object) => parseDocument(JSON.parse(JSON.stringify({ ...createDocument(), ...extra })));

  it('keeps engine and edits through a file; one without them opens as before', () => {
    const { document, repairs } = read({ engine: 'curves', curveEdits: [turn] });
    expect(repairs).toEqual([]);
    expect(document.engine).toBe('curves');
    expect(document.curveEdits).toEqual([turn]);
    expect(read({}).document).toEqual(createDocument());
    expect(read({}).document).not.toHaveProperty('engine');
  });

  it('leaves damaged ones out and says so', () => {
    const broken = [{ ...turn, tension: 2 }, { ...turn, track: 'tail' }, { ...turn, knots: [[0, 0, 0]] }, 7];
    const { document, repairs } = read({ engine: 'heavy', curveEdits: [turn, ...broken, turn] });
    expect(document.engine).toBeUndefined();
    expect(document.curveEdits).toEqual([turn]);
    expect(repairs).toHaveLength(2);
    expect(read({ curveEdits: 'none' }).repairs).toHaveLength(1);
  });
});
