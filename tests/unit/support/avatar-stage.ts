/** An avatar as three shows it: what its bones and its soles do while it dances. */
import { SkinnedMesh, Vector3, type Matrix4, type Object3D } from 'three';
import { GLTFLoader, type GLTF } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { guessBones } from '../../../web/core/avatar/guess';
import { AvatarRetargeter, type AvatarFrame } from '../../../web/core/avatar/retarget';
import { readAvatarRig, type AvatarRig } from '../../../web/core/avatar/rig';
import type { BoneMap } from '../../../web/core/avatar/bones';
import { frameView } from '../../../web/core/motion';
import { jointIndex } from '../../../web/core/skeleton';
import type { Motion } from '../../../web/core/types';

export const loadGlb = (bytes: Uint8Array<ArrayBuffer>): Promise<GLTF> =>
  new GLTFLoader().parseAsync(bytes.slice().buffer, '');

/** The object of each node of the file. */
export function objectsOf({ scene, parser }: GLTF): Map<number, Object3D> {
  const objects = new Map<number, Object3D>();
  scene.traverse((object) => {
    const node = (parser.associations.get(object) as { nodes?: number } | undefined)?.nodes;
    if (node !== undefined) objects.set(node, object);
  });
  return objects;
}

/** A loaded avatar that dances. */
export interface AvatarStage {
  rig: AvatarRig;
  bones: BoneMap;
  retargeter: AvatarRetargeter;
  /** Puts it into a frame of the dance. */
  show(motion: Motion, frame: number): AvatarFrame;
  /** World place of our joint's bone. */
  place(joint: string): Vector3;
  /** Lowest vertex of a foot. */
  sole(side: 'left' | 'right'): number;
  gltf: GLTF;
}

export async function stageAvatar(bytes: Uint8Array<ArrayBuffer>): Promise<AvatarStage> {
  const rig = readAvatarRig(bytes);
  const { bones } = guessBones(rig);
  const retargeter = new AvatarRetargeter(rig, bones);
  const gltf = await loadGlb(bytes);
  const objects = objectsOf(gltf);
  const frame = retargeter.createFrame();
  const at = (joint: string) => objects.get(bones[jointIndex(joint)])!;
  const feet = {
    left: verticesOf(gltf, ['left_ankle', 'left_foot'].map(at)),
    right: verticesOf(gltf, ['right_ankle', 'right_foot'].map(at)),
  };
  return {
    rig,
    bones,
    retargeter,
    gltf,
    show(motion, t) {
      retargeter.frame(frameView(motion, t), frame);
      retargeter.nodes.forEach((node, i) => objects.get(node)!.quaternion.fromArray(frame.rotations, i * 4));
      objects.get(retargeter.nodes[0])!.position.fromArray(frame.hips);
      gltf.scene.updateMatrixWorld(true);
      return frame;
    },
    place: (joint) => new Vector3().setFromMatrixPosition(at(joint).matrixWorld),
    sole: (side) =>
      feet[side].reduce(
        (low, { bone, from }) => Math.min(low, from.clone().applyMatrix4(bone.matrixWorld).y),
        Infinity,
      ),
  };
}

/** The vertices that bones carry, in their axes. */
function verticesOf({ scene }: GLTF, bones: readonly Object3D[]): { bone: Object3D; from: Vector3 }[] {
  const found: { bone: Object3D; from: Vector3 }[] = [];
  scene.traverse((object) => {
    if (!(object instanceof SkinnedMesh)) return;
    const { position, skinIndex } = object.geometry.attributes;
    for (let i = 0; i < position.count; i++) {
      const index = skinIndex.getX(i);
      const bone = object.skeleton.bones[index];
      const inverse: Matrix4 = object.skeleton.boneInverses[index];
      if (bones.includes(bone))
        found.push({ bone, from: new Vector3().fromBufferAttribute(position, i).applyMatrix4(inverse) });
    }
  });
  return found;
}
