/** NumPy's array files (NEP 1): a magic word, a header in Python's notation, the numbers, little-endian and in C order. */

/** An array, or a single text (a 0-d array of unicode). */
export type NpyValue = { shape: readonly number[]; data: Float32Array | Float64Array } | string;

/** Numbers begin at a multiple of this many bytes. */
const ALIGN = 64;

/**
 * Writes one array.
 * @throws Error when the numbers do not fill the shape
 */
export function writeNpy(value: NpyValue): Uint8Array<ArrayBuffer> {
  if (typeof value === 'string') {
    const letters = [...value].map((letter) => letter.codePointAt(0)!);
    return npy(`<U${Math.max(1, letters.length)}`, [], Math.max(1, letters.length) * 4, (view, at) =>
      letters.forEach((letter, i) => view.setUint32(at + i * 4, letter, true)),
    );
  }
  const { shape, data } = value;
  const count = shape.reduce((product, length) => product * length, 1);
  if (count !== data.length)
    throw new Error(`An array of ${data.length} numbers has not the shape ${shape.join(' x ')}.`);
  const wide = data instanceof Float64Array;
  return npy(wide ? '<f8' : '<f4', shape, data.byteLength, (view, at) => {
    for (let i = 0; i < data.length; i++) {
      if (wide) view.setFloat64(at + i * 8, data[i], true);
      else view.setFloat32(at + i * 4, data[i], true);
    }
  });
}

function npy(
  type: string,
  shape: readonly number[],
  bytes: number,
  fill: (view: DataView, at: number) => void,
): Uint8Array<ArrayBuffer> {
  const tuple = shape.length === 1 ? `(${shape[0]},)` : `(${shape.join(', ')})`;
  const text = `{'descr': '${type}', 'fortran_order': False, 'shape': ${tuple}, }`;
  const start = Math.ceil((10 + text.length + 1) / ALIGN) * ALIGN;
  const out = new Uint8Array(start + bytes);
  out.set([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0]);
  const view = new DataView(out.buffer);
  view.setUint16(8, start - 10, true);
  out.set(new TextEncoder().encode(`${text.padEnd(start - 11)}\n`), 10);
  fill(view, start);
  return out;
}
