import { describe, expect, it } from 'vitest';
import { motionHash } from '../../web/app/hash';
import { emptyMotion } from '../../web/core/motion';
import { quantisedMotion } from '../../web/core/formats/motion-quantised';
import { wildMotion } from './support/wild-motion';

describe('the hash of a dance', () => {
  it('is of known bytes', async () => {
    const motion = emptyMotion(1);
    motion.root.set([0.1, -1.00004, 2]);
    const bytes = quantisedMotion(motion);
    expect([...bytes.slice(0, 24)]).toEqual([
      80, 66, 81, 49, 0, 0, 240, 65, 1, 0, 0, 0, 232, 3, 0, 0, 240, 216, 255, 255, 32, 78, 0, 0,
    ]);
    expect([...new Int16Array(bytes.slice(24).buffer)].slice(0, 8)).toEqual([0, 0, 0, 16384, 0, 0, 0, 16384]);
    expect(bytes).toHaveLength(24 + 24 * 8);
    const digest = await crypto.subtle.digest('SHA-256', bytes);
    expect(await motionHash(motion)).toBe(Buffer.from(digest).toString('hex'));
  });

  it('does not see the sign of a quaternion or a hundredth of a millimetre, but a degree and a millimetre', async () => {
    const motion = wildMotion(30, 3);
    for (let i = 0; i < motion.root.length; i += 1) motion.root[i] = Math.round(motion.root[i] * 1e4) / 1e4;
    const hash = await motionHash(motion);
    const other = (change: (copy: ReturnType<typeof emptyMotion>) => void) => {
      const copy = { ...motion, root: motion.root.slice(), quaternions: motion.quaternions.slice() };
      change(copy);
      return motionHash(copy);
    };
    expect(await other(({ quaternions }) => quaternions.forEach((value, i) => (quaternions[i] = -value)))).toBe(hash);
    expect(await other(({ root }) => root.forEach((value, i) => (root[i] = value + 1e-5)))).toBe(hash);
    expect(await other(({ root }) => (root[40] += 1e-3))).not.toBe(hash);
    expect(await other((copy) => (copy.fps = 60))).not.toBe(hash);
    expect(await other(({ quaternions }) => quaternions.set([0, 0, Math.sin(0.5), Math.cos(0.5)], 100))).not.toBe(hash);
  });

  it('of ten minutes takes no longer than a blink', () => {
    const motion = wildMotion(600, 5);
    quantisedMotion(motion);
    const long = { ...emptyMotion(18_000) };
    const began = performance.now();
    const bytes = quantisedMotion(long);
    expect(performance.now() - began).toBeLessThan(1000);
    expect(bytes).toHaveLength(12 + 18_000 * (12 + 192));
  });
});
