import type { Page } from '@playwright/test';

/**
 * Taps evenly while time goes by, with the key T or the mouse where it is; each tap is stamped with the moment it is meant for, as a
 * keyboard does it, however busy the machine is.
 */
export async function tapAlong(
  page: Page,
  taps: number,
  seconds: number,
  at?: { x: number; y: number },
): Promise<void> {
  const input = await page.context().newCDPSession(page);
  const key = { key: 't', code: 'KeyT', text: 't', windowsVirtualKeyCode: 84 };
  const started = Date.now() / 1000;
  const sent: Promise<unknown>[] = [];
  for (let i = 1; i <= taps; i += 1) {
    const timestamp = started + i * seconds;
    await page.waitForTimeout(Math.max(0, (timestamp - Date.now() / 1000) * 1000));
    if (at) {
      const press = { timestamp, ...at, button: 'left', clickCount: 1 } as const;
      sent.push(input.send('Input.dispatchMouseEvent', { type: 'mousePressed', ...press }));
      sent.push(input.send('Input.dispatchMouseEvent', { type: 'mouseReleased', ...press }));
    } else {
      sent.push(input.send('Input.dispatchKeyEvent', { type: 'keyDown', timestamp, ...key }));
      sent.push(input.send('Input.dispatchKeyEvent', { type: 'keyUp', timestamp, ...key }));
    }
  }
  await Promise.all(sent);
  await input.detach();
}
