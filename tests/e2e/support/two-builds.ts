/** A host that serves the built page, and from some moment on a newer build of it: the same files but for the page and its worker. */
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { extname } from 'node:path';

const DIST = new URL('../../../dist/', import.meta.url);
const TYPES: Readonly<Record<string, string>> = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
  '.webmanifest': 'application/manifest+json',
};

/** What differs in the newer build; throws where the build is not as it was when this was written. */
function newer(name: string, text: string): string {
  const [find, put] =
    name === 'index.html'
      ? [/<html/, '<html data-build="2"']
      : [/(\{url:"index\.html",revision:")[0-9a-f]+"/, '$1second"'];
  if (!find.test(text)) throw new Error(`There is nothing to change in ${name}.`);
  return text.replace(find, put);
}

/** Starts the host on a free port. */
export async function twoBuilds(): Promise<{ url: string; release(): void; close(): Promise<void> }> {
  let released = false;
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url!, 'http://host').pathname).slice(1) || 'index.html';
    const file = new URL(path, DIST);
    void readFile(file)
      .then((bytes) => (released && /^(index\.html|sw\.js)$/.test(path) ? newer(path, bytes.toString()) : bytes))
      .then(
        (body) =>
          response
            .writeHead(200, {
              'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream',
              'Cache-Control': 'no-cache',
              'Cross-Origin-Opener-Policy': 'same-origin',
              'Cross-Origin-Embedder-Policy': 'require-corp',
            })
            .end(body),
        (error: Error) => response.writeHead(404).end(error.message),
      );
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${(server.address() as AddressInfo).port}/`,
    release: () => void (released = true),
    close: () =>
      new Promise((resolve) => {
        server.closeAllConnections();
        server.close(() => resolve());
      }),
  };
}
