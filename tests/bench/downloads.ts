import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';

/** Sizes of what a visit downloads, bytes. */
export interface Download {
  name: string;
  raw: number;
  gzip: number;
  brotli: number;
}

/** Adds up the files of `dist` that the visit asked for, as a host with gzip or brotli would send them. */
export function sizes(name: string, dist: string, paths: Iterable<string>): Download {
  const total = { name, raw: 0, gzip: 0, brotli: 0 };
  for (const path of new Set(paths)) {
    const bytes = readFileSync(join(dist, path));
    total.raw += bytes.length;
    total.gzip += gzipSync(bytes, { level: 9 }).length;
    // Quality 9: what hosts that compress on the fly come to; 11 takes minutes on the wasm file and gains little.
    total.brotli += brotliCompressSync(bytes, { params: { [constants.BROTLI_PARAM_QUALITY]: 9 } }).length;
  }
  return total;
}

/** The one file of dist/assets whose name fits. */
export function asset(dist: string, pattern: RegExp): string {
  const found = readdirSync(join(dist, 'assets')).filter((name) => pattern.test(name));
  if (found.length !== 1)
    throw new Error(`dist/assets holds ${found.length} files like ${pattern}: run npm run build.`);
  return `assets/${found[0]}`;
}
