import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { FIGURE_BOX, framingDistance, QualityGovernor, Spring } from '../../web/scene/framing';

describe('framing', () => {
  it('holds the whole box in view, on wide screens and on phones, and no further away than needed', () => {
    for (const aspect of [0.42, 0.6, 1, 1.6, 2.4]) {
      const camera = new PerspectiveCamera(30, aspect, 0.1, 100);
      const distance = framingDistance(Math.PI / 6, aspect);
      camera.position.set(0, 1, distance);
      camera.lookAt(0, 1, 0);
      camera.updateMatrixWorld();
      let reach = 0;
      for (const x of [-1, 1])
        for (const y of [-1, 1])
          for (const z of [-1, 1]) {
            const corner = new Vector3(
              (x * FIGURE_BOX.width) / 2,
              1 + (y * FIGURE_BOX.height) / 2,
              (z * FIGURE_BOX.depth) / 2,
            ).project(camera);
            reach = Math.max(reach, Math.abs(corner.x), Math.abs(corner.y));
          }
      expect(reach).toBeLessThanOrEqual(1);
      expect(reach).toBeCloseTo(0.92, 6);
    }
  });
});

describe('follow spring', () => {
  it('arrives without overshoot', () => {
    const spring = new Spring(0, 0.5);
    let last = 0;
    for (let i = 0; i < 240; i++) {
      const value = spring.step(1, 1 / 60);
      expect(value).toBeGreaterThanOrEqual(last);
      expect(value).toBeLessThanOrEqual(1 + 1e-9);
      last = value;
    }
    expect(last).toBeGreaterThan(0.999);
  });

  it('does not depend on the frame rate', () => {
    const [fast, slow] = [new Spring(2, 0.5), new Spring(2, 0.5)];
    for (let i = 0; i < 60; i++) fast.step(5, 1 / 120);
    for (let i = 0; i < 10; i++) slow.step(5, 1 / 20);
    expect(fast.value).toBeCloseTo(slow.value, 9);
  });
});

describe('quality', () => {
  it('stays at its best on a screen of 50, 60 or 120 Hz', () => {
    const governor = new QualityGovernor(2);
    for (const milliseconds of [20, 16.7, 8.3])
      for (let i = 0; i < 300; i++) expect(governor.sample(milliseconds)).toBe(false);
    expect(governor.ratio).toBe(2);
  });

  it('gives up pixels first when frames are a little late', () => {
    const governor = new QualityGovernor(2);
    while (!governor.sample(30));
    expect(governor.ratio).toBeCloseTo(2 * Math.sqrt(18 / 30), 9);
    expect(governor.detail).toBe(0);
  });

  it('gives up pixels and triangles within seconds when drawing crawls, and then leaves it', () => {
    const governor = new QualityGovernor(1);
    let elapsed = 0;
    for (; elapsed < 20_000; elapsed += 400) governor.sample(400);
    expect(governor.ratio).toBe(0.5);
    expect(governor.detail).toBe(1);
    expect(governor.sample(400)).toBe(false);
  });

  it('ignores the gap after the page was in the background, and one hiccup', () => {
    const governor = new QualityGovernor(1);
    for (let i = 0; i < 500; i++) expect(governor.sample(i % 50 === 7 ? 5000 : i % 50 === 9 ? 300 : 16)).toBe(false);
  });
});
