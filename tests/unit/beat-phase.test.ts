import { describe, expect, it } from 'vitest';
import { beatPhase } from '../../web/core/beat-phase';

describe('the beat count', () => {
  const grid = { tempo: 120, beatsPerBar: 4 as const, beats: [0.2, 0.7, 1.2, 1.8, 2.5], downbeats: [0.7] };
  it('is a whole number on the beats, 0 on the first downbeat', () => {
    const phase = beatPhase(grid);
    grid.beats.forEach((time, i) => {
      expect(phase.at(time)).toBeCloseTo(i - 1, 9);
      expect(phase.time(i - 1)).toBeCloseTo(time, 9);
    });
  });
  it('goes on before the first and after the last beat, and never back', () => {
    const phase = beatPhase(grid);
    expect(phase.at(-0.3)).toBeCloseTo(-2, 9);
    expect(phase.at(3.2)).toBeCloseTo(4, 9);
    let before = -Infinity;
    for (let time = -1; time < 4; time += 0.01) {
      expect(phase.at(time)).toBeGreaterThan(before);
      expect(phase.time(phase.at(time))).toBeCloseTo(time, 5);
      before = phase.at(time);
    }
  });
  it('counts at the tempo without beats', () => {
    const phase = beatPhase({ tempo: 90, beatsPerBar: 3, beats: [], downbeats: [] });
    expect(phase.at(60)).toBeCloseTo(90, 9);
    expect(beatPhase({ tempo: NaN, beatsPerBar: 4, beats: [], downbeats: [] }).at(1)).toBeCloseTo(2, 9);
  });
});
