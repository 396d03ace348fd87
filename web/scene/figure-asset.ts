import { BufferAttribute, BufferGeometry } from 'three';
import { decodeFigure, mirrorFigure } from './figure-file';
import url from './figure.bin?url';

let loading: Promise<BufferGeometry> | undefined;

/**
 * The figure's geometry, fetched once for the whole page.
 * @throws Error when the file cannot be fetched
 */
export function loadFigure(): Promise<BufferGeometry> {
  loading ??= fetchFigure().catch((error) => {
    loading = undefined;
    throw error;
  });
  return loading;
}

async function fetchFigure(): Promise<BufferGeometry> {
  const response = await fetch(url);
  if (!response.ok || !response.body)
    throw new Error(`The figure could not be loaded (${response.status}). Reload the page.`);
  return buildGeometry(await inflate(response.body));
}

/** Undoes gzip. */
export async function inflate(packed: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<Uint8Array> {
  return new Uint8Array(await new Response(packed.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
}

/** The whole figure as a skinned geometry; `surface` holds the vertex's openness and part number. */
export function buildGeometry(bytes: Uint8Array): BufferGeometry {
  const figure = mirrorFigure(decodeFigure(bytes));
  const geometry = new BufferGeometry();
  const surface = new Float32Array(figure.parts.length * 2);
  for (let v = 0; v < figure.parts.length; v++) {
    surface[v * 2] = figure.openness[v];
    surface[v * 2 + 1] = figure.parts[v];
  }
  geometry.setAttribute('position', new BufferAttribute(figure.positions, 3));
  geometry.setAttribute('normal', new BufferAttribute(figure.normals, 3));
  geometry.setAttribute('skinIndex', new BufferAttribute(figure.bones, 4));
  geometry.setAttribute('skinWeight', new BufferAttribute(figure.weights, 4));
  geometry.setAttribute('surface', new BufferAttribute(surface, 2));
  geometry.setIndex(new BufferAttribute(new Uint16Array(figure.triangles), 1));
  return geometry;
}
