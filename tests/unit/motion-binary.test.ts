import { describe, expect, it } from 'vitest';
import { decodeMotion, encodeMotion } from '../../web/core/formats/motion-binary';
import { emptyMotion } from '../../web/core/motion';
import { axisAngleToQuaternion } from '../../web/core/rotation';

function twoFrames() {
  const motion = emptyMotion(2);
  motion.root.set([0.1, 0.95, -20.5, 0.2, 0.9, 3]);
  motion.quaternions.set(axisAngleToQuaternion([0, Math.PI, 0]), 0);
  motion.quaternions.set(axisAngleToQuaternion([0.2, -1, 0.4]), 96 + 5 * 4);
  return motion;
}

describe('motion-binary', () => {
  it('stores only joints that move: 12 bytes of root and 6 per joint and frame', () => {
    const bytes = encodeMotion(twoFrames());
    const header = JSON.stringify({ version: 1, fps: 30, frames: 2, joints: [0, 5] });
    expect(bytes.length).toBe(8 + Math.ceil(header.length / 4) * 4 + 2 * (12 + 2 * 6));
    expect(new TextDecoder().decode(bytes.subarray(0, 4))).toBe('PBM2');
    expect(new TextDecoder().decode(bytes.subarray(8, 8 + header.length))).toBe(header);
  });
  it('keeps the root bit for bit', () => {
    const motion = twoFrames();
    expect(decodeMotion(encodeMotion(motion)).root).toEqual(motion.root);
  });
  it('reads from a view into a larger buffer', () => {
    const bytes = encodeMotion(twoFrames());
    const larger = new Uint8Array(bytes.length + 7);
    larger.set(bytes, 3);
    expect(decodeMotion(larger.subarray(3, 3 + bytes.length))).toEqual(decodeMotion(bytes));
  });
  it('refuses what is cut off, foreign or newer', () => {
    const bytes = encodeMotion(twoFrames());
    expect(() => decodeMotion(bytes.subarray(0, bytes.length - 1))).toThrow('cut off');
    expect(() => decodeMotion(new TextEncoder().encode('RIFF....WAVE'))).toThrow('no dance file');
    const newer = bytes.slice();
    newer.set(new TextEncoder().encode('{"version":2'), 8);
    expect(() => decodeMotion(newer)).toThrow('another Posebeat');
  });
  it('refuses to write what it could not read back', () => {
    const broken = twoFrames();
    broken.root[2] = NaN;
    expect(() => encodeMotion(broken)).toThrow('not finite');
    expect(() => encodeMotion({ ...twoFrames(), frames: 3 })).toThrow('3 frames');
  });
});
