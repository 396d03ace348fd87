/** Poses from glTF 2.0 (.glb, .gltf) and VRM 0.x and 1.0 avatars and animations (.vrm, .vrma): nodes turned by animations, on our skeleton. */
import { canonicalQuaternion, multiply, slerp } from '../rotation';
import { JOINT_COUNT } from '../skeleton';
import { spec } from '../spec';
import { openGltf, type GltfAnimation, type GltfFile } from './gltf-file';
import { boundRest, plantTree, vrmBones, worldOf, type GltfTree } from './gltf-tree';
import { mapHumanoid } from './humanoid';
import { axisOf, MAX_FRAMES, meanUp, turnUpright, type PoseClips, type PoseSequence } from './pose-sequence';
import { Retargeter } from './retarget';

const UPRIGHT = 0.85;
/** Half a turn about Y. */
const ABOUT = [0, 1, 0, 0];

/**
 * Reads a glTF or VRM file.
 * @param bytes - The whole file.
 * @throws Error with a sentence for the visitor when it is none, damaged, or holds no human body
 */
export function readGltf(bytes: Uint8Array): PoseClips {
  const file = openGltf(bytes);
  const bones = vrmBones(file);
  const tree = plantTree(file.json.nodes, bones?.nodes ?? null);
  const still = worldOf(tree, tree.rotations);
  const rest = (bones ? null : boundRest(file, tree, mapHumanoid(tree))) ?? still;
  const retargeter = new Retargeter({ names: tree.names, parents: tree.parents, ...rest });
  const toPose = (world: Float64Array, out: Float32Array, offset: number) => {
    retargeter.pose(world, out, offset);
    // Avatars of VRM 0.x look to -Z in their own space; everybody turns them round.
    if (bones?.kind === 'VRM 0') out.set(multiply(ABOUT, out.subarray(offset, offset + 4)), offset);
  };
  const posed: PoseSequence = { name: '', fps: 0, frames: 1, quaternions: new Float32Array(JOINT_COUNT * 4) };
  toPose(still.rotations, posed.quaternions, 0);

  const needed = new Set<number>();
  for (const joint of retargeter.source) for (let at = joint; at >= 0; at = tree.parents[at]) needed.add(at);
  const clips = file.json.animations.flatMap((animation) => sample(file, tree, animation, needed, toPose) ?? []);
  // glTF is Y up; only a file whose rest and motion both stand on another axis is taken for a wrong export.
  const lying = clips.length > 0 ? axisOf(meanUp(posed), UPRIGHT) : null;
  for (const clip of clips) {
    const up = axisOf(meanUp(clip), UPRIGHT);
    if (up && lying && up[1] === 0 && up.every((value, k) => value === lying[k])) turnUpright(clip, up);
  }
  return { kind: bones ? 'VRM' : 'glTF', clips: clips.length > 0 ? clips : [posed] };
}

interface Track {
  node: number;
  times: Float32Array;
  values: Float32Array;
  mode: string;
}

/** An animation at spec.fps; null when it turns no joint of the body. */
function sample(
  file: GltfFile,
  tree: GltfTree,
  animation: GltfAnimation,
  needed: ReadonlySet<number>,
  toPose: (world: Float64Array, out: Float32Array, offset: number) => void,
): PoseSequence | null {
  const tracks: Track[] = [];
  for (const { sampler, target } of animation.channels) {
    if (target.path !== 'rotation' || target.node === undefined || !needed.has(target.node)) continue;
    const source = animation.samplers[sampler];
    if (!source) throw new Error('An animation of this glTF file is damaged.');
    const [times, values] = [file.numbers(source.input), file.numbers(source.output)];
    const size = source.interpolation === 'CUBICSPLINE' ? 12 : 4;
    if (times.length === 0 || values.length < times.length * size)
      throw new Error('An animation of this glTF file is damaged.');
    tracks.push({ node: target.node, times, values, mode: source.interpolation });
  }
  if (tracks.length === 0) return null;
  const start = Math.min(...tracks.map(({ times }) => times[0]));
  const length = Math.max(...tracks.map(({ times }) => times[times.length - 1])) - start;
  const fps = Math.min(spec.fps, length > 0 ? (MAX_FRAMES - 1) / length : spec.fps);
  // Times are 32-bit: ten minutes in, they are off by a thousandth of a frame.
  const frames = Math.floor(Math.max(0, length) * fps + 0.01) + 1;
  const quaternions = new Float32Array(frames * JOINT_COUNT * 4);
  const local = [...tree.rotations];
  for (let frame = 0; frame < frames; frame++) {
    for (const track of tracks) local[track.node] = valueAt(track, start + frame / fps);
    toPose(worldOf(tree, local).rotations, quaternions, frame * JOINT_COUNT * 4);
  }
  return { name: animation.name ?? '', fps: frames > 1 ? fps : 0, frames, quaternions };
}

/** A rotation between keys (specification, appendix C). */
function valueAt({ times, values, mode }: Track, time: number): number[] {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const cubic = mode === 'CUBICSPLINE';
  const size = cubic ? 12 : 4;
  const key = (at: number, part = cubic ? 4 : 0) => Array.from(values.subarray(at * size + part, at * size + part + 4));
  if (time <= times[low] || high === low) return canonicalQuaternion(key(low));
  if (time >= times[high]) return canonicalQuaternion(key(high));
  const span = times[high] - times[low];
  const t = (time - times[low]) / span;
  if (mode === 'STEP') return canonicalQuaternion(key(low));
  if (!cubic) return slerp(canonicalQuaternion(key(low)), canonicalQuaternion(key(high)), t);
  const [out, into] = [key(low, 8), key(high, 0)];
  const [a, b] = [key(low), key(high)];
  const [t2, t3] = [t * t, t * t * t];
  return canonicalQuaternion(
    a.map(
      (value, k) =>
        (2 * t3 - 3 * t2 + 1) * value +
        span * (t3 - 2 * t2 + t) * out[k] +
        (-2 * t3 + 3 * t2) * b[k] +
        span * (t3 - t2) * into[k],
    ),
  );
}
