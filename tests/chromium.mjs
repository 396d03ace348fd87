import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';

const CANDIDATES = [
  process.env.CHROMIUM,
  '/usr/bin/chromium',
  '/usr/bin/chromium-browser',
  '/usr/bin/google-chrome',
  '/usr/bin/google-chrome-stable',
];

/** Flags that every headless run uses: no sandbox in containers, no traffic of the browser's own. */
export const CHROMIUM_FLAGS = [
  '--no-sandbox',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--no-first-run',
  '--disable-quic',
];

/** Path of an installed Chromium, or undefined: then Playwright's own is used. */
export const installedChromium = () => CANDIDATES.find((path) => path && existsSync(path));

/** Makes sure that there is a Chromium: an installed one, else Debian's package, else Playwright's download. */
export function ensureChromium() {
  if (installedChromium()) return;
  const root = process.getuid?.() === 0;
  if (root && existsSync('/usr/bin/apt-get')) {
    const run = (args) =>
      spawnSync('apt-get', args, { stdio: 'inherit', env: { ...process.env, DEBIAN_FRONTEND: 'noninteractive' } });
    run(['update', '-qq']);
    if (run(['install', '-y', '-qq', '--no-install-recommends', 'chromium']).status === 0 && installedChromium())
      return;
  }
  const args = ['playwright', 'install', ...(root ? ['--with-deps'] : []), 'chromium'];
  if (spawnSync('npx', args, { stdio: 'inherit' }).status !== 0) {
    throw new Error('No Chromium here and none could be installed. Install one, or set CHROMIUM to its path.');
  }
}
