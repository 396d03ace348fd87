/** A curves network of plain interpolation: enough to make whole dances without a model. */
import { CHANNELS } from '../../../web/core/curves';
import { CURVE_SIZE, type IntervalInputs, type IntervalOutputs } from '../../../web/core/curves-dance';
import { slerp } from '../../../web/core/rotation';

/** Straight from key pose to key pose, standing on the spot. */
export async function fakeIntervals({ intervals, keys }: IntervalInputs): Promise<IntervalOutputs> {
  const curves = new Float32Array(intervals * CHANNELS * CURVE_SIZE);
  const root = new Float32Array(intervals * 6);
  for (let i = 0; i < intervals; i++) {
    root.set([0, 0.95, 0, 0, 0.95, 0], i * 6);
    for (let joint = 0; joint < 24; joint++) {
      const [a, b] = [1, 2].map((n) =>
        keys.subarray(((i * 4 + n) * 24 + joint) * 4, ((i * 4 + n) * 24 + joint) * 4 + 4),
      );
      [1 / 3, 2 / 3].forEach((share, n) => {
        slerp(a, b, share).forEach((value, c) => {
          curves[(i * CHANNELS + 3 + joint * 4 + c) * CURVE_SIZE + 3 + n] = value;
        });
      });
    }
  }
  return { curves, root };
}
