import { describe, it } from 'vitest';
import {
  CHANNELS,
  emptyCurves,
  evaluateTrack,
  knotTimes,
  knotTrack,
  rotationChannel,
  unit,
} from '../../web/core/curves';
import { agree, golden } from './golden';

interface Samples {
  tolerance: number;
  times: number[];
  /** One row per key, inner knot, shape: root x y z, then one joint's quaternion. */
  keys: number[][];
  inner: number[][][];
  tensionContinuityBias: number[][][];
  knotTimes: number[];
  arriving: number[][];
  leaving: number[][];
  at: number[];
  root: number[][];
  quaternions: number[][];
}

describe('curves agree with Python', () => {
  const samples = golden<Samples>('curves-samples');
  const { tolerance } = samples;
  const joint = rotationChannel(4);
  const channels = [0, 1, 2, joint, joint + 1, joint + 2, joint + 3];
  // The numbers as they are: a dance holds them in 32 bits, which is not what is compared here.
  const made = emptyCurves(samples.times, samples.times[samples.times.length - 1]);
  const curves = {
    ...made,
    keys: Float64Array.from(made.keys) as unknown as Float32Array,
    inner: Float64Array.from(made.inner) as unknown as Float32Array,
    shape: Float64Array.from(made.shape) as unknown as Float32Array,
    shares: Float64Array.from(made.shares, (_, i) => ((i % 2) + 1) / 3) as unknown as Float32Array,
  };
  const put = (list: Float32Array, rows: number[][]) =>
    rows.forEach((row, i) => row.forEach((value, c) => (list[i * CHANNELS + channels[c]] = value)));
  put(curves.keys, samples.keys);
  put(curves.inner, samples.inner.flat());
  put(curves.shape, samples.tensionContinuityBias.flat());
  const tracks = channels.map((channel) => knotTrack(curves, channel));

  it('in where the knots are and how fast the curve comes and goes', () => {
    agree(knotTimes(curves), samples.knotTimes, tolerance);
    tracks.forEach(({ arriving, leaving }, c) => {
      agree(
        arriving.slice(1),
        samples.arriving.slice(1).map((row) => row[c]),
        tolerance,
      );
      agree(
        leaving.slice(0, -1),
        samples.leaving.slice(0, -1).map((row) => row[c]),
        tolerance,
      );
    });
  });

  it('at any moment', () => {
    samples.at.forEach((time, i) => {
      const values = tracks.map((track) => evaluateTrack(track, time));
      agree(values.slice(0, 3), samples.root[i], tolerance);
      agree(unit(values[3], values[4], values[5], values[6]), samples.quaternions[i], tolerance);
    });
  });
});
