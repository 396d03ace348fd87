import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { decodeMotion, encodeMotion } from '../../web/core/formats/motion-binary';
import { emptyMotion } from '../../web/core/motion';
import { angleBetween } from '../../web/core/rotation';

const part = fc.double({ min: -1, max: 1, noNaN: true });
const quaternion = fc
  .tuple(part, part, part, part)
  .filter((q) => Math.hypot(...q) > 1e-3)
  .map((q) => q.map((value) => value / Math.hypot(...q)));

describe('motion-binary', () => {
  it('gives every rotation back to 2e-4 radians, of unit length, neighbours with the same sign', () => {
    fc.assert(
      fc.property(fc.array(fc.tuple(quaternion, fc.nat(23)), { minLength: 1, maxLength: 20 }), (turns) => {
        const motion = emptyMotion(turns.length);
        turns.forEach(([q, joint], t) => motion.quaternions.set(q, (t * 24 + joint) * 4));
        const back = decodeMotion(encodeMotion(motion));
        let [angle, length, dot] = [0, 0, 1];
        for (let i = 0; i < motion.quaternions.length; i += 4) {
          const b = back.quaternions.subarray(i, i + 4);
          angle = Math.max(angle, angleBetween(motion.quaternions.subarray(i, i + 4), b));
          length = Math.max(length, Math.abs(Math.hypot(...b) - 1));
          if (i < 96) continue;
          const before = back.quaternions.subarray(i - 96, i - 92);
          dot = Math.min(
            dot,
            b.reduce((sum, value, k) => sum + value * before[k], 0),
          );
        }
        expect(angle).toBeLessThan(2e-4);
        expect(length).toBeLessThan(1e-5);
        expect(dot).toBeGreaterThanOrEqual(-1e-6);
      }),
    );
  });
  it('either reads bytes or refuses them with a sentence', () => {
    const good = encodeMotion(emptyMotion(2));
    fc.assert(
      fc.property(fc.nat(good.length - 1), fc.nat(255), fc.nat(good.length), (at, value, length) => {
        const bytes = good.slice(0, length);
        if (at < length) bytes[at] = value;
        try {
          expect(decodeMotion(bytes).root.length % 3).toBe(0);
        } catch (error) {
          expect((error as Error).message).toMatch(/dance file/);
        }
      }),
    );
  });
});
