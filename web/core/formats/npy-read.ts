/** NumPy's array files (NEP 1, "A simple file format for NumPy arrays"): a magic word, a header in Python's notation, the numbers. */

/** An array of numbers, in C order. */
export interface NumberArray {
  shape: number[];
  data: Float64Array;
}

const MAGIC = [0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59]; // \x93NUMPY
/** Numbers in the largest array that is read: two hours of SMPL-X at 60 frames a second. */
const MAX_NUMBERS = 75e6;

type Reader = (view: DataView, at: number, little: boolean) => number;
const READERS: Readonly<Record<string, { bytes: number; read: Reader }>> = {
  f4: { bytes: 4, read: (view, at, little) => view.getFloat32(at, little) },
  f8: { bytes: 8, read: (view, at, little) => view.getFloat64(at, little) },
  i4: { bytes: 4, read: (view, at, little) => view.getInt32(at, little) },
  i8: { bytes: 8, read: (view, at, little) => Number(view.getBigInt64(at, little)) },
  u4: { bytes: 4, read: (view, at, little) => view.getUint32(at, little) },
};

const damaged = (name: string) => new Error(`“${name}” in the npz file is damaged or cut off.`);

/**
 * Reads an array of 32- or 64-bit numbers, either byte order, C or Fortran order.
 * @param bytes - The whole file.
 * @param name - For messages.
 * @throws Error with a sentence for the visitor
 */
export function readNpy(bytes: Uint8Array, name: string): NumberArray {
  if (bytes.length < 12 || MAGIC.some((byte, i) => bytes[i] !== byte)) throw damaged(name);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const wide = bytes[6] >= 2;
  const start = wide ? 12 : 10;
  const end = start + (wide ? view.getUint32(8, true) : view.getUint16(8, true));
  if (end > bytes.length) throw damaged(name);
  const header = new TextDecoder('latin1').decode(bytes.subarray(start, end));
  const type = /'descr':\s*'([<>|=])([a-zA-Z]\d*)'/.exec(header);
  const order = /'fortran_order':\s*(True|False)/.exec(header);
  const size = /'shape':\s*\(([\d,\s]*)\)/.exec(header);
  const reader = type && READERS[type[2]];
  if (!type || !order || !size) throw damaged(name);
  if (!reader)
    throw new Error(`“${name}” in the npz file holds no plain numbers (${type[2]}): save it as float32 or float64.`);
  const shape = size[1]
    .split(',')
    .map((text) => text.trim())
    .filter((text) => text !== '')
    .map(Number);
  const count = shape.reduce((product, length) => product * length, 1);
  if (!(count <= MAX_NUMBERS)) throw new Error(`“${name}” in the npz file is too long to be read.`);
  if (end + count * reader.bytes > bytes.length) throw damaged(name);
  const little = type[1] !== '>';
  const data = new Float64Array(count);
  for (let i = 0; i < count; i++) data[i] = reader.read(view, end + i * reader.bytes, little);
  return { shape, data: order[1] === 'True' ? toRowMajor(data, shape) : data };
}

/** Fortran order runs through the first index fastest, C order through the last. */
function toRowMajor(data: Float64Array, shape: readonly number[]): Float64Array {
  const out = new Float64Array(data.length);
  const strides = shape.map((_, axis) => shape.slice(axis + 1).reduce((product, length) => product * length, 1));
  const index = shape.map(() => 0);
  for (const value of data) {
    let at = 0;
    for (let axis = 0; axis < shape.length; axis++) at += index[axis] * strides[axis];
    out[at] = value;
    for (let axis = 0; axis < shape.length; axis++) {
      if (++index[axis] < shape[axis]) break;
      index[axis] = 0;
    }
  }
  return out;
}
