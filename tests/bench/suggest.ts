/** A song of three minutes danced with no key pose of one's own: suggest, then generate. */
import { chromium, type Browser } from '@playwright/test';
import { CHROMIUM_FLAGS, installedChromium } from '../chromium.mjs';

/** Seconds of one run. */
interface Run {
  /** From the press to the first key pose on the timeline. */
  first: number;
  /** From the press to the last one. */
  suggested: number;
  /** From there to the whole dance. */
  danced: number;
}

/** Rows of the table: what, figure, beside it. */
type Row = [string, string, string];

/** How long somebody looks at the page before the press, milliseconds: not at all, and a moment. */
const LOOKS = [0, 4000];

const median = (values: number[]) => values.slice().sort((a, b) => a - b)[Math.floor(values.length / 2)];

async function run(browser: Browser, origin: string, wavPath: string, look: number, engine: string): Promise<Run> {
  // A profile of its own: nothing is in the caches, as on a first visit.
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  try {
    const page = await context.newPage();
    page.setDefaultTimeout(300_000);
    await page.goto(`${origin}?backend=wasm`);
    await page.evaluate(() => window.posebeat.ready);
    // The demo's sound and the model of the dance are on their way while somebody looks for a song.
    await page.waitForTimeout(3000);
    await page.evaluate(() =>
      document.body.append(Object.assign(document.createElement('input'), { type: 'file', id: 'bench' })),
    );
    await page.locator('#bench').setInputFiles(wavPath);
    return await page.evaluate(
      async ({ look, engine }) => {
        const file = document.querySelector<HTMLInputElement>('#bench')!.files![0];
        await window.posebeat.loadSong(file);
        await new Promise((resolve) => setTimeout(resolve, look));
        const pressed = performance.now();
        let first = 0;
        const watch = new MutationObserver(() => {
          if (!first && document.querySelector('.key-pose')) first = performance.now();
        });
        watch.observe(document.querySelector('.timeline')!, { subtree: true, childList: true });
        await window.posebeat.suggestKeyPoses({ density: 'half' });
        const suggested = performance.now();
        watch.disconnect();
        await window.posebeat.generate({ engine: engine as 'light' });
        const danced = performance.now();
        return {
          first: (first - pressed) / 1000,
          suggested: (suggested - pressed) / 1000,
          danced: (danced - suggested) / 1000,
        };
      },
      { look, engine },
    );
  } finally {
    await context.close();
  }
}

/**
 * Measures suggesting and dancing on WASM, page without its 3D stage.
 * @param origin of the built page, with a slash at its end
 * @param wavPath the song
 * @param runs how many of each; medians are told
 */
export async function benchSuggest(origin: string, wavPath: string, runs: number): Promise<Row[]> {
  const browser = await chromium.launch({
    executablePath: installedChromium(),
    args: [...CHROMIUM_FLAGS, '--autoplay-policy=no-user-gesture-required', '--disable-3d-apis'],
  });
  try {
    const rows: Row[] = [];
    for (const [engine, look] of [
      ['light', LOOKS[0]],
      ['light', LOOKS[1]],
      ['curves', LOOKS[1]],
    ] as const) {
      const all: Run[] = [];
      for (let i = 0; i < runs; i++) all.push(await run(browser, origin, wavPath, look, engine));
      const [first, suggested, danced] = (['first', 'suggested', 'danced'] as const).map((part) =>
        median(all.map((each) => each[part])),
      );
      const when = look ? `${look / 1000} s after the song was heard` : 'the moment the song is heard';
      if (engine === 'light')
        rows.push([`From Suggest, pressed ${when}, to its first key pose`, `${first.toFixed(2)} s`, '']);
      if (look)
        rows.push([
          `Suggest key poses for 3 minutes, then dance them ${engine === 'light' ? '' : 'as curves'}`.trim(),
          `${(suggested + danced).toFixed(1)} s`,
          `${suggested.toFixed(1)} s and ${danced.toFixed(1)} s`,
        ]);
    }
    return rows;
  } finally {
    await browser.close();
  }
}
