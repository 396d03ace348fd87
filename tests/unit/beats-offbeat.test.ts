import { describe, expect, it } from 'vitest';
import { isBetweenBeats } from '../../web/core/beats-offbeat';
import { analyse } from '../../web/core/features';
import { synthesise } from '../e2e/support/songs';

describe('isBetweenBeats', () => {
  const rate = 60;
  const positions = Array.from({ length: 16 }, (_, i) => 30 * i);
  const bass = (offset: number) => Float32Array.from({ length: 480 }, (_, i) => (i % 30 === offset ? 1 : 0.01));
  it('is false where the bass is on the beats', () => expect(isBetweenBeats(bass(0), positions, rate)).toBe(false));
  it('is true where all the bass lies halfway', () => expect(isBetweenBeats(bass(15), positions, rate)).toBe(true));
  it('is false where the bass is everywhere or nowhere', () => {
    expect(isBetweenBeats(new Float32Array(480).fill(1), positions, rate)).toBe(false);
    expect(isBetweenBeats(new Float32Array(480), positions, rate)).toBe(false);
  });
});

// Noise between the beats is the stronger onset of this song: once its beats were found there, or twice as many of them.
it.each([100, 110, 120, 128, 140])('kick on the beat and loud hats between: beats at the kick, %i BPM', (tempo) => {
  const { grid } = analyse(synthesise({ seconds: 12, tempo }), 44100);
  expect(Math.abs(grid.tempo - tempo)).toBeLessThan(1.5);
  for (const beat of grid.beats.slice(1, -1)) {
    const count = (beat * tempo) / 60;
    expect((Math.abs(count - Math.round(count)) * 60) / tempo).toBeLessThan(0.05);
  }
  for (const bar of grid.downbeats.slice(1, -1)) expect(Math.round((bar * tempo) / 60) % 4).toBe(0);
});
