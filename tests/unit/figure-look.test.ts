import { describe, expect, it } from 'vitest';
import { createDocument } from '../../web/core/document';
import { parseDocument } from '../../web/core/document-read';
import { FIGURE_COLOURS, FIGURE_STYLES, lookByte, lookOfByte } from '../../web/core/figure-look';
import { mannequin } from '../../web/scene/mannequin';
import { SKIN_BONES } from '../../web/scene/skin-bones';

type Triple = [number, number, number];
const linear = (hex: string): Triple =>
  [1, 3, 5].map((at) => {
    const value = parseInt(hex.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  }) as Triple;
/** Colour blindness of full strength in linear RGB (Machado, Oliveira and Fernandes 2009, table 1). */
const EYES: Record<string, number[]> = {
  usual: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  protanopia: [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
  deuteranopia: [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881],
  tritanopia: [1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039],
};
/** OKLab (Ottosson 2020). */
function oklab([r, g, b]: Triple): Triple {
  const l = Math.cbrt(Math.max(0, 0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b));
  const m = Math.cbrt(Math.max(0, 0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b));
  const s = Math.cbrt(Math.max(0, 0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b));
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}
const seen = (hex: string, eye: number[]): Triple => {
  const [r, g, b] = linear(hex);
  return oklab([0, 3, 6].map((i) => eye[i] * r + eye[i + 1] * g + eye[i + 2] * b) as Triple);
};

describe('colours of the figure', () => {
  for (const { name, left, right } of FIGURE_COLOURS)
    for (const [eyes, matrix] of Object.entries(EYES))
      it(`${name}: left and right differ to ${eyes} eyes`, () => {
        const [a, b] = [seen(left, matrix), seen(right, matrix)];
        expect(Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])).toBeGreaterThan(0.12);
      });
});

describe('look', () => {
  it('is one byte and back', () => {
    for (const style of FIGURE_STYLES)
      for (const { id } of FIGURE_COLOURS) {
        const byte = lookByte({ style, colours: id });
        expect(byte).toBeLessThan(256);
        expect(lookOfByte(byte)).toEqual({ style, colours: id });
      }
    expect(lookOfByte(15)).toBeNull();
    expect(lookOfByte(255)).toBeNull();
  });

  it('is read from a file, left out where there is none, and repaired', () => {
    const document = createDocument();
    expect(parseDocument(structuredClone(document))).toEqual({ document, repairs: [] });
    const dressed = { ...document, look: { style: 'neon', colours: 'mono' } };
    expect(parseDocument(structuredClone(dressed))).toEqual({ document: dressed, repairs: [] });
    const broken = parseDocument({ ...document, look: { style: 'velvet', colours: 'sky' } });
    expect(broken.document).toEqual(document);
    expect(broken.repairs).toHaveLength(1);
  });
});

describe('mannequin', () => {
  const { geometry, levels } = mannequin();
  const [positions, normals, bones] = ['position', 'normal', 'skinIndex'].map((name) => geometry.getAttribute(name));

  it('has triangles that face outwards, fewer on coarser levels, all on bones of the skin', () => {
    const index = geometry.index!.array;
    expect(levels.map(({ count }) => count)).toEqual([...levels.map(({ count }) => count)].sort((a, b) => b - a));
    // Fewer than the baked figure's finest level: no frame gets slower by it.
    expect(levels[0].count / 3).toBeLessThan(40_000);
    let wrong = 0;
    for (let i = 0; i < index.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => [0, 1, 2].map((axis) => positions.getComponent(index[i + k], axis)));
      const [p, q] = [b.map((value, k) => value - a[k]), c.map((value, k) => value - a[k])];
      const face = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
      const out = face.reduce((sum, value, k) => sum + value * normals.getComponent(index[i], k), 0);
      if (out < -1e-9) wrong++;
    }
    expect(wrong / (index.length / 3)).toBeLessThan(0.005);
    for (let v = 0; v < bones.count; v++) expect(bones.getX(v)).toBeLessThan(SKIN_BONES.length);
  });

  it('is as tall as the figure, stands on the floor, and is the same on both sides', () => {
    let [low, high, left, right] = [Infinity, -Infinity, 0, 0];
    for (let v = 0; v < positions.count; v++) {
      low = Math.min(low, positions.getY(v));
      high = Math.max(high, positions.getY(v));
      left = Math.max(left, positions.getX(v));
      right = Math.min(right, positions.getX(v));
    }
    expect(low).toBeGreaterThan(-0.012);
    expect(low).toBeLessThan(0.008);
    expect(high).toBeGreaterThan(1.68);
    expect(high).toBeLessThan(1.85);
    expect(left).toBeCloseTo(-right, 6);
  });
});
