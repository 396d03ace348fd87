/** Where the card of a step goes: on the stage, beside what it is about, and never over a control. */

/** A rectangle of the page, pixels. */
export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** Where the card is, and which of its sides points at the anchor, how far along. */
export interface Place {
  left: number;
  top: number;
  side: 'left' | 'right' | 'top' | 'bottom';
  /** Pixels from the card's left or top edge to the arrow. */
  along: number;
}

const GAP = 12;
/** The arrow keeps this far from the card's corners, pixels. */
const CORNER = 20;

const clamp = (value: number, low: number, high: number) => Math.min(Math.max(value, low), Math.max(low, high));

/**
 * Places a card.
 *
 * @param card - Its size; left and top are not read.
 * @param anchor - What it is about.
 * @param stage - Where it may be.
 * @param avoid - Controls on the stage that stay free.
 * @param above - Above the anchor where there is room, so that what dances beside it stays in sight.
 */
export function placeCard(card: Box, anchor: Box, stage: Box, avoid: readonly Box[], above = false): Place {
  const middle = { x: anchor.left + anchor.width / 2, y: anchor.top + anchor.height / 2 };
  const right = stage.left + stage.width - GAP - card.width;
  const bottom = stage.top + stage.height - GAP - card.height;
  let left = clamp(middle.x - card.width / 2, stage.left + GAP, right);
  let top = clamp(middle.y - card.height / 2, stage.top + GAP, bottom);
  let side: Place['side'];
  if (anchor.top >= stage.top + stage.height - 1) {
    side = 'bottom';
    top = bottom;
  } else if (anchor.left >= stage.left + stage.width - 1) {
    side = 'right';
    left = right;
  } else if (anchor.top + anchor.height <= stage.top + 1) {
    side = 'top';
    top = stage.top + GAP;
  } else if (above && anchor.top - GAP - card.height >= stage.top + GAP) {
    side = 'bottom';
    left = clamp(anchor.left, stage.left + GAP, right);
    top = anchor.top - GAP - card.height;
  } else if (anchor.left + anchor.width + GAP <= right) {
    side = 'left';
    left = anchor.left + anchor.width + GAP;
  } else {
    side = 'bottom';
    top = Math.max(stage.top + GAP, anchor.top - GAP - card.height);
  }
  // Moving away from one may bring it onto another that was passed already.
  for (const box of [...avoid, ...avoid]) {
    if (!overlap({ left, top, width: card.width, height: card.height }, box)) continue;
    // Upwards from what lies at the stage's foot, downwards from what lies at its head.
    top =
      box.top + box.height / 2 > stage.top + stage.height / 2
        ? Math.max(stage.top + GAP, box.top - GAP - card.height)
        : Math.min(bottom, box.top + box.height + GAP);
  }
  const along =
    side === 'left' || side === 'right'
      ? clamp(middle.y - top, CORNER, card.height - CORNER)
      : clamp(middle.x - left, CORNER, card.width - CORNER);
  return { left, top, side, along };
}

function overlap(a: Box, b: Box): boolean {
  return a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height && b.top < a.top + a.height;
}
