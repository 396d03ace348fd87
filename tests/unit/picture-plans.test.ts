import { describe, expect, it } from 'vitest';
import { loopPlan, LOOP_FPS } from '../../web/video/loop-plan';
import { stripRows } from '../../web/video/strips';
import { columnsOf, MOST_POSES, SHEET, sheetLayout } from '../../web/video/sheet-layout';

const bars = (seconds: number, count: number) => {
  const downbeats = Array.from({ length: count }, (_, i) => 0.5 + i * seconds);
  return { tempo: 240 / seconds, beatsPerBar: 4 as const, beats: downbeats, downbeats };
};

describe('contact sheet', () => {
  for (const count of [1, 2, 3, 4, 5, 7, 8, 12, 16, 23, 40, 77, MOST_POSES])
    it(`${count} poses are on the page, apart, in reading order`, () => {
      const { width, height, cells, columns, figure, text } = sheetLayout(count);
      expect(cells).toHaveLength(count);
      expect(height).toBeLessThan(4200);
      cells.forEach((cell, i) => {
        expect(cell.x).toBeGreaterThanOrEqual(SHEET.margin - 0.01);
        expect(cell.x + cell.width).toBeLessThanOrEqual(width - SHEET.margin + 0.01);
        expect(cell.y).toBeGreaterThanOrEqual(SHEET.head);
        expect(cell.y + cell.height).toBeLessThanOrEqual(height - SHEET.foot + 0.01);
        // The figure and both lines have room.
        expect(cell.height).toBeGreaterThan(figure + text.name + text.when);
        if (i % columns > 0) expect(cell.x - cells[i - 1].x - cell.width).toBeCloseTo(SHEET.gap, 6);
        if (i >= columns) expect(cell.y - cells[i - columns].y - cell.height).toBeCloseTo(SHEET.gap, 6);
      });
    });

  it('leaves few empty places', () => {
    for (let count = 1; count <= MOST_POSES; count++) {
      const columns = columnsOf(count);
      expect(Math.ceil(count / columns) * columns - count).toBeLessThanOrEqual(Math.max(1, columns * 0.75));
    }
  });
});

describe('strips of a still', () => {
  it.each([
    [320, 180, 1],
    [1920, 1080, 8],
    [3840, 2160, 32],
    [1214, 2160, 11],
    [7, 8_000_000, 214],
  ])('%i x %i pixels come in %i strips of the same height, that of pairs of rows', (width, height, count) => {
    const rows = stripRows(width, height);
    expect(Math.ceil(height / rows)).toBe(count);
    expect(rows % 2).toBe(0);
    expect(rows * width).toBeLessThanOrEqual(2 ** 18 + 2 * width);
  });
});

describe('moving preview', () => {
  const within = { start: 0, end: 60 };
  const seconds = (plan: { frames: number }) => plan.frames / LOOP_FPS;

  it('shows whole bars from the one at hand', () => {
    const plan = loopPlan(11.3, null, bars(2, 29), within);
    expect(plan.start).toBeCloseTo(10.5, 6);
    expect(seconds(plan)).toBeCloseTo(2, 1);
    expect(seconds(loopPlan(11.3, null, bars(1.2, 48), within))).toBeCloseTo(2.4, 1);
  });

  it('keeps inside the song at its end, and without bars', () => {
    const last = loopPlan(59, null, bars(2, 30), within);
    expect(last.start + seconds(last)).toBeLessThan(60);
    const without = loopPlan(59, null, null, within);
    expect([without.start, seconds(without)]).toEqual([57, 3]);
    // Bars of eight seconds are too long to go round.
    expect(seconds(loopPlan(20, null, bars(8, 7), within))).toBe(3);
    expect(seconds(loopPlan(0, null, null, { start: 4, end: 5 }))).toBeCloseTo(1, 1);
  });

  it('takes a short selection as it is and a long one from its start', () => {
    const plan = loopPlan(0, { start: 7, end: 10 }, bars(2, 29), within);
    expect([plan.start, seconds(plan)]).toEqual([7, 3]);
    expect(loopPlan(0, { start: 20.5, end: 40.5 }, bars(2, 29), within).start).toBeCloseTo(20.5, 6);
  });
});
