import { BufferAttribute, BufferGeometry } from 'three';
import { decodeLevels, mirrorFigure, type WholeFigure } from './figure-file';
import url from './figure.bin?url';

/** The figure's triangles. Figures share the vertices and draw a level of detail each. */
export interface FigureAsset {
  geometry: BufferGeometry;
  /** Ranges of the index, finest level first. */
  levels: { start: number; count: number }[];
}

let loading: Promise<FigureAsset> | undefined;

/**
 * The figure's shape, fetched once for the whole page.
 * @throws Error when the file cannot be fetched
 */
export function loadFigure(): Promise<FigureAsset> {
  loading ??= fetchFigure().catch((error) => {
    loading = undefined;
    throw error;
  });
  return loading;
}

async function fetchFigure(): Promise<FigureAsset> {
  const response = await fetch(url);
  if (!response.ok || !response.body)
    throw new Error(`The figure could not be loaded (${response.status}). Reload the page.`);
  return buildFigure(await inflate(response.body));
}

/** Undoes gzip. */
export async function inflate(packed: ReadableStream<Uint8Array<ArrayBuffer>>): Promise<Uint8Array> {
  return new Uint8Array(await new Response(packed.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
}

/** The whole figure, every level of detail in one skinned geometry; `surface` holds the vertex's openness and part number. */
export function buildFigure(bytes: Uint8Array): FigureAsset {
  const wholes = decodeLevels(bytes).map(mirrorFigure);
  const join = <T extends Float32Array | Uint8Array>(pick: (figure: WholeFigure) => T): T => {
    const pieces = wholes.map(pick);
    const whole = new (pieces[0].constructor as new (length: number) => T)(pieces.reduce((n, p) => n + p.length, 0));
    let at = 0;
    for (const piece of pieces) {
      whole.set(piece, at);
      at += piece.length;
    }
    return whole;
  };
  const openness = join((f) => f.openness);
  const parts = join((f) => f.parts);
  const surface = new Float32Array(parts.length * 2);
  for (let v = 0; v < parts.length; v++) {
    surface[v * 2] = openness[v];
    surface[v * 2 + 1] = parts[v];
  }
  const levels: FigureAsset['levels'] = [];
  const index = new Uint16Array(wholes.reduce((n, { triangles }) => n + triangles.length, 0));
  let start = 0;
  let first = 0;
  for (const { triangles, parts: vertices } of wholes) {
    for (let i = 0; i < triangles.length; i++) index[start + i] = triangles[i] + first;
    levels.push({ start, count: triangles.length });
    start += triangles.length;
    first += vertices.length;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute(
    'position',
    new BufferAttribute(
      join((f) => f.positions),
      3,
    ),
  );
  geometry.setAttribute(
    'normal',
    new BufferAttribute(
      join((f) => f.normals),
      3,
    ),
  );
  geometry.setAttribute(
    'skinIndex',
    new BufferAttribute(
      join((f) => f.bones),
      4,
    ),
  );
  geometry.setAttribute(
    'skinWeight',
    new BufferAttribute(
      join((f) => f.weights),
      4,
    ),
  );
  geometry.setAttribute('surface', new BufferAttribute(surface, 2));
  geometry.setIndex(new BufferAttribute(index, 1));
  return { geometry, levels };
}
