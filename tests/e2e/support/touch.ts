import type { CDPSession, Page } from '@playwright/test';

/** A place on the page, CSS pixels. */
export interface Point {
  x: number;
  y: number;
}

/** Between two reports of a touch screen, milliseconds. */
const FASTEST = 8;

/** Middle of the first element that a selector finds. */
export async function middleOf(page: Page, selector: string, index = 0): Promise<Point> {
  const box = await page.locator(selector).nth(index).boundingBox();
  if (!box) throw new Error(`"${selector}" is not on the page.`);
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

/** Fingers, as the browser's own input pipeline sees them: they scroll, pan and zoom what the page lets them. */
export class Fingers {
  private constructor(
    private readonly page: Page,
    private readonly session: CDPSession,
  ) {}

  static async of(page: Page): Promise<Fingers> {
    return new Fingers(page, await page.context().newCDPSession(page));
  }

  /** Presses, moves through points and lifts; every list is one finger's way, all of the same length. Times in milliseconds. */
  async drag(ways: Point[][], { hold = 0, pause = 16 } = {}): Promise<void> {
    const at = (step: number) => ways.map((way, id) => ({ ...way[step], id }));
    // Fingers keep their own time: on a busy page a swipe is handled late, but it was no slower. So nothing waits for an answer.
    let time = Date.now();
    const sent = [this.send('touchStart', at(0), time)];
    if (hold > 0) await this.page.waitForTimeout(hold);
    time += hold;
    for (let step = 1; step < ways[0].length; step++) {
      time += Math.max(pause, FASTEST);
      sent.push(this.send('touchMove', at(step), time));
      await this.page.waitForTimeout(pause);
    }
    sent.push(this.send('touchEnd', [], time));
    await Promise.all(sent);
  }

  private async send(
    type: 'touchStart' | 'touchMove' | 'touchEnd',
    touchPoints: (Point & { id: number })[],
    time: number,
  ) {
    await this.session.send('Input.dispatchTouchEvent', { type, touchPoints, timestamp: time / 1000 });
  }
}

/** A straight way in equal steps, both ends included. */
export function way(from: Point, to: Point, steps = 12): Point[] {
  return Array.from({ length: steps + 1 }, (_, i) => ({
    x: from.x + ((to.x - from.x) * i) / steps,
    y: from.y + ((to.y - from.y) * i) / steps,
  }));
}
