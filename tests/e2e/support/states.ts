import type { Page } from '@playwright/test';
import { anonymousGlb } from '../../unit/support/avatar-rigs';
import { bvh } from './bvh';
import { dropFile, fourPoses, loadSong } from './page';
import { wav } from './songs';

/** A state of the page that a visitor gets to, from the one before it in the list. */
export interface PageState {
  name: string;
  go(page: Page): Promise<void>;
  /** The part of the page that is new; without it everything is. */
  scope?: string;
}

const OWN_POSES = 7;

const button = (page: Page, name: string | RegExp) =>
  page.getByRole('button', { name, exact: typeof name === 'string' });
const escape = (page: Page) => page.keyboard.press('Escape');

/** Where the timeline and the panel take turns, brings out the one that is wanted. */
async function reveal(page: Page, selector: string): Promise<void> {
  const wanted = page.locator(selector).first();
  if (!(await wanted.isVisible())) await page.locator('.sheet-handle').click();
  await wanted.waitFor();
}

async function tab(page: Page, name: string): Promise<void> {
  await page.getByRole('tab', { name, exact: true }).click();
  await reveal(page, '#inspector-panel');
}

async function calm(page: Page): Promise<void> {
  await page.locator('.generate.fresh').waitFor({ timeout: 60_000 });
}

/** Nothing lies over the page any more. */
export async function dismissAll(page: Page): Promise<void> {
  const dismiss = page.locator('.notice').getByRole('button', { name: 'Dismiss' });
  while ((await dismiss.count()) > 0) await dismiss.first().click();
}

/** Walks through the panels of the page; each state is a short step from the one before. Needs the tiny model. */
export const STATES: readonly PageState[] = [
  { name: 'opening page', go: async () => undefined },
  {
    name: 'help',
    scope: '.help',
    go: async (page) => {
      await page.keyboard.press('?');
      await page.getByRole('dialog').waitFor();
    },
  },
  {
    name: 'help, nothing found',
    scope: '.help',
    go: async (page) => {
      await page.getByPlaceholder('Search the keys').fill('zzz');
      await page.getByText('No key does that.').waitFor();
    },
  },
  {
    name: 'first steps',
    scope: '.tour',
    go: async (page) => {
      await escape(page);
      await page.keyboard.press('h');
      await page.locator('.tour:not(.nowhere)').waitFor();
    },
  },
  {
    name: 'project menu',
    scope: '.project-menu',
    go: async (page) => {
      await escape(page);
      await button(page, 'Save the project').click();
    },
  },
  {
    name: 'report without a dance',
    scope: '.inspector',
    go: async (page) => {
      await escape(page);
      await loadSong(page, wav({ seconds: 12 }), 'A song with rather a long name that must not push anything away.wav');
      await tab(page, 'Report');
    },
  },
  {
    name: 'song loaded, library',
    go: async (page) => {
      await tab(page, 'Poses');
      await page.locator('.pose-tile').first().waitFor();
    },
  },
  {
    name: 'no pose found',
    scope: '.inspector',
    go: async (page) => {
      await page.getByPlaceholder('Search poses').fill('zzz');
      await page.getByText('No pose is called that.').waitFor();
    },
  },
  {
    name: 'own poses, the menu of one',
    scope: '.inspector, .pose-menu',
    go: async (page) => {
      await page.getByPlaceholder('Search poses').fill('');
      for (let i = 1; i <= OWN_POSES; i++) {
        await button(page, 'Save pose').click();
        await page
          .getByRole('list', { name: 'My poses' })
          .locator('.pose-tile')
          .nth(i - 1)
          .waitFor();
      }
      await dismissAll(page);
      await page.locator('.pose-tile').nth(1).focus();
      await page.keyboard.press('Shift+F10');
      await page.getByRole('menu').waitFor();
    },
  },
  {
    name: 'a frame of a file',
    scope: '.inspector',
    go: async (page) => {
      await escape(page);
      const chooser = page.waitForEvent('filechooser');
      await button(page, 'Import').click();
      await (await chooser).setFiles({ name: 'three.bvh', mimeType: 'text/plain', buffer: bvh() });
      await page.locator('.moments button').first().waitFor();
    },
  },
  {
    name: 'key poses, one selected',
    go: async (page) => {
      await button(page, 'Close the file').click();
      await page.evaluate(
        (poses) =>
          window.posebeat.setKeyPoses(
            [1, 2.5, 5, 8].map((time, i) => ({ time, rotations: poses[i], name: `Pose at ${time}` })),
          ),
        fourPoses(),
      );
      await reveal(page, '.key-lane');
      await page.locator('.key-pose').first().click();
    },
  },
  {
    name: 'several key poses, a loop',
    scope: '.timeline, .inspector',
    go: async (page) => {
      await page.keyboard.press('Control+a');
      await page.keyboard.press('l');
    },
  },
  {
    name: 'beats menu',
    scope: '.beat-menu',
    go: async (page) => {
      await escape(page);
      await button(page, 'Beats').click();
    },
  },
  {
    name: 'dance panel with a dance, a range with takes',
    go: async (page) => {
      await escape(page);
      await page.locator('.generate').click();
      await calm(page);
      await page.keyboard.press('Shift+G');
      await page.locator('.range-chip').waitFor();
      await calm(page);
      await tab(page, 'Dance');
    },
  },
  {
    name: 'takes of a range',
    scope: '.range-menu',
    go: async (page) => {
      await reveal(page, '.range-chip');
      await page.locator('.range-chip').click();
    },
  },
  {
    name: 'export panel, curves chosen',
    scope: '.export-panel',
    go: async (page) => {
      await escape(page);
      await page.keyboard.press('Control+e');
      await page.locator('.export-card').filter({ hasText: 'Curves' }).click();
      await button(page, 'Dance it as curves').waitFor();
    },
  },
  {
    name: 'video panel',
    scope: '.video-panel',
    go: async (page) => {
      await escape(page);
      await page.keyboard.press('Control+Shift+e');
      await page.locator('.video-panel[open]').waitFor();
      // What the browser can encode is found out a moment later.
      await button(page, 'Looking…').waitFor({ state: 'hidden' });
    },
  },
  {
    name: 'picture tab',
    scope: '.video-panel',
    go: async (page) => {
      await page.getByRole('radio', { name: 'Picture', exact: true }).check({ force: true });
      await page.getByRole('combobox', { name: 'Shorter edge' }).waitFor();
    },
  },
  {
    name: 'key poses tab',
    scope: '.video-panel',
    go: async (page) => {
      await page.getByRole('radio', { name: 'Key poses', exact: true }).check({ force: true });
      await page.locator('.sheet-preview').waitFor();
    },
  },
  {
    name: 'share panel',
    scope: '.share-panel',
    go: async (page) => {
      await escape(page);
      await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
      await page.keyboard.press('Shift+s');
      await page.locator('.share-body').waitFor();
    },
  },
  {
    name: 'bones of a character',
    scope: '.bones-panel',
    go: async (page) => {
      await escape(page);
      await dropFile(page, anonymousGlb(), 'A character with rather a long name.glb');
      await page.locator('.bones-panel[open]').waitFor();
    },
  },
  {
    name: 'suggest menu',
    scope: '.suggest-menu',
    go: async (page) => {
      await escape(page);
      await reveal(page, '.suggest-tools');
      await button(page, 'What to suggest').click();
      await page.getByRole('dialog', { name: 'What to suggest' }).waitFor();
    },
  },
  {
    name: 'curves under the timeline, none there yet',
    scope: '.timeline',
    go: async (page) => {
      await escape(page);
      await page.keyboard.press('c');
      await page.locator('.curve-tools').waitFor();
      // The surface makes room for them a moment later.
      await page.waitForFunction(() => {
        const [view, tools] = ['.curve-view', '.curve-tools'].map((each) => document.querySelector(each));
        return view && tools && tools.getBoundingClientRect().top >= view.getBoundingClientRect().bottom - 1;
      });
    },
  },
  {
    name: 'comparison',
    scope: '.stage, .timeline-bar',
    go: async (page) => {
      await button(page, 'Hide the curves').click();
      await page.keyboard.press('a');
      await page.locator('.compare-badge').waitFor();
    },
  },
  {
    name: 'report with a dance, curves',
    scope: '.inspector, .timeline, .stage',
    go: async (page) => {
      await page.keyboard.press('v');
      await tab(page, 'Report');
      await page.locator('.gauge').first().waitFor();
    },
  },
  {
    name: 'pose editor, turning a joint',
    go: async (page) => {
      await page.keyboard.press('v');
      await button(page, 'End the comparison').click();
      await tab(page, 'Poses');
      await button(page, 'New pose').click();
      await page.getByRole('combobox', { name: 'Joint', exact: true }).selectOption({ label: 'Left elbow' });
      for (const fold of await page.locator('.fold summary').all()) await fold.click();
    },
  },
  {
    name: 'pose editor, moving a joint, balance, ghosts and path',
    scope: '.stage, .inspector',
    go: async (page) => {
      await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
      for (const key of ['w', 'b', 'o', 'Shift+P']) await page.keyboard.press(key);
    },
  },
  {
    name: 'messages: one that can be undone, one of an error',
    scope: '.notices',
    go: async (page) => {
      await page.getByRole('combobox', { name: 'Joint', exact: true }).focus();
      await button(page, 'Reset joint').click();
      await escape(page);
      const chooser = page.waitForEvent('filechooser');
      await button(page, 'New song').click();
      await (
        await chooser
      ).setFiles({ name: 'broken.mp3', mimeType: 'audio/mpeg', buffer: Buffer.from('no sound '.repeat(99)) });
      await page.getByRole('alert').waitFor();
    },
  },
];
