/** A dance of curves as a GLB animation: cubic splines with keys at the key poses and the inner knots, so that they stay editable. */
import { channelsOf } from '../curves-edit';
import { allTracks, knotTimes, knotTrack, type CurveDance } from '../curves';
import { writeGlb, type GlbSampler } from './glb-write';

/**
 * One CUBICSPLINE sampler for the place of the pelvis and one for every joint's rotation. A Kochanek-Bartels curve is a cubic Hermite
 * curve, and so is glTF's, with tangents per second (specification 2.0, appendix C), so nothing is lost.
 * @throws Error when there are no two key poses to draw curves between
 */
export function curveSamplers(curves: CurveDance): GlbSampler[] {
  if (curves.times.length < 2) throw new Error('Curves need two key poses at least: place another one.');
  const times = knotTimes(curves);
  // One array for all samplers: it is written once.
  const shared = Float32Array.from(times);
  return allTracks().map((track) => {
    const { first, count } = channelsOf(track);
    const values = new Float32Array(times.length * count * 3);
    for (let c = 0; c < count; c++) {
      const { arriving, values: knots, leaving } = knotTrack(curves, first + c, times);
      for (let i = 0; i < times.length; i++) {
        const at = i * count * 3 + c;
        values[at] = arriving[i];
        values[at + count] = knots[i];
        values[at + count * 2] = leaving[i];
      }
    }
    const joint = track === 'root' ? 0 : track;
    const path = track === 'root' ? 'translation' : 'rotation';
    return { joint, path, times: shared, values, interpolation: 'CUBICSPLINE' };
  });
}

/**
 * The skeleton with its curves as a GLB file.
 * @param name of the animation
 */
export function writeCurvesGlb(curves: CurveDance, name: string): Uint8Array<ArrayBuffer> {
  return writeGlb({ name, samplers: curveSamplers(curves) });
}
