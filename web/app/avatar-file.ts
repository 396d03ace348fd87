/** Files of characters, as far as it can be told without reading them whole. What does read them is loaded when the first one comes. */

/** What the file chooser offers. */
export const AVATAR_FILES = '.vrm,.glb,.gltf,model/gltf-binary';

/** True for a file that may hold a character. */
export function mayBeAvatar(file: Pick<File, 'name'>): boolean {
  return /\.(vrm|glb|gltf)$/i.test(file.name);
}

/** What a glTF file has in it. */
export interface GltfParts {
  /** Something that bones move. */
  character: boolean;
  motion: boolean;
}

const GLB = 0x46546c67; // "glTF"
/** What only needs another way of exporting, in the visitor's words. */
const COMPRESSION: Readonly<Record<string, string>> = {
  KHR_draco_mesh_compression: 'Draco compression',
  KHR_texture_basisu: 'Basis (KTX2) pictures',
};

interface RawGltf {
  meshes?: unknown[];
  skins?: unknown[];
  animations?: unknown[];
  nodes?: { mesh?: unknown; skin?: unknown }[];
  buffers?: { uri?: unknown }[];
  images?: { uri?: unknown }[];
  extensionsRequired?: unknown[];
}

/**
 * Looks a .glb, .vrm or .gltf file's description through.
 * @throws Error with a sentence for the visitor when it is none, or of a kind that cannot be shown
 */
export function gltfParts(bytes: Uint8Array): GltfParts {
  const json = description(bytes);
  const list = <T>(value: readonly T[] | undefined): readonly T[] => (Array.isArray(value) ? value : []);
  const required = list(json.extensionsRequired).map(String);
  const compressed = required.find((name) => name in COMPRESSION);
  if (compressed) {
    throw new Error(
      `This file uses ${COMPRESSION[compressed]}, which Posebeat does not read: export it without compression.`,
    );
  }
  const outside = [...list(json.buffers), ...list(json.images)].some(
    (part) => typeof part?.uri === 'string' && !part.uri.startsWith('data:'),
  );
  if (outside) throw new Error('This file keeps parts of itself in other files: export it as one .glb file.');
  return {
    character:
      list(json.meshes).length > 0 &&
      list(json.nodes).some((node) => node?.mesh !== undefined && node.skin !== undefined),
    motion: list(json.animations).length > 0,
  };
}

function description(bytes: Uint8Array): RawGltf {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  // The first chunk of a GLB file is its JSON (glTF 2.0.1, section 4.4.3).
  const binary = bytes.length >= 20 && view.getUint32(0, true) === GLB;
  const part = binary ? bytes.subarray(20, 20 + view.getUint32(12, true)) : bytes;
  try {
    const json: unknown = JSON.parse(new TextDecoder().decode(part));
    if (typeof json === 'object' && json !== null && 'asset' in json) return json as RawGltf;
  } catch {
    // Told below.
  }
  throw new Error('This is no glTF or VRM file, or it is damaged or was not copied completely: get it again.');
}
