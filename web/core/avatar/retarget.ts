/**
 * Our dance on an avatar, frame by frame. Every bone of arms, legs and back points where ours does; the way over the floor is scaled by
 * the length of the legs; feet near the floor go where ours go on that scale, by inverse kinematics of the legs, so that a foot that
 * stands for us stands for the avatar.
 */
import { HEEL_OFFSET, RADIUS } from '../contact-body';
import { smoothstep } from '../interpolate';
import { REST, REST_HEIGHT } from '../rest';
import { conjugate, multiply, rotateVector, slerp } from '../rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, JOINTS, PARENTS } from '../skeleton';
import { spec } from '../spec';
import type { FramePose } from '../types';
import { checkBones, type BoneMap } from './bones';
import { driveNodes, type DrivenNode } from './driven';
import { LONGEST, reachWithLeg } from './leg';
import { makeLegs, placeSole, type FootedLeg } from './footed-legs';
import type { AvatarRig } from './rig';
import { pointOf, quaternionOf } from '../vector';

/** What an avatar's nodes are set to. */
export interface AvatarFrame {
  /** Local rotations of `nodes`, nodes x 4 (x y z w). */
  rotations: Float32Array;
  /** Local translation of `nodes[0]`, 3 numbers in its parent's units. */
  hips: Float32Array;
}

const { toeHeight, feet } = spec.skeleton;
const HIPS = [jointIndex('left_hip'), jointIndex('right_hip')];
const HEAD = jointIndex('head');
/** How far above the floor a foot of ours still goes to its place exactly, and from where on it only keeps its angles, metres. */
const NEAR = 0.05;
const FAR = 0.2;
/** Of a head's joint, the share of it that the rest of the head adds to a body's height. */
const CROWN = 1.12;
/** Avatars between these heights are shown as they are, metres. */
const SHORTEST = 0.4;
const TALLEST = 4;
/** Joints whose flesh may touch the floor. Fingers hang on the wrist: they are as far below it as ours. */
const FLESH = [...RADIUS]
  .filter(([joint]) => joint !== 0)
  .map(([joint, radius]) => {
    const node = JOINTS[joint].endsWith('hand') ? PARENTS[joint] : joint;
    return { joint, radius, node };
  });

/** Carries our poses over to an avatar. The same pose always gives the same frame, whatever came before. */
export class AvatarRetargeter {
  /** The file's nodes that are turned, each after its parent; the first is the hips, the only one that is moved too. */
  readonly nodes: readonly number[];
  /** The avatar's leg over ours: scene units per metre of our dance. */
  readonly scale: number;
  /** Height of the avatar standing, about, scene units. */
  readonly height: number;
  /** What its scene is to be scaled by on the stage: 1 unless it is no human size in metres. */
  readonly displayScale: number;

  readonly #driven: readonly DrivenNode[];
  /** Of our joints: the place in the list of the node that is turned as it; -1 = none. */
  readonly #placeOf: readonly number[];
  readonly #legs: readonly FootedLeg[];
  /** World rotations and places of the list's nodes. */
  readonly #turns: Float64Array[];
  readonly #places: Float64Array[];
  readonly #above: { turn: Float64Array; place: Float64Array; size: Float64Array };
  /** How far the hips stand behind the middle of the feet, more than ours, metres of ours. */
  readonly #back: number;

  readonly #joints = new Float32Array(JOINT_COUNT * 3);
  readonly #ours = new Float32Array(JOINT_COUNT * 4);
  readonly #ourTurns: Float32Array[];
  readonly #a = new Float64Array(4);
  readonly #b = new Float64Array(4);
  readonly #p = new Float64Array(3);
  readonly #q = new Float64Array(3);

  /** @throws Error with the first blocking problem of the mapping */
  constructor(rig: AvatarRig, bones: Readonly<BoneMap>) {
    const problem = checkBones(rig, bones).find(({ blocking }) => blocking);
    if (problem) throw new Error(problem.message);
    const driven = driveNodes(rig, bones);
    this.#driven = driven;
    this.nodes = driven.map(({ node }) => node);
    this.#placeOf = bones.map((node) => (node < 0 ? -1 : this.nodes.indexOf(node)));
    this.#turns = driven.map(() => new Float64Array(4));
    this.#places = driven.map(() => new Float64Array(3));
    this.#ourTurns = Array.from({ length: JOINT_COUNT }, (_, i) => this.#ours.subarray(i * 4, i * 4 + 4));
    const parent = rig.parents[driven[0].node];
    this.#above = {
      turn: Float64Array.from(parent < 0 ? [0, 0, 0, 1] : quaternionOf(rig.world.rotations, parent)),
      place: Float64Array.from(parent < 0 ? [0, 0, 0] : pointOf(rig.world.positions, parent)),
      size: Float64Array.from(parent < 0 ? [1, 1, 1] : pointOf(rig.world.sizes, parent), (size) => size || 1),
    };
    this.#legs = makeLegs(rig, { driven, placeOf: this.#placeOf, places: this.#places, turns: this.#turns });
    // Standing as we stand at rest tells how much longer or shorter the avatar's legs are.
    const rest: FramePose = {
      root: [0, REST_HEIGHT, 0],
      quaternions: Float32Array.from({ length: JOINT_COUNT * 4 }, (_, i) => (i % 4 === 3 ? 1 : 0)),
    };
    this.#turnNodes(rest);
    let lowest = Infinity;
    let ahead = 0;
    for (const leg of this.#legs) {
      placeSole(leg, this.#places, this.#turns, this.#q);
      lowest = Math.min(lowest, this.#places[leg.at.ankle][1] + leg.low);
      ahead += (this.#places[leg.at.ankle][2] + leg.ball[2]) / 2;
    }
    const [left, right] = this.#legs.map(({ at }) => this.#places[at.hip]);
    const middle = (left[1] + right[1]) / 2;
    this.scale = (middle - lowest) / middleOf(REST, HIPS[0], HIPS[1], 1);
    const ourAhead = middleOf(REST, feet.left.toe, feet.right.toe, 2) - middleOf(REST, HIPS[0], HIPS[1], 2);
    for (const leg of this.#legs) {
      const ourBall = REST[leg.foot.toe * 3] - middleOf(REST, HIPS[0], HIPS[1], 0);
      leg.aside = this.#places[leg.at.ankle][0] + leg.ball[0] - (left[0] + right[0]) / 2 - this.scale * ourBall;
    }
    this.#back = ahead - (left[2] + right[2]) / 2 - this.scale * ourAhead;
    const top = this.#placeOf[HEAD] >= 0 ? HEAD : jointIndex('left_shoulder');
    const share = REST[HEAD * 3 + 1] / REST[top * 3 + 1];
    this.height = (this.#places[this.#placeOf[top]][1] - lowest) * share * CROWN;
    const human = this.height >= SHORTEST && this.height <= TALLEST;
    this.displayScale = human ? 1 : (REST[HEAD * 3 + 1] * CROWN) / this.height;
    if (!(this.scale > 0) || !(this.height > 0))
      throw new Error('The legs of this avatar have no length: choose other bones.');
  }

  /** Room for a frame. */
  createFrame(): AvatarFrame {
    return { rotations: new Float32Array(this.nodes.length * 4), hips: new Float32Array(3) };
  }

  /**
   * One frame, without garbage.
   * @param pose metres, floor at y = 0
   * @returns out
   */
  frame(pose: FramePose, out: AvatarFrame): AvatarFrame {
    this.#turnNodes(pose);
    this.#placeBody();
    for (const leg of this.#legs) this.#bringFoot(leg);
    for (let i = 0; i < this.#driven.length; i++) {
      const { parent, between } = this.#driven[i];
      const above = parent < 0 ? this.#above.turn : multiply(this.#turns[parent], between, this.#a);
      conjugate(above, this.#a);
      const local = multiply(this.#a, this.#turns[i], this.#b);
      const size = Math.sqrt(local[0] * local[0] + local[1] * local[1] + local[2] * local[2] + local[3] * local[3]);
      for (let k = 0; k < 4; k++) out.rotations[i * 4 + k] = local[k] / size;
    }
    conjugate(this.#above.turn, this.#a);
    for (let k = 0; k < 3; k++) this.#p[k] = this.#places[0][k] - this.#above.place[k];
    rotateVector(this.#a, this.#p, this.#p);
    for (let k = 0; k < 3; k++) out.hips[k] = this.#p[k] / this.#above.size[k];
    return out;
  }

  /** World rotations, and places from the hips. */
  #turnNodes({ quaternions, root }: FramePose): void {
    forwardKinematics(quaternions, root, this.#joints, this.#ours);
    for (let i = 0; i < this.#driven.length; i++) {
      const { joint, other, share, parent, alignment, offset } = this.#driven[i];
      const [turn, place] = [this.#turns[i], this.#places[i]];
      if (share > 0) multiply(slerp(this.#ourTurns[joint], this.#ourTurns[other], share, this.#a), alignment, turn);
      else multiply(this.#ourTurns[joint], alignment, turn);
      if (parent < 0) {
        place.fill(0);
        continue;
      }
      rotateVector(this.#turns[parent], offset, place);
      for (let k = 0; k < 3; k++) place[k] += this.#places[parent][k];
    }
  }

  /** Where the body is to be, by where the feet are to be. */
  #placeBody(): void {
    const { scale } = this;
    const joints = this.#joints;
    const [left, right] = this.#legs;
    // The middle between the hip joints goes where ours goes, on the avatar's scale; the feet stand below as ours do.
    this.#q[0] = 0;
    this.#q[1] = 0;
    this.#q[2] = -this.#back;
    rotateVector(this.#ourTurns[0], this.#q, this.#q);
    this.#q[1] = 0;
    for (let k = 0; k < 3; k++) {
      this.#p[k] = scale * middleOf(joints, HIPS[0], HIPS[1], k) + this.#q[k] - (left.hip[k] + right.hip[k]) / 2;
    }
    this.#move();

    for (const leg of this.#legs) this.#aimFoot(leg);
    // Where thigh, shin and foot are not to each other as ours are, the body gives way and not the angles of the legs: what both feet
    // lack in the middle is made up for by the hips.
    const held = left.hold + right.hold;
    const share = held > 0 ? Math.max(left.hold, right.hold) / held : 0;
    for (let k = 0; k < 3; k++) {
      this.#p[k] =
        share * (left.hold * (left.target[k] - left.ankle[k]) + right.hold * (right.target[k] - right.ankle[k]));
    }
    this.#move();

    let drop = 0;
    for (const { thigh, shin, target, hip, hold } of this.#legs) {
      // A leg that is too short for the way brings the body down.
      const most = (thigh + shin) * LONGEST;
      const aside = Math.hypot(target[0] - hip[0], target[2] - hip[2]);
      const reach = Math.sqrt(Math.max(0, most * most - aside * aside));
      drop = Math.max(drop, hold * (hip[1] - target[1] - reach));
    }
    let lift = 0;
    for (const { joint, radius, node } of FLESH) {
      const at = this.#placeOf[node];
      if (at < 0) continue;
      const below = scale * (joints[joint * 3 + 1] - joints[node * 3 + 1]);
      lift = Math.max(lift, radius * scale - (this.#places[at][1] + below - drop));
    }
    this.#p[0] = 0;
    this.#p[1] = lift - drop;
    this.#p[2] = 0;
    this.#move();
  }

  /** Where a foot is to be, and how firmly. */
  #aimFoot(leg: FootedLeg): void {
    const { scale } = this;
    placeSole(leg, this.#places, this.#turns, this.#q);
    const clear = Math.max(0, this.#clearance(leg));
    leg.hold = 1 - smoothstep((clear - NEAR) / (FAR - NEAR));
    // Broad hips and straight feet keep their stance; as long as our foot does not turn, theirs stands still.
    this.#q.fill(0);
    this.#q[0] = leg.aside;
    rotateVector(this.#ourTurns[leg.foot.ankle], this.#q, this.#q);
    const ball = leg.foot.toe * 3;
    leg.target[0] = scale * this.#joints[ball] + this.#q[0] - leg.ball[0];
    leg.target[1] = scale * clear - leg.low;
    leg.target[2] = scale * this.#joints[ball + 2] + this.#q[2] - leg.ball[2];
  }

  /** Moves everything by #p. */
  #move(): void {
    for (const place of this.#places) for (let k = 0; k < 3; k++) place[k] += this.#p[k];
  }

  /** How far the lowest point of our foot is above the floor, metres. */
  #clearance({ foot }: FootedLeg): number {
    for (let k = 0; k < 3; k++) this.#q[k] = HEEL_OFFSET[k];
    rotateVector(this.#ourTurns[foot.ankle], this.#q, this.#q);
    return Math.min(this.#joints[foot.toe * 3 + 1], this.#joints[foot.ankle * 3 + 1] + this.#q[1]) - toeHeight;
  }

  /** Puts a foot where it is to be. */
  #bringFoot(leg: FootedLeg): void {
    if (leg.hold <= 0) return;
    for (let k = 0; k < 3; k++) leg.target[k] = leg.ankle[k] + leg.hold * (leg.target[k] - leg.ankle[k]);
    leg.across[0] = 1;
    leg.across[1] = 0;
    leg.across[2] = 0;
    // Our knee bends about its own X axis.
    rotateVector(this.#ourTurns[PARENTS[leg.foot.ankle]], leg.across, leg.across);
    reachWithLeg(leg, leg.target, leg.across);
  }
}

/** The middle of two joints along an axis. */
function middleOf(joints: Float32Array, a: number, b: number, axis: number): number {
  return (joints[a * 3 + axis] + joints[b * 3 + axis]) / 2;
}
