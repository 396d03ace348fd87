import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from '@playwright/test';

const golden = (name: string) => readFileSync(join(import.meta.dirname, '..', '..', 'golden', name));

/** Puts the tiny model of the golden tests in the place of the shipped one: a software WebGPU adapter can run it in time. */
export async function serveTinyModel(page: Page): Promise<void> {
  const weights = golden('tiny.onnx');
  const header = JSON.parse(golden('tiny.json').toString()) as { specHash: string };
  const manifest = {
    name: 'tiny',
    file: 'tiny.onnx',
    bytes: weights.length,
    sha256: createHash('sha256').update(weights).digest('hex'),
    specHash: header.specHash,
    precision: 'fp32',
  };
  const files: [string, Buffer, string][] = [
    ['**/models/manifest.json', Buffer.from(JSON.stringify(manifest)), 'application/json'],
    ['**/models/golden.json', Buffer.from(JSON.stringify(header)), 'application/json'],
    ['**/models/golden.bin', golden('tiny.bin'), 'application/octet-stream'],
    ['**/models/tiny.onnx*', weights, 'application/octet-stream'],
  ];
  for (const [pattern, body, contentType] of files) {
    await page.route(pattern, (route) => route.fulfill({ body, contentType }));
  }
}
