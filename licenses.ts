/** The licences of all packages whose code is in the built page or in one of its workers, as one text file beside the page. */
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Plugin } from 'vite';

/** Name of the file in the build. */
export const LICENSES_FILE = 'licenses.txt';
const PACKAGE = /^(.*[\\/]node_modules[\\/](?:@[^\\/]+[\\/])?[^\\/]+)[\\/]/;

interface Bundled {
  [file: string]: { type: string; moduleIds?: string[] };
}

/** The folders of packages, found as chunks are written. */
function collector(name: string, folders: Set<string>): Plugin {
  return {
    name,
    generateBundle(_, bundle) {
      for (const { moduleIds = [] } of Object.values(bundle as unknown as Bundled))
        for (const id of moduleIds) {
          const folder = PACKAGE.exec(id.replace(/^\0/, '').replace(/\?.*$/, ''))?.[1];
          if (folder) folders.add(folder);
        }
    },
  };
}

/** A package's name, version and licence, and its licence's text. */
function entry(folder: string): string {
  const { name, version, license, author, homepage } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const file = readdirSync(folder).find((each) => /^licen[cs]e|^copying/i.test(each));
  const by = typeof author === 'string' ? author : author?.name;
  const text = file
    ? readFileSync(join(folder, file), 'utf8').trim()
    : [`Licence: ${license}.`, by && `By ${by}.`, homepage && `${homepage}`].filter(Boolean).join(' ');
  return `${name} ${version} (${license})\nSource: https://www.npmjs.com/package/${name}/v/${version}\n\n${text}\n`;
}

/** Plugins for the page and for its workers; workers are bundled first, so the page's writes the file. */
export function licenses(): { page: Plugin; worker: () => Plugin[] } {
  const folders = new Set<string>();
  const page = collector('posebeat:licenses', folders);
  const collect = page.generateBundle as (...args: unknown[]) => void;
  page.apply = 'build';
  page.generateBundle = function (...args) {
    collect.apply(this, args);
    const known = [...folders].filter((folder) => existsSync(join(folder, 'package.json'))).sort();
    const source = `This page holds code of these packages.\n\n${known.map(entry).join(`\n${'-'.repeat(80)}\n\n`)}`;
    this.emitFile({ type: 'asset', fileName: LICENSES_FILE, source });
  };
  return { page, worker: () => [collector('posebeat:licenses-worker', folders)] };
}
