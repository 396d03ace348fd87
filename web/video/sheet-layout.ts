/** Where everything is on a contact sheet of key poses. Pure geometry, pixels at scale 1. */
/** A key pose with the words below it. */
export interface SheetPose {
  /** 24 x 3 axis-angle, radians. */
  rotations: readonly number[];
  name: string;
  /** Where it is in the song. */
  when: string;
}

/** Most key poses of one sheet: more would be too small to be read. */
export const MOST_POSES = 120;
/** Width of a sheet, and what is round its grid. */
export const SHEET = { width: 2400, margin: 72, head: 176, foot: 84, gap: 20 } as const;
/** Cells are never wider than this: a sheet of one pose is no poster. */
const WIDEST = 552;

/** A place on the sheet. */
export interface Cell {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The sheet and its cells, in reading order. */
export interface SheetLayout {
  width: number;
  height: number;
  columns: number;
  cells: readonly Cell[];
  /** Edge of the square that a figure is drawn in. */
  figure: number;
  /** Sizes of a cell's two lines. */
  text: { name: number; when: number };
}

/** How many cells stand side by side: rows of about equal length, the sheet about half as high as it is wide. */
export function columnsOf(poses: number): number {
  if (poses <= 4) return Math.max(1, poses);
  const most = Math.min(12, Math.max(4, Math.round(Math.sqrt(poses * 1.9))));
  // The fewest empty places at the end, the more columns the better.
  let best = most;
  for (let columns = most; columns >= Math.max(3, most - 2); columns--) {
    const empty = (count: number) => Math.ceil(poses / count) * count - poses;
    if (empty(columns) < empty(best)) best = columns;
  }
  return best;
}

/** The layout for so many key poses, at most {@link MOST_POSES}. */
export function sheetLayout(poses: number): SheetLayout {
  const columns = columnsOf(poses);
  const { width, margin, head, foot, gap } = SHEET;
  const room = width - 2 * margin - gap * (columns - 1);
  const cell = Math.min(WIDEST, room / columns);
  // The grid stands in the middle where it does not fill the width.
  const left = (width - cell * columns - gap * (columns - 1)) / 2;
  const name = Math.round(Math.min(30, Math.max(17, cell * 0.066)));
  const when = Math.round(name * 0.84);
  const height = Math.round(cell + name + when + cell * 0.12);
  const rows = Math.max(1, Math.ceil(poses / columns));
  return {
    width,
    height: head + rows * height + (rows - 1) * gap + foot,
    columns,
    cells: Array.from({ length: poses }, (_, i) => ({
      x: left + (i % columns) * (cell + gap),
      y: head + Math.floor(i / columns) * (height + gap),
      width: cell,
      height,
    })),
    figure: Math.round(cell),
    text: { name, when },
  };
}
