/** Which part of the dance is saved, in files and in videos. */
export type Part = 'all' | 'trim' | 'loop';

/** What each part is called. */
export const PARTS: Readonly<Record<Part, string>> = {
  all: 'Whole dance',
  trim: 'Trimmed part',
  loop: 'Selected stretch',
};

/**
 * The parts that there are, and the one to save: the wished one where there is one, else the trimmed part, else all.
 *
 * @param there - Whether a part is there now.
 */
export function partsNow(wished: Part | null, there: (part: Part) => boolean): { parts: Part[]; part: Part } {
  const parts = (['all', 'trim', 'loop'] as const).filter(there);
  const part = wished && parts.includes(wished) ? wished : parts.includes('trim') ? 'trim' : 'all';
  return { parts, part };
}
