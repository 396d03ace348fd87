/** Arrow keys in a grid of tiles that may have headings between its rows. */

/** A tile's place on the page. */
export interface Place {
  left: number;
  top: number;
}

/**
 * Where an arrow key goes.
 * @param places of all tiles, in reading order
 * @returns index of the tile; `now` where there is none that way; -1 for another key
 */
export function nextTile(places: readonly Place[], now: number, key: string): number {
  const last = places.length - 1;
  if (key === 'Home') return 0;
  if (key === 'End') return last;
  if (key === 'ArrowLeft') return Math.max(0, now - 1);
  if (key === 'ArrowRight') return Math.min(last, now + 1);
  if (key !== 'ArrowUp' && key !== 'ArrowDown') return -1;
  const here = places[now];
  const down = key === 'ArrowDown';
  // The nearest row that way, then the nearest tile of it.
  const beyond = places.map(({ top }) => (down ? top - here.top : here.top - top));
  const row = Math.min(...beyond.filter((distance) => distance > 1));
  if (!Number.isFinite(row)) return now;
  let best = now;
  let nearest = Infinity;
  places.forEach(({ left }, i) => {
    if (Math.abs(beyond[i] - row) > 1 || Math.abs(left - here.left) >= nearest) return;
    nearest = Math.abs(left - here.left);
    best = i;
  });
  return best;
}
