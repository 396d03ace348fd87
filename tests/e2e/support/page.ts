import { expect, type Page } from '@playwright/test';

/** Errors that the page prints or throws while a test runs; a test that expects none checks that this stays empty. */
export function collectErrors(page: Page): string[] {
  const errors: string[] = [];
  page.on('pageerror', (error) => errors.push(`${error.name}: ${error.message}`));
  page.on('console', (message) => {
    // Without a graphics processor the page says so once and goes on.
    if (message.type() === 'error' && !/WebGL/.test(message.text())) errors.push(message.text());
  });
  return errors;
}

/** Edges that are not smoothed halve the time of a frame that the processor draws. */
async function withoutSmoothing(page: Page): Promise<void> {
  await page.addInitScript(() => {
    const prototype = HTMLCanvasElement.prototype as { getContext: (kind: string, options?: object) => unknown };
    const { getContext } = prototype;
    prototype.getContext = function (kind, options) {
      return getContext.call(this, kind, /^webgl/.test(kind) ? { ...options, antialias: false } : options);
    };
  });
}

/** The walk-through of a first visit comes a moment after the page, between the pointer and what a test aims at. */
async function withoutTour(page: Page): Promise<void> {
  await page.addInitScript(() => {
    try {
      localStorage.setItem('posebeat.tour', 'seen');
    } catch {
      // Where nothing is kept it comes.
    }
  });
}

/** A model that comes ahead of its use would take the two cores from what is tested: the page is told to save data. */
async function withoutFetchingAhead(page: Page): Promise<void> {
  await page.addInitScript(() =>
    Object.defineProperty(navigator, 'connection', { value: { saveData: true }, configurable: true }),
  );
}

/**
 * Opens the page and waits until its API is ready; `smooth` where pictures are to be looked at, `tour` as for a first visit, `ahead` where
 * the page may fetch what will probably be wanted.
 */
export async function open(
  page: Page,
  query = '',
  { smooth = false, tour = false, ahead = false } = {},
): Promise<void> {
  if (!smooth) await withoutSmoothing(page);
  if (!tour) await withoutTour(page);
  if (!ahead) await withoutFetchingAhead(page);
  await page.goto(`./${query}`);
  await page.waitForFunction(() => 'posebeat' in window);
  await page.evaluate(() => window.posebeat.ready);
}

/** Reloads the page and waits until its API is ready again. */
export async function reload(page: Page): Promise<void> {
  await page.reload();
  await page.waitForFunction(() => 'posebeat' in window);
  await page.evaluate(() => window.posebeat.ready);
}

/** What this browser does not keep yet of the page's work, in words; empty when all of it is kept. */
const missing = (page: Page, dance: boolean) =>
  page.evaluate(async (dance) => {
    // Opening a database that is not there would make an empty one.
    if (!(await indexedDB.databases()).some(({ name }) => name === 'posebeat')) return 'the database';
    const answer = <T>(request: IDBRequest<T>) =>
      new Promise<T>((resolve, reject) => {
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => reject(request.error!);
      });
    const database = await answer(indexedDB.open('posebeat'));
    try {
      const read = (table: string, key: string) =>
        answer(database.transaction(table).objectStore(table).get(key)) as Promise<unknown>;
      const document = window.posebeat.document();
      if (JSON.stringify(await read('work', 'document')) !== JSON.stringify(document)) return 'the document';
      // The demo's song comes with the page.
      const demo = window.document.querySelector('.song-title')?.textContent.includes('(demo)');
      if (document.song && !demo && !(await read('songs', document.song.hash))) return 'the song';
      const motion = dance ? window.posebeat.motion() : null;
      if (!motion) return '';
      const kept = (await read('work', 'dance')) as { motion: { root: Float32Array } } | undefined;
      return kept?.motion.root.every((metres, i) => metres === motion.root[i]) ? '' : 'the dance';
    } finally {
      database.close();
    }
  }, dance);

/** Waits until document and song, and with `dance` the dance on stage, are kept for the next visit. */
export async function saved(page: Page, { dance = false } = {}): Promise<void> {
  await expect.poll(() => missing(page, dance), { message: 'what is not kept yet' }).toBe('');
}

/** Loads a song through the public API; bytes travel as base64. */
export async function loadSong(page: Page, bytes: Buffer, name = 'song.wav', type = 'audio/wav') {
  return page.evaluate(
    async ({ base64, name, type }) => {
      const binary = atob(base64);
      const array = Uint8Array.from(binary, (character) => character.charCodeAt(0));
      return window.posebeat.loadSong(new File([array], name, { type }));
    },
    { base64: bytes.toString('base64'), name, type },
  );
}

/** The message of the error that a call of the page's API is rejected with; fails when it is not rejected. */
export async function rejection(call: Promise<unknown>): Promise<string> {
  let message = '';
  await call.then(
    () => expect(true, 'the call should have been rejected').toBe(false),
    (error: Error) => (message = error.message),
  );
  return message;
}

/** Four clearly different poses, 24 x 3 axis-angle, in plain radians: arms up, lunge, twist, arms out and bent knees. */
export function fourPoses(): number[][] {
  const pose = (turns: Record<number, [number, number, number]>): number[] => {
    const rotations = new Array<number>(72).fill(0);
    for (const [joint, turn] of Object.entries(turns))
      turn.forEach((angle, axis) => (rotations[Number(joint) * 3 + axis] = angle));
    return rotations;
  };
  return [
    pose({ 16: [0, 0, 1.1], 17: [0, 0, -1.1], 3: [0, 0, 0.1] }),
    pose({ 1: [-0.9, 0, 0.1], 4: [1.1, 0, 0], 2: [0.3, 0, -0.1], 5: [0.2, 0, 0], 16: [0, 0, -0.9], 17: [0, 0, 0.9] }),
    pose({ 0: [0, 0.5, 0], 3: [0, 0.3, 0], 6: [0, 0.3, 0], 16: [0, -0.6, -0.6], 17: [0, -0.4, 0.9], 19: [0, 0.9, 0] }),
    pose({
      1: [-0.5, 0, 0.25],
      2: [-0.5, 0, -0.25],
      4: [0.9, 0, 0],
      5: [0.9, 0, 0],
      16: [0, 0, -0.2],
      17: [0, 0, 0.2],
    }),
  ];
}

/** Lets a file fall on the page. */
export async function dropFile(page: Page, bytes: Uint8Array, name: string): Promise<void> {
  const files = await page.evaluateHandle(
    ({ base64, name }) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (character) => character.charCodeAt(0))], name));
      return transfer;
    },
    { base64: Buffer.from(bytes).toString('base64'), name },
  );
  await page.dispatchEvent('body', 'drop', { dataTransfer: files });
  await files.dispose();
}
