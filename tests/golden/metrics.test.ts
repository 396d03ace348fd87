import { describe, expect, it } from 'vitest';
import * as D from '../../web/core/dance-metrics';
import { motionBeats } from '../../web/core/metrics';
import { sliceMotion } from '../../web/core/motion';
import type { Motion } from '../../web/core/types';
import { agree, golden } from './golden';

interface Dance {
  quaternions: number[][];
  root: number[][];
}

const motionOf = ({ quaternions, root }: Dance): Motion => ({
  fps: 30,
  frames: root.length,
  root: Float32Array.from(root.flat()),
  quaternions: Float32Array.from(quaternions.flat()),
});

describe('measures that compare dances, in Python and TypeScript', () => {
  const g = golden<
    Dance & {
      other: Dance;
      beatFrames: number[];
      motionExtremaFrames: number[];
      freeze: { threshold: number; seconds: number };
      npss: number;
      poseFrechet: number;
      velocityFrechet: number;
      positionVariance: number;
      beatConsistency: number;
    }
  >('metrics');
  const [motion, other] = [motionOf(g), motionOf(g.other)];
  const relative = (actual: number, expected: number, tolerance: number) =>
    expect(Math.abs(actual / expected - 1)).toBeLessThan(tolerance);

  it('NPSS', () => relative(D.npss(motion, other), g.npss, 1e-4));
  // Sixty frames in 69 dimensions: half the spectrum is rounding, and its square root shows.
  it('PFD', () => relative(D.poseFrechet(motion, other), g.poseFrechet, 1e-3));
  it('VFD', () => relative(D.velocityFrechet(motion, other), g.velocityFrechet, 1e-3));
  it('PVar', () => {
    const rolled = sliceMotion(motion, 0);
    const at = (t: number) => (t - 20 + motion.frames) % motion.frames;
    for (let t = 0; t < motion.frames; t++) {
      rolled.quaternions.set(motion.quaternions.subarray(at(t) * 96, at(t) * 96 + 96), t * 96);
    }
    relative(D.positionVariance([motion, other, rolled]), g.positionVariance, 1e-4);
  });
  it('BC', () =>
    relative(
      D.beatConsistency(
        motion,
        g.beatFrames.map((frame) => frame / 30),
      ),
      g.beatConsistency,
      1e-4,
    ));
  it('extrema and freezes', () => {
    agree(
      motionBeats(motion, true).map((time) => time * 30),
      g.motionExtremaFrames,
      1e-6,
    );
    expect(D.longestFreeze(motion, g.freeze.threshold)).toBeCloseTo(g.freeze.seconds, 9);
  });
});
