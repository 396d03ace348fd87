/**
 * How smoothly the timeline of a long song pans and zooms: a 10-minute song with 400 key poses, scripted wheel events, one a frame.
 * The stage is measured on and off: drawing it in software takes the cores that the timeline needs.
 */
import { chromium, type CDPSession, type Page } from '@playwright/test';
import { CHROMIUM_FLAGS, installedChromium } from '../chromium.mjs';

/** Length of the song, seconds. */
export const MINUTES = 10;
/** Key poses on it. */
export const KEYS = 400;
/** Frames of each scripted move. */
const STEPS = 240;

/** One scripted move. All times in milliseconds. */
export interface TimelineFigures {
  move: 'pan' | 'zoom';
  stage: boolean;
  /** Time from one frame to the next. */
  frame: { median: number; p95: number; longest: number };
  /** Script of the page per step: handling the event, rendering and painting the canvas. */
  script: { median: number; p95: number; longest: number };
  /** Everything of the main thread per step, in processor time: script, style, layout, paint records. */
  mainThread: number;
}

/** Measures pan and zoom of the built page at an address. */
export async function benchTimeline(
  origin: string,
  wavPath: string,
  stages: readonly boolean[] = [false, true],
): Promise<TimelineFigures[]> {
  const figures: TimelineFigures[] = [];
  for (const stage of stages) {
    const browser = await chromium.launch({
      executablePath: installedChromium(),
      args: [...CHROMIUM_FLAGS, stage ? '--enable-unsafe-swiftshader' : '--disable-3d-apis'],
    });
    try {
      const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
      await prepare(page, origin, wavPath);
      const client = await page.context().newCDPSession(page);
      // Counted in processor time of the thread, so that what else runs on the machine does not count.
      await client.send('Performance.enable', { timeDomain: 'threadTicks' });
      for (const move of ['pan', 'zoom'] as const)
        figures.push({ move, stage, ...(await measure(page, client, move)) });
    } finally {
      await browser.close();
    }
  }
  return figures;
}

/** Opens the page with the song and its key poses, and waits until it has nothing else to do. */
async function prepare(page: Page, origin: string, wavPath: string): Promise<void> {
  page.setDefaultTimeout(600_000);
  await page.goto(origin);
  await page.evaluate(() => window.posebeat.ready);
  // The TypeScript runner names functions through a helper that the page does not have.
  await page.evaluate('globalThis.__name = (value) => value');
  await page.evaluate(() => {
    document.body.append(Object.assign(document.createElement('input'), { type: 'file', id: 'bench' }));
  });
  await page.locator('#bench').setInputFiles(wavPath);
  await page.evaluate(async (count) => {
    const { duration } = await window.posebeat.loadSong(document.querySelector<HTMLInputElement>('#bench')!.files![0]);
    const keys = Array.from({ length: count }, (_, i) => {
      const rotations = new Array<number>(72).fill(0);
      rotations[16 * 3 + 2] = Math.sin(i) * 1.1;
      rotations[17 * 3 + 2] = Math.cos(i) * 1.1;
      return { time: ((i + 0.5) * (duration - 1)) / count, rotations };
    });
    window.posebeat.setKeyPoses(keys);
    document.querySelector('#bench')!.remove();
  }, KEYS);
  await page.waitForTimeout(4000);
}

async function measure(page: Page, client: CDPSession, move: 'pan' | 'zoom') {
  const taskTime = async () => {
    const { metrics } = await client.send('Performance.getMetrics');
    return metrics.find(({ name }) => name === 'TaskDuration')!.value * 1000;
  };
  // Pan at 24 s in sight, through the song and back; zoom from the whole song to bars and back.
  await page.evaluate(async () => {
    const surface = document.querySelector<HTMLElement>('.timeline-surface')!;
    const wheel = (options: WheelEventInit) =>
      surface.dispatchEvent(new WheelEvent('wheel', { bubbles: true, cancelable: true, clientX: 700, ...options }));
    for (let i = 0; i < 30; i += 1) wheel({ deltaY: 400, ctrlKey: true });
    await new Promise(requestAnimationFrame);
  });
  if (move === 'pan') {
    await page.evaluate(() => {
      const surface = document.querySelector<HTMLElement>('.timeline-surface')!;
      for (let i = 0; i < 11; i += 1)
        surface.dispatchEvent(
          new WheelEvent('wheel', { bubbles: true, cancelable: true, clientX: 700, deltaY: -100, ctrlKey: true }),
        );
      for (let i = 0; i < 20; i += 1)
        surface.dispatchEvent(
          new WheelEvent('wheel', { bubbles: true, cancelable: true, clientX: 700, deltaX: -20000 }),
        );
    });
  }
  await page.waitForTimeout(2500);
  const before = await taskTime();
  const { frames, scripts } = await page.evaluate(
    async ({ move, steps }) => {
      const surface = document.querySelector<HTMLElement>('.timeline-surface')!;
      const frames: number[] = [];
      const scripts: number[] = [];
      let last = await new Promise<number>(requestAnimationFrame);
      for (let i = 0; i < steps; i += 1) {
        const turn = i < steps / 2 ? 1 : -1;
        const options = move === 'pan' ? { deltaX: turn * 120 } : { deltaY: turn * -12, ctrlKey: true };
        const begun = performance.now();
        surface.dispatchEvent(new WheelEvent('wheel', { bubbles: true, cancelable: true, clientX: 700, ...options }));
        // Effects and rendering run in microtasks that follow the event.
        for (let turnOfQueue = 0; turnOfQueue < 8; turnOfQueue += 1) await Promise.resolve();
        scripts.push(performance.now() - begun);
        const now = await new Promise<number>(requestAnimationFrame);
        frames.push(now - last);
        last = now;
      }
      return { frames, scripts };
    },
    { move, steps: STEPS },
  );
  const mainThread = ((await taskTime()) - before) / STEPS;
  return { frame: spread(frames), script: spread(scripts), mainThread };
}

function spread(values: number[]): { median: number; p95: number; longest: number } {
  const sorted = [...values].sort((a, b) => a - b);
  return {
    median: sorted[Math.floor(sorted.length / 2)],
    p95: sorted[Math.floor(sorted.length * 0.95)],
    longest: sorted[sorted.length - 1],
  };
}

/** Rows of a table: what, figure, beside it. */
export function timelineRows(figures: readonly TimelineFigures[]): [string, string, string][] {
  const ms = (value: number) => `${value.toFixed(1)} ms`;
  return figures.map(({ move, stage, frame, script, mainThread }) => [
    `Timeline, ${MINUTES} minutes, ${KEYS} key poses: ${move}, stage ${stage ? 'drawn in software' : 'off'}`,
    `frame ${ms(frame.median)}, p95 ${ms(frame.p95)}, longest ${ms(frame.longest)}`,
    `script per step ${ms(script.median)}, p95 ${ms(script.p95)}; main thread ${ms(mainThread)} of processor time`,
  ]);
}
