/**
 * The parts of a glTF 2.0 file (Khronos specification 2.0.1, sections 3.6 and 4.4) that a pose needs: nodes, skins, animations and the
 * numbers behind them. Meshes, pictures and whatever is kept in other files are never touched, so nothing is loaded from anywhere.
 */
import * as v from 'valibot';

const index = v.pipe(v.number(), v.integer(), v.minValue(0));
const numbers = v.array(v.pipe(v.number(), v.finite()));
const node = v.object({
  name: v.optional(v.string()),
  children: v.optional(v.array(index)),
  translation: v.optional(v.pipe(numbers, v.length(3))),
  rotation: v.optional(v.pipe(numbers, v.length(4))),
  scale: v.optional(v.pipe(numbers, v.length(3))),
  matrix: v.optional(v.pipe(numbers, v.length(16))),
  mesh: v.optional(index),
  skin: v.optional(index),
});
const channel = v.object({
  sampler: index,
  target: v.object({ node: v.optional(index), path: v.string() }),
});
const animation = v.object({
  name: v.optional(v.string()),
  channels: v.array(channel),
  samplers: v.array(v.object({ input: index, output: index, interpolation: v.optional(v.string(), 'LINEAR') })),
});
const accessor = v.object({
  bufferView: v.optional(index),
  byteOffset: v.optional(index, 0),
  componentType: v.number(),
  normalized: v.optional(v.boolean(), false),
  count: index,
  type: v.string(),
  sparse: v.optional(v.unknown()),
});
const bufferView = v.object({
  buffer: index,
  byteOffset: v.optional(index, 0),
  byteLength: index,
  byteStride: v.optional(index),
  extensions: v.optional(v.record(v.string(), v.unknown()), {}),
});
const schema = v.object({
  asset: v.object({ version: v.string() }),
  nodes: v.pipe(v.optional(v.array(node), []), v.maxLength(20_000)),
  skins: v.optional(v.array(v.object({ joints: v.array(index), inverseBindMatrices: v.optional(index) })), []),
  /** Only avatars look at them, and get on without. */
  meshes: v.optional(v.unknown()),
  animations: v.pipe(v.optional(v.array(animation), []), v.maxLength(1000)),
  accessors: v.optional(v.array(accessor), []),
  bufferViews: v.optional(v.array(bufferView), []),
  buffers: v.optional(v.array(v.object({ byteLength: index, uri: v.optional(v.string()) })), []),
  extensions: v.optional(v.record(v.string(), v.unknown()), {}),
});

/** The JSON part, checked. */
export type GltfJson = v.InferOutput<typeof schema>;
export type GltfNode = GltfJson['nodes'][number];
export type GltfAnimation = GltfJson['animations'][number];

/** A glTF file whose numbers can be read. */
export interface GltfFile {
  json: GltfJson;
  /**
   * The numbers of an accessor, integers brought to -1..1 where they are normalised.
   * @throws Error when they lie outside the file or are compressed
   */
  numbers(accessor: number): Float32Array;
}

const GLB = 0x46546c67; // "glTF"
const JSON_CHUNK = 0x4e4f534a;
const BIN_CHUNK = 0x004e4942;
const WIDTH: Readonly<Record<string, number>> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };

type Read = (view: DataView, at: number) => number;
const COMPONENTS: Readonly<Record<number, { bytes: number; most: number; read: Read }>> = {
  5120: { bytes: 1, most: 127, read: (view, at) => view.getInt8(at) },
  5121: { bytes: 1, most: 255, read: (view, at) => view.getUint8(at) },
  5122: { bytes: 2, most: 32767, read: (view, at) => view.getInt16(at, true) },
  5123: { bytes: 2, most: 65535, read: (view, at) => view.getUint16(at, true) },
  5126: { bytes: 4, most: 1, read: (view, at) => view.getFloat32(at, true) },
};

const damaged = () => new Error('This glTF file is damaged or was not copied completely: get it again.');

/**
 * Opens a .glb, .vrm or self-contained .gltf file.
 * @throws Error with a sentence for the visitor
 */
export function openGltf(bytes: Uint8Array): GltfFile {
  const { text, binary } = glbChunks(bytes);
  let raw: unknown;
  try {
    raw = JSON.parse(text);
  } catch {
    throw damaged();
  }
  const parsed = v.safeParse(schema, raw);
  if (!parsed.success) throw damaged();
  const json = parsed.output;
  if (!/^2\./.test(json.asset.version)) {
    throw new Error(`This is glTF ${json.asset.version.slice(0, 8)}: export it as glTF 2.0.`);
  }
  const buffers = new Map<number, Uint8Array>();
  const buffer = (at: number): Uint8Array => {
    const known = buffers.get(at);
    if (known) return known;
    const entry = json.buffers[at];
    if (!entry) throw damaged();
    const found = entry.uri === undefined ? binary : fromDataUri(entry.uri);
    if (!found || found.length < entry.byteLength) throw damaged();
    buffers.set(at, found);
    return found;
  };
  return { json, numbers: (at) => readAccessor(json, buffer, at) };
}

/**
 * The text and the binary part of a .glb file; a .gltf file is all text.
 * @throws Error when it is cut off
 */
export function glbChunks(bytes: Uint8Array): { text: string; binary: Uint8Array | null } {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const decode = (part: Uint8Array) => new TextDecoder().decode(part);
  if (bytes.length < 20 || view.getUint32(0, true) !== GLB) return { text: decode(bytes), binary: null };
  let text: string | null = null;
  let binary: Uint8Array | null = null;
  for (let at = 12; at + 8 <= bytes.length;) {
    const length = view.getUint32(at, true);
    const kind = view.getUint32(at + 4, true);
    if (at + 8 + length > bytes.length) throw damaged();
    const part = bytes.subarray(at + 8, at + 8 + length);
    if (kind === JSON_CHUNK) text ??= decode(part);
    else if (kind === BIN_CHUNK) binary ??= part;
    at += 8 + length + ((4 - (length % 4)) % 4);
  }
  if (text === null) throw damaged();
  return { text, binary };
}

function fromDataUri(uri: string): Uint8Array {
  const data = /^data:[^,]*;base64,(.*)$/s.exec(uri);
  if (!data) throw new Error('This glTF file keeps its numbers in a second file: export it as one .glb file.');
  try {
    return Uint8Array.from(atob(data[1]), (character) => character.charCodeAt(0));
  } catch {
    throw damaged();
  }
}

function readAccessor(json: GltfJson, buffer: (at: number) => Uint8Array, at: number): Float32Array {
  const entry = json.accessors[at];
  const part = entry && entry.bufferView !== undefined ? json.bufferViews[entry.bufferView] : undefined;
  const component = entry && COMPONENTS[entry.componentType];
  const width = entry && WIDTH[entry.type];
  if (!entry || !part || !component || !width) throw damaged();
  if (entry.sparse !== undefined || Object.keys(part.extensions).some((name) => /compression/i.test(name))) {
    throw new Error('The animation in this glTF file is compressed: export it without compression.');
  }
  const bytes = buffer(part.buffer);
  const stride = part.byteStride || width * component.bytes;
  const start = part.byteOffset + entry.byteOffset;
  const end = start + (entry.count - 1) * stride + width * component.bytes;
  if (entry.count > 0 && end > bytes.length) throw damaged();
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const out = new Float32Array(entry.count * width);
  for (let row = 0, i = 0; row < entry.count; row++) {
    for (let column = 0; column < width; column++, i++) {
      const value = component.read(view, start + row * stride + column * component.bytes);
      // Section 3.11: the lowest signed integer also stands for -1.
      out[i] = entry.normalized ? Math.max(value / component.most, -1) : value;
      if (!Number.isFinite(out[i])) throw damaged();
    }
  }
  return out;
}
