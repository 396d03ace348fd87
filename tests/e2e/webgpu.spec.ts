import { expect, test } from '@playwright/test';
import { loadSong, open } from './support/page';
import { wav } from './support/songs';
import { serveTinyModel } from './support/tiny';

test('WebGPU, when asked for, gives the dance that WASM gives; by itself a software adapter is not taken', async ({
  page,
}) => {
  await serveTinyModel(page);
  await open(page);
  test.skip(
    !(await page.evaluate(async () => Boolean(await navigator.gpu?.requestAdapter()))),
    'no WebGPU adapter here',
  );
  await loadSong(page, wav({ seconds: 4 }));
  const run = (backend?: 'webgpu' | 'wasm') =>
    page.evaluate(async (backend) => {
      const result = await window.posebeat.generate({ backend, seed: 2 });
      return { backend: result.backend, rotations: [...window.posebeat.motion().rotations] };
    }, backend);
  expect((await run()).backend).toBe('wasm');
  const wasm = await run('wasm');
  const webgpu = await run('webgpu');
  expect(webgpu.backend).toBe('webgpu');
  const apart = Math.max(...wasm.rotations.map((angle, i) => Math.abs(angle - webgpu.rotations[i])));
  expect(apart).toBeLessThan(1e-3);
});
