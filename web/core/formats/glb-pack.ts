/** The binary half of a GLB file (glTF 2.0 specification, sections 3.6 and 4.4): arrays become buffer views and accessors. */

/** Arrays that glTF has a component type for. */
export type GlbArray = Float32Array | Uint32Array | Uint16Array | Int16Array | Uint8Array;

const WIDTH = { SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16 } as const;
/** What a buffer view of vertices and one of triangles say they are for. */
export const ARRAY_BUFFER = 34962;
export const ELEMENT_ARRAY_BUFFER = 34963;

function componentType(values: GlbArray): number {
  if (values instanceof Float32Array) return 5126;
  if (values instanceof Uint32Array) return 5125;
  if (values instanceof Uint16Array) return 5123;
  return values instanceof Int16Array ? 5122 : 5121;
}

interface AccessorOptions {
  target?: number;
  /** Writes the least and the greatest of each component, where the specification asks for them. */
  bounds?: boolean;
  /** Integers stand for -1..1 or 0..1. */
  normalized?: boolean;
}

/** Collects arrays. */
export class GlbPack {
  readonly accessors: object[] = [];
  readonly views: object[] = [];
  readonly #pieces: GlbArray[] = [];
  #length = 0;

  /** Adds an array. @returns the number of its accessor */
  add(values: GlbArray, type: keyof typeof WIDTH, options: AccessorOptions = {}): number {
    const { target, bounds, normalized } = options;
    this.views.push({
      buffer: 0,
      byteOffset: this.#length,
      byteLength: values.byteLength,
      ...(target ? { target } : {}),
    });
    this.#pieces.push(values);
    this.#length += Math.ceil(values.byteLength / 4) * 4;
    return (
      this.accessors.push({
        bufferView: this.views.length - 1,
        componentType: componentType(values),
        ...(normalized ? { normalized } : {}),
        count: values.length / WIDTH[type],
        type,
        ...(bounds ? boundsOf(values, WIDTH[type]) : {}),
      }) - 1
    );
  }

  /** The whole file: header, JSON chunk, binary chunk. */
  toGlb(json: object): Uint8Array<ArrayBuffer> {
    const buffers = this.#length > 0 ? { buffers: [{ byteLength: this.#length }] } : {};
    const text = new TextEncoder().encode(
      JSON.stringify({ ...json, accessors: this.accessors, bufferViews: this.views, ...buffers }),
    );
    const padded = Math.ceil(text.length / 4) * 4;
    const bytes = new Uint8Array(12 + 8 + padded + 8 + this.#length);
    const view = new DataView(bytes.buffer);
    const header = [0x46546c67, 2, bytes.length, padded, 0x4e4f534a];
    header.forEach((word, i) => view.setUint32(i * 4, word, true));
    bytes.fill(0x20, 20, 20 + padded);
    bytes.set(text, 20);
    let at = 20 + padded;
    view.setUint32(at, this.#length, true);
    view.setUint32(at + 4, 0x004e4942, true);
    at += 8;
    for (const piece of this.#pieces) {
      bytes.set(new Uint8Array(piece.buffer, piece.byteOffset, piece.byteLength), at);
      at += Math.ceil(piece.byteLength / 4) * 4;
    }
    return bytes;
  }
}

function boundsOf(values: GlbArray, width: number) {
  const min = Array.from(values.subarray(0, width));
  const max = [...min];
  for (let i = width; i < values.length; i++) {
    const k = i % width;
    if (values[i] < min[k]) min[k] = values[i];
    if (values[i] > max[k]) max[k] = values[i];
  }
  return { min, max };
}
