/** An avatar's own file with the dance in it (glTF 2.0 specification, sections 3.11 and 4.4). */
import { frameTimes, isStill } from '../formats/glb-motion';
import { glbChunks } from '../formats/gltf-file';
import { matrixToQuaternion } from '../rotation';
import { frameView } from '../motion';
import type { Motion } from '../types';
import type { AvatarRetargeter } from './retarget';

/** What is said in the file beside the motion. */
export interface AvatarGlbOptions {
  /** Name of the animation. */
  name: string;
  /** Kept with the animation, under `extras`. */
  extras?: Readonly<Record<string, unknown>>;
}

/** What of a file's JSON is added to; the rest is never looked at. */
interface RawJson {
  buffers?: { byteLength: number; uri?: string }[];
  bufferViews?: object[];
  accessors?: object[];
  animations?: object[];
  nodes?: { matrix?: number[]; translation?: number[]; rotation?: number[]; scale?: number[] }[];
}

const damaged = () => new Error('The file of this avatar is damaged: load the avatar again.');
const align = (length: number) => Math.ceil(length / 4) * 4;

/**
 * The avatar's file with the dance as its first animation, one key per frame; all else stays as it is, VRM metadata too. (Nodes that are
 * animated get their transform in parts where they had a matrix, because glTF animates no matrices.)
 * @param original the very bytes that the retargeter's rig was read from
 * @param motion at the wanted frame rate
 * @returns a .glb file
 * @throws Error when the dance has no frames or the file is damaged
 */
export function avatarGlb(
  original: Uint8Array,
  retargeter: AvatarRetargeter,
  motion: Motion,
  { name, extras }: AvatarGlbOptions,
): Uint8Array<ArrayBuffer> {
  if (motion.frames < 1) throw new Error('The dance has no frames yet: generate it first.');
  const { text, binary } = glbChunks(original);
  const json = JSON.parse(text) as RawJson;
  for (const node of retargeter.nodes) {
    if (!json.nodes?.[node]) throw damaged();
    takeMatrixApart(json.nodes[node]);
  }
  const { times, hips, rotations } = sample(retargeter, motion);
  const pieces: Float32Array[] = [];
  const store = new BinaryStore(json, binary);
  const views = (json.bufferViews ??= []);
  const accessors = (json.accessors ??= []);
  const put = (values: Float32Array, type: string, width: number, bounds?: object): number => {
    views.push({ buffer: store.buffer, byteOffset: store.offset, byteLength: values.byteLength });
    store.offset += values.byteLength;
    pieces.push(values);
    const bufferView = views.length - 1;
    return accessors.push({ bufferView, componentType: 5126, count: values.length / width, type, ...bounds }) - 1;
  };
  const input = put(times, 'SCALAR', 1, { min: [times[0]], max: [times[times.length - 1]] });
  const once = put(times.slice(0, 1), 'SCALAR', 1, { min: [times[0]], max: [times[0]] });
  const samplers = [{ input, output: put(hips, 'VEC3', 3), interpolation: 'LINEAR' }];
  const channels = [{ sampler: 0, target: { node: retargeter.nodes[0], path: 'translation' } }];
  retargeter.nodes.forEach((node, i) => {
    const still = isStill(rotations[i]);
    const output = put(still ? rotations[i].slice(0, 4) : rotations[i], 'VEC4', 4);
    channels.push({ sampler: samplers.length, target: { node, path: 'rotation' } });
    samplers.push({ input: still ? once : input, output, interpolation: 'LINEAR' });
  });
  // First, because that is the one that viewers play.
  json.animations = [{ name, channels, samplers, ...(extras ? { extras } : {}) }, ...(json.animations ?? [])];
  return store.toGlb(pieces);
}

/** Every frame of the dance; neighbouring quaternions have the same sign. */
function sample(retargeter: AvatarRetargeter, motion: Motion) {
  const frame = retargeter.createFrame();
  const hips = new Float32Array(motion.frames * 3);
  const rotations = retargeter.nodes.map(() => new Float32Array(motion.frames * 4));
  for (let t = 0; t < motion.frames; t++) {
    retargeter.frame(frameView(motion, t), frame);
    hips.set(frame.hips, t * 3);
    rotations.forEach((values, i) => {
      const [at, from] = [t * 4, i * 4];
      let dot = 0;
      for (let k = 0; k < 4; k++) dot += t > 0 ? values[at - 4 + k] * frame.rotations[from + k] : 0;
      for (let k = 0; k < 4; k++) values[at + k] = dot < 0 ? -frame.rotations[from + k] : frame.rotations[from + k];
    });
  }
  return { times: frameTimes(motion), hips, rotations };
}

/** Where the new numbers go: behind those of the file, or, in a file without a binary part, into one of their own. */
class BinaryStore {
  readonly buffer: number;
  /** Where the next numbers begin. */
  offset: number;
  readonly #json: RawJson;
  readonly #before: Uint8Array;
  readonly #start: number;

  constructor(json: RawJson, binary: Uint8Array | null) {
    const buffers = (json.buffers ??= []);
    this.#json = json;
    const shared = binary !== null && buffers.length > 0 && buffers[0].uri === undefined;
    if (shared && !(buffers[0].byteLength <= binary.length)) throw damaged();
    this.#before = binary?.subarray(0, shared ? buffers[0].byteLength : binary.length) ?? new Uint8Array(0);
    if (buffers.length === 0) buffers.push({ byteLength: 0 });
    // Only the first buffer of a file can be its binary part; beside others the numbers are written as text.
    this.buffer = shared || buffers[0].uri === undefined ? 0 : buffers.push({ byteLength: 0 }) - 1;
    this.#start = this.buffer === 0 ? align(shared ? buffers[0].byteLength : 0) : 0;
    this.offset = this.#start;
  }

  toGlb(pieces: readonly Float32Array[]): Uint8Array<ArrayBuffer> {
    const added = new Uint8Array(this.offset - this.#start);
    let at = 0;
    for (const piece of pieces) {
      added.set(new Uint8Array(piece.buffer, piece.byteOffset, piece.byteLength), at);
      at += piece.byteLength;
    }
    const entry = this.#json.buffers![this.buffer];
    entry.byteLength = this.offset;
    const inside = this.buffer === 0;
    if (!inside) entry.uri = `data:application/octet-stream;base64,${base64(added)}`;
    const binary = new Uint8Array(inside ? align(this.offset) : align(this.#before.length));
    binary.set(this.#before);
    if (inside) binary.set(added, this.#start);
    return glbOf(this.#json, binary);
  }
}

function glbOf(json: object, binary: Uint8Array): Uint8Array<ArrayBuffer> {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const padded = align(text.length);
  const tail = binary.length > 0 ? 8 + binary.length : 0;
  const bytes = new Uint8Array(20 + padded + tail);
  const view = new DataView(bytes.buffer);
  [0x46546c67, 2, bytes.length, padded, 0x4e4f534a].forEach((word, i) => view.setUint32(i * 4, word, true));
  bytes.fill(0x20, 20, 20 + padded);
  bytes.set(text, 20);
  if (tail > 0) {
    view.setUint32(20 + padded, binary.length, true);
    view.setUint32(24 + padded, 0x004e4942, true);
    bytes.set(binary, 28 + padded);
  }
  return bytes;
}

function base64(bytes: Uint8Array): string {
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text);
}

function takeMatrixApart(node: NonNullable<RawJson['nodes']>[number]): void {
  const { matrix: m } = node;
  if (!m) return;
  const scale = [0, 4, 8].map((at) => Math.hypot(m[at], m[at + 1], m[at + 2]) || 1);
  // Row-major, without the scale.
  const turn = Array.from({ length: 9 }, (_, i) => m[(i % 3) * 4 + Math.floor(i / 3)] / scale[i % 3]);
  node.rotation = matrixToQuaternion(turn).map((value) => Math.min(1, Math.max(-1, value)));
  node.translation = [m[12], m[13], m[14]];
  node.scale = scale;
  delete node.matrix;
}
