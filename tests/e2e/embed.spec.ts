import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { expect, test, type Page } from '@playwright/test';

/** The page around comes from a server of its own: another port is another origin. */
let html = '';
const server = createServer((_, response) => response.setHeader('Content-Type', 'text/html').end(html));
let HOST = '';
test.beforeAll(async () => {
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  HOST = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
});
test.afterAll(() => server.close());

interface Answer {
  posebeat: 1;
  id?: unknown;
  event?: string;
  result?: unknown;
  error?: string;
}

/** A page of another origin with a frame in it, and a way to ask the frame. */
async function host(page: Page, frame: string): Promise<(message: object) => Promise<Answer>> {
  html = `<!doctype html><title>Host</title><iframe src="${frame}" width="480" height="640" allow="autoplay; cross-origin-isolated"></iframe>
    <script>
      window.heard = [];
      addEventListener('message', ({ data, origin }) => heard.push({ ...data, origin }));
      window.ask = (message) => document.querySelector('iframe').contentWindow.postMessage(message, '*');
    </script>`;
  await page.goto(`${HOST}/`);
  return async (message) => {
    await page.evaluate((message) => (window as unknown as { ask(message: object): void }).ask(message), message);
    const found = await page.waitForFunction(
      (id) => (window as unknown as { heard: Answer[] }).heard.find((each) => each.id === id),
      (message as { id: unknown }).id,
    );
    return (await found.jsonValue()) as Answer;
  };
}

const heard = (page: Page) =>
  page.evaluate(() => (window as unknown as { heard: (Answer & { origin: string })[] }).heard);

test('a frame shows figure and transport, keeps nothing, and is driven by messages', async ({ page, baseURL }) => {
  const ask = await host(page, `${baseURL}?embed=1&origin=${encodeURIComponent(HOST)}`);
  await expect.poll(async () => (await heard(page)).map(({ event }) => event)).toEqual(['ready']);
  expect((await heard(page))[0].origin).toBe(new URL(baseURL!).origin);

  const frame = page.frameLocator('iframe');
  await expect(frame.getByRole('button', { name: 'Pause' })).toBeVisible();
  await expect(frame.locator('.top-bar, .timeline, .inspector, .tour')).toHaveCount(0);
  await expect(frame.getByRole('button', { name: 'Generate' })).toBeHidden();

  expect((await ask({ posebeat: 1, id: 1, method: 'document' })).result).toMatchObject({ format: 'posebeat' });
  const rotations = new Array<number>(72).fill(0.1);
  expect(
    await ask({ posebeat: 1, id: 2, method: 'setKeyPoses', arguments: [[{ time: 3, rotations }]] }),
  ).not.toHaveProperty('error');
  const { result } = await ask({ posebeat: 1, id: 3, method: 'document' });
  expect((result as { keyPoses: { time: number }[] }).keyPoses.map(({ time }) => time)).toEqual([3]);
  expect((await ask({ posebeat: 1, id: 4, method: 'shareLink' })).result).toMatch(/\/#d=1\./);
  expect((await ask({ posebeat: 1, id: 5, method: 'format' })).error).toMatch(
    /^There is no method “format”: use one of .*generate/,
  );
  expect((await ask({ posebeat: 1, id: 6, method: 'setKeyPoses', arguments: [5] })).error).toMatch(
    /^Key poses must be a list/,
  );

  // Longer than autosave waits.
  await page.waitForTimeout(1200);
  const inside = page.frames().find((each) => each.url().includes('embed=1'))!;
  const kept = await inside.evaluate(async () => ({
    databases: (await indexedDB.databases()).map(({ name }) => name),
    items: Object.keys(localStorage),
  }));
  expect(kept.databases).not.toContain('posebeat');
  expect(kept.items).toEqual([]);
});

test('a frame for another origin is silent', async ({ page, baseURL }) => {
  await host(page, `${baseURL}?embed=1&origin=https://example.org`);
  const frame = page.frameLocator('iframe');
  await expect(frame.getByRole('button', { name: 'Pause' })).toBeVisible();
  await page.evaluate(() =>
    (window as unknown as { ask(message: object): void }).ask({ posebeat: 1, id: 1, method: 'document' }),
  );
  await page.waitForTimeout(1000);
  expect(await heard(page)).toEqual([]);
});
