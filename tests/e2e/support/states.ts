import type { Page } from '@playwright/test';
import { loadSong } from './page';
import { wav } from './songs';

/** A state of the page that a visitor gets to, from the one before it in the list. */
export interface PageState {
  name: string;
  go(page: Page): Promise<void>;
}

const click = (page: Page, name: string | RegExp) => page.getByRole('button', { name }).first().click();
const tab = (page: Page, name: string) => page.getByRole('tab', { name }).click();

/** Walks through the panels of the page; each state is a short step from the one before. */
export const STATES: readonly PageState[] = [
  { name: 'opening page', go: async () => undefined },
  {
    name: 'help',
    go: async (page) => {
      await page.keyboard.press('?');
      await page.getByRole('dialog').waitFor();
    },
  },
  {
    name: 'first steps',
    go: async (page) => {
      await page.keyboard.press('Escape');
      await page.keyboard.press('h');
      await page.locator('.tour').waitFor();
    },
  },
  {
    name: 'project menu',
    go: async (page) => {
      await page.keyboard.press('Escape');
      await page.getByRole('button', { name: 'Save the project' }).click();
    },
  },
  {
    name: 'song loaded, library',
    go: async (page) => {
      await page.keyboard.press('Escape');
      await loadSong(page, wav({ seconds: 12 }), 'A song with rather a long name that must not push anything away.wav');
      await page.locator('.pose-tile').first().waitFor();
    },
  },
  {
    name: 'key poses, one selected',
    go: async (page) => {
      await page.evaluate(() => {
        const rotations = (turn: number) => Array.from({ length: 72 }, (_, i) => (i % 7 === 0 ? turn : 0));
        window.posebeat.setKeyPoses(
          [1, 2, 3, 5, 5.5].map((time) => ({ time, rotations: rotations(time / 9), name: `Pose at ${time}` })),
        );
      });
      await page.locator('.key-pose').first().focus();
    },
  },
  {
    name: 'several key poses, a loop',
    go: async (page) => {
      await page.keyboard.press('Control+a');
      await page.keyboard.press('l');
    },
  },
  { name: 'beats menu', go: (page) => page.getByRole('button', { name: 'Beats' }).click() },
  {
    name: 'dance panel',
    go: async (page) => {
      await page.keyboard.press('Escape');
      await tab(page, 'Dance');
    },
  },
  {
    name: 'report, curves',
    go: async (page) => {
      await tab(page, 'Report');
      await page.keyboard.press('v');
    },
  },
  {
    name: 'pose editor, rotate',
    go: async (page) => {
      await page.keyboard.press('v');
      await tab(page, 'Poses');
      await click(page, 'New pose');
      await page.getByRole('combobox', { name: 'Joint', exact: true }).selectOption({ label: 'Left elbow' });
      for (const fold of await page.locator('.fold summary').all()) await fold.click();
    },
  },
  {
    name: 'pose editor, move, ghosts and path',
    go: async (page) => {
      await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
      for (const key of ['w', 'o', 'Shift+P']) await page.keyboard.press(key);
    },
  },
  {
    name: 'a message',
    go: async (page) => {
      await page.keyboard.press('Escape');
      await page.evaluate(() => window.posebeat.loadSong(new File(['no sound'], 'broken.mp3')).catch(() => undefined));
    },
  },
];
