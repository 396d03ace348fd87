/** A character of the visitor's own that dances in the place of our figure: the file's objects, moved by what our dance means for its bones. */
import { Box3, Group, Mesh, MeshBasicMaterial, SphereGeometry, type Object3D } from 'three';
import { AvatarRetargeter, type AvatarFrame } from '../core/avatar/retarget';
import { readAvatarRig, type AvatarRig } from '../core/avatar/rig';
import { REST } from '../core/rest';
import { forwardKinematics, JOINT_COUNT, jointIndex } from '../core/skeleton';
import type { FramePose } from '../core/types';
import { disposeScene, loadAvatar, prepareMeshes, type LoadedAvatar } from './avatar-load';

/** What a character is made from; can be posted to a worker. */
export interface AvatarSource {
  /** The whole file: .vrm, .glb or self-contained .gltf. */
  bytes: Uint8Array;
  name: string;
  /** For each of our 24 joints the file's node; -1 = none. */
  map: readonly number[];
}

/** Height of our own figure's head joint and what is above it, metres: what a character's size is told by. */
export const OWN_HEIGHT = REST[jointIndex('head') * 3 + 1] + 0.19;

/** A longer step than this is a jump to another place of the dance, seconds. */
const LONGEST_STEP = 0.25;
/** With hair and hat nobody is taller than this many times the body. */
const MOST_HAIR = 1.6;
/** After a jump hair and skirts fall for this many steps of a thirtieth of a second. */
const SETTLING_STEPS = 15;

/**
 * Builds a character. Works where there is no page.
 * @param rig of the file, where it was read before
 * @throws Error with a sentence for the visitor when the file cannot be shown
 */
export async function openAvatar(
  { bytes, map }: AvatarSource,
  rig: AvatarRig = readAvatarRig(bytes),
): Promise<AvatarFigure> {
  const loaded = await loadAvatar(bytes, rig.kind !== 'glTF');
  return new AvatarFigure(rig, loaded, map);
}

/** The character. Give it poses; add `object` to a scene. */
export class AvatarFigure {
  readonly object = new Group();
  /** World places and turns of our joints in its body, after the last pose: metres, and x y z w. */
  readonly pose = { joints: new Float32Array(JOINT_COUNT * 3), rotations: new Float32Array(JOINT_COUNT * 4) };
  private retargeter: AvatarRetargeter | null = null;
  private frame: AvatarFrame | null = null;
  private map: readonly number[] = [];
  /** The last pose; it counts once one was shown. */
  private readonly last = { root: new Float32Array(3), quaternions: new Float32Array(JOINT_COUNT * 4) };
  private posed = false;
  private dot: Mesh | null = null;
  private marked: number | null = null;
  /** From the soles to the top of hair and hat, the file's units. */
  private readonly extent: number;
  /** The nodes as the file has them. */
  private readonly rest: ReadonlyMap<Object3D, { position: number[]; turn: number[] }>;

  constructor(
    readonly rig: AvatarRig,
    private readonly loaded: LoadedAvatar,
    map: readonly number[],
  ) {
    this.object.add(loaded.scene);
    const objects = loaded.nodes.filter((node) => node !== undefined);
    this.rest = new Map(
      objects.map((node) => [node, { position: node.position.toArray(), turn: node.quaternion.toArray() }]),
    );
    const { min, max } = new Box3().setFromObject(loaded.scene);
    this.extent = max.y - min.y;
    this.setMap(map);
  }

  /** Metres on the stage, with hair and hat. */
  get height(): number {
    if (!this.retargeter) return OWN_HEIGHT;
    const { height, displayScale } = this.retargeter;
    // A file that lies down, or brings a room along, is no taller for it.
    const whole = this.extent > height && this.extent < height * MOST_HAIR ? this.extent : height;
    return whole * displayScale;
  }

  /** Its height over our figure's. */
  get size(): number {
    return this.height / OWN_HEIGHT;
  }

  /** How far it goes for a metre of our dance. */
  get stride(): number {
    return this.retargeter ? this.retargeter.scale * this.retargeter.displayScale : 1;
  }

  /** Other bones. With bones that it cannot dance with it stands still. */
  setMap(map: readonly number[]): void {
    this.map = [...map];
    try {
      this.retargeter = new AvatarRetargeter(this.rig, [...map]);
    } catch {
      this.retargeter = null;
    }
    this.frame = this.retargeter?.createFrame() ?? null;
    for (const [node, { position, turn }] of this.rest) {
      node.position.fromArray(position);
      node.quaternion.fromArray(turn);
    }
    this.loaded.scene.scale.setScalar(this.retargeter?.displayScale ?? 1);
    prepareMeshes(this.loaded.scene, this.height);
    if (this.posed) this.show(this.last);
  }

  /** Puts a dot on the bone of a joint of ours; null = on none. */
  mark(joint: number | null): void {
    this.marked = joint;
    this.placeDot();
  }

  /**
   * Moves the character.
   * @param seconds of the dance since the frame before: hair and skirts swing on; without it, or after a jump, they come to rest anew
   */
  show(pose: FramePose, seconds = 0): void {
    this.last.root.set(pose.root);
    this.last.quaternions.set(pose.quaternions);
    this.posed = true;
    const { retargeter, frame } = this;
    if (retargeter && frame) {
      retargeter.frame(pose, frame);
      retargeter.nodes.forEach((node, i) => this.loaded.nodes[node]?.quaternion.fromArray(frame.rotations, i * 4));
      this.loaded.nodes[retargeter.nodes[0]]?.position.fromArray(frame.hips);
    }
    this.object.updateWorldMatrix(true, true);
    this.swing(seconds);
    this.readJoints(pose);
    this.placeDot();
  }

  /** Frees everything. */
  dispose(): void {
    disposeScene(this.object);
    this.object.removeFromParent();
  }

  private swing(seconds: number): void {
    const { vrm } = this.loaded;
    if (!vrm) return;
    if (seconds > 0 && seconds <= LONGEST_STEP) return vrm.update(seconds);
    vrm.springBoneManager?.reset();
    for (let step = 0; step < SETTLING_STEPS; step++) vrm.update(1 / 30);
  }

  private readJoints(pose: FramePose): void {
    const { joints, rotations } = this.pose;
    forwardKinematics(pose.quaternions, pose.root, joints, rotations);
    for (let joint = 0; joint < JOINT_COUNT; joint++) {
      const node = this.loaded.nodes[this.map[joint]];
      for (let k = 0; k < 3; k++) {
        const at = joint * 3 + k;
        joints[at] = node && this.retargeter ? node.matrixWorld.elements[12 + k] : joints[at] * this.stride;
      }
    }
  }

  private placeDot(): void {
    const node = this.marked === null ? undefined : this.loaded.nodes[this.map[this.marked]];
    if (!node) {
      if (this.dot) this.dot.visible = false;
      return;
    }
    this.dot ??= this.makeDot();
    this.dot.visible = true;
    this.dot.position.setFromMatrixPosition(node.matrixWorld);
  }

  private makeDot(): Mesh {
    const material = new MeshBasicMaterial({
      color: '#ffb454',
      depthTest: false,
      transparent: true,
      toneMapped: false,
    });
    const dot = new Mesh(new SphereGeometry(0.035 * this.size, 16, 12), material);
    dot.renderOrder = 10;
    this.object.add(dot);
    return dot;
  }
}
