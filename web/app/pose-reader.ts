/** Files that poses can be taken from. What reads them is loaded when the first one comes. */
import type { JsonKind } from '../core/formats/motion-clip';
import type { PoseClips } from '../core/formats/pose-sequence';

/** Larger files are refused before they are read, bytes. */
const MAX_BYTES = 300e6;
/** BVH and JSON are read as text, which takes several times its size. */
const MAX_TEXT_BYTES = 100e6;

/** What the file chooser offers. */
export const POSE_FILES = '.bvh,.npz,.glb,.gltf,.vrm,.vrma,.json';

/** What a JSON file is stands at its beginning. */
const HEAD_BYTES = 4096;

const ANIMATION = /\.(bvh|npz|glb|gltf|vrma?)$/i;
const REFUSED = /\.(pkl|pickle|npy|fbx|c3d|dae|blend)$/i;
/** “my-poses.json”, and what browsers make of a second download of it. */
const LIBRARY = /poses( ?\(\d+\))?\.json$/i;

/** True for files that go to the pose library and not to the player. */
export function isPoseFile(file: Pick<File, 'name'>): boolean {
  return [ANIMATION, REFUSED, LIBRARY].some((pattern) => pattern.test(file.name));
}

/** What a JSON file of ours holds; null for other files, and for projects. Only its beginning is read. */
export async function jsonKindOf(file: File): Promise<JsonKind | null> {
  if (!isJson(file)) return null;
  const { jsonKind } = await import('../core/formats/motion-clip');
  const head = await file.slice(0, HEAD_BYTES).text();
  return jsonKind(head);
}

/** True for JSON, whatever it holds. */
export function isJson(file: Pick<File, 'name'>): boolean {
  return /\.json$/i.test(file.name);
}

function refusal(extension: string): string {
  if (extension === 'pkl' || extension === 'pickle')
    return 'Posebeat reads no .pkl files, because opening one runs the program inside. Save the arrays with numpy.savez as .npz.';
  if (extension === 'npy')
    return 'An .npy file holds one array only: save poses with their names, with numpy.savez as .npz.';
  if (extension === 'fbx' || extension === 'dae' || extension === 'blend')
    return `Posebeat reads no .${extension} files: export the animation as .glb or .bvh, from Blender for example.`;
  if (extension === 'c3d') return 'A .c3d file holds markers, not joints: export the skeleton’s motion as .bvh.';
  return 'Poses can be taken from .bvh, .npz (SMPL), .glb, .gltf and .vrm files, and from the .json of a dance.';
}

/**
 * Reads an animation file.
 * @throws Error with a sentence for the visitor
 */
export async function readPoseClips(file: File): Promise<PoseClips> {
  const extension = /\.([a-z0-9]+)$/i.exec(file.name)?.[1].toLowerCase() ?? '';
  const ours = isJson(file);
  if (!ours && !ANIMATION.test(file.name)) throw new Error(refusal(extension));
  if (file.size > (ours || extension === 'bvh' ? MAX_TEXT_BYTES : MAX_BYTES)) {
    throw new Error(`This file has ${Math.round(file.size / 1e6)} MB: that is too much to be read here.`);
  }
  if (file.size === 0) throw new Error('This file is empty: choose another one.');
  if (extension === 'bvh') {
    const { readBvh } = await import('../core/formats/bvh-read');
    return readBvh(await file.text());
  }
  if (ours) return (await import('../core/formats/motion-clip')).readMotionClip(await file.text());
  const bytes = new Uint8Array(await file.arrayBuffer());
  if (extension === 'npz') return (await import('../core/formats/npz-read')).readNpz(bytes);
  return (await import('../core/formats/gltf-read')).readGltf(bytes);
}
