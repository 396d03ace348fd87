import { describe, expect, it } from 'vitest';
import { placeCard } from '../../web/ui/tour/place';

const box = (left: number, top: number, width: number, height: number) => ({ left, top, width, height });
const stage = box(0, 48, 1120, 500);
const card = box(0, 0, 296, 120);
const inside = ({ left, top }: { left: number; top: number }) =>
  left >= 0 && top >= 48 && left + card.width <= 1120 && top + card.height <= 548;
const free = ({ left, top }: { left: number; top: number }, other: ReturnType<typeof box>) =>
  left + card.width <= other.left ||
  left >= other.left + other.width ||
  top + card.height <= other.top ||
  top >= other.top + other.height;

describe('the card of a step', () => {
  it.each([
    ['beside the list of poses', box(1130, 200, 280, 300), 'right'],
    ['above the Generate button', box(1280, 560, 136, 44), 'bottom'],
    ['above the Play button', box(60, 560, 44, 44), 'bottom'],
    ['under the top bar', box(1050, 4, 100, 36), 'top'],
    ['right of the drop target', box(32, 430, 340, 84), 'left'],
    ['above a target as wide as the stage', box(12, 480, 1000, 60), 'bottom'],
  ] as const)('is %s, on the stage', (_name, anchor, side) => {
    const place = placeCard(card, anchor, stage, []);
    expect(place.side).toBe(side);
    expect(inside(place)).toBe(true);
    expect(free(place, anchor)).toBe(true);
  });

  it('goes above a block that wants it so, where there is room', () => {
    const [low, high] = [box(30, 320, 340, 220), box(30, 120, 340, 220)];
    expect(placeCard(card, low, stage, [], true)).toEqual({ left: 30, top: 188, side: 'bottom', along: 170 });
    expect(placeCard(card, high, stage, [], true).side).toBe('left');
  });

  it('leaves the controls of the stage free', () => {
    const tools = box(900, 490, 210, 44);
    const chip = box(940, 64, 160, 44);
    const place = placeCard(card, box(1280, 560, 136, 44), stage, [tools, chip]);
    expect(free(place, tools)).toBe(true);
    expect(free(place, chip)).toBe(true);
    expect(inside(place)).toBe(true);
  });

  it('leaves the welcome free where getting out of the way of one part would cover another', () => {
    const high = box(0, 50, 1120, 544);
    const parts = [box(32, 318, 340, 68), box(32, 462, 340, 98)];
    const place = placeCard(box(0, 0, 296, 144), box(60, 598, 44, 44), high, parts);
    expect(place.top).toBe(162);
    expect(place.top + 144).toBeLessThan(parts[0].top);
  });
});
