/**
 * A real dance from a file: its poses on the beats of the song, to be danced anew in between (paper A, "dance regeneration": key poses of
 * a real dance are kept, the music is kept, all the rest is made again), or its beginning as a starting clip.
 */
import { cleanContacts } from './contact';
import type { PoseSequence } from './formats/pose-sequence';
import { clipId } from './clip-id';
import { aboutY, headingOf } from './localframe';
import { emptyMotion, framePose } from './motion';
import { resampleMotion } from './motion-resample';
import { REST_HEIGHT } from './rest';
import { multiply, quaternionsToPose, slerp } from './rotation';
import { JOINT_COUNT } from './skeleton';
import { spec } from './spec';
import type { Motion, SeedClip } from './types';

const POSE = JOINT_COUNT * 4;
/** Shorter is no motion, seconds. */
const SHORTEST = 0.5;
/** A starting clip has this many beats, and poses a beat. */
const BEATS = 8;
const RATE = 8;

/** What is asked of a file that holds a motion. */
const checked = ({ frames, fps }: PoseSequence, from: number): void => {
  if (!(fps > 0) || (frames - 1 - from) / fps < SHORTEST) {
    throw new Error('There is too little motion after this frame: choose an earlier one.');
  }
};

/** From a frame on, turned to face the front in that frame, at a rate above 0; the pelvis stays where it is. */
function dance(clip: PoseSequence, from: number): Motion {
  const frames = clip.frames - from;
  const quaternions = clip.quaternions.slice(from * POSE);
  const turn = aboutY(-headingOf(quaternions.subarray(0, 4)));
  const root = new Float32Array(frames * 3);
  for (let frame = 0; frame < frames; frame++) {
    const at = frame * POSE;
    quaternions.set(multiply(turn, quaternions.subarray(at, at + 4)), at);
    root[frame * 3 + 1] = REST_HEIGHT;
  }
  return { fps: clip.fps, frames, root, quaternions };
}

/**
 * The poses of a dance at song times, in real time.
 * @param clip - Of the file.
 * @param from - The frame that falls on `start`.
 * @param times - Seconds of the song, ascending.
 * @param start - Seconds of the song.
 * @returns those times that the dance reaches, with 24 x 3 axis-angle each
 * @throws Error with a sentence for the visitor when there is no motion after the frame
 */
export function posesAtTimes(
  clip: PoseSequence,
  from: number,
  times: readonly number[],
  start: number,
): { time: number; rotations: number[] }[] {
  checked(clip, from);
  const motion = dance(clip, from);
  const last = (motion.frames - 1) / motion.fps;
  // Half a frame after its end the dance is still at its end.
  return times
    .filter((time) => time >= start - 1e-6 && time - start <= last + 0.5 / motion.fps)
    .map((time) => ({ time, rotations: quaternionsToPose(framePose(motion, time - start).quaternions) }));
}

/**
 * Eight beats of a dance as a starting clip: its feet on the floor, its end led back into its beginning over the last beat, so that it
 * can go round. The same eight beats have the same id.
 * @param from - The frame that is beat 0.
 * @param tempo - Beats per minute that the dance is in.
 * @param name - For people.
 * @throws Error with a sentence for the visitor when there is no motion after the frame
 */
export function seedFromClip(clip: PoseSequence, from: number, tempo: number, name: string): SeedClip {
  checked(clip, from);
  const motion = onFloor(resampleMotion(dance(clip, from), spec.fps));
  const length = Math.min((BEATS * 60) / tempo, (motion.frames - 1) / motion.fps);
  const count = BEATS * RATE;
  const first = framePose(motion, 0);
  const end = framePose(motion, length);
  const poses: number[][] = [];
  const root: SeedClip['root'] = [];
  for (let i = 0; i < count; i++) {
    const { quaternions, root: place } = framePose(motion, (i / count) * length);
    const late = Math.max(0, (i - (count - RATE)) / RATE);
    const blend = late * late * (3 - 2 * late);
    for (let at = 0; at < POSE; at += 4) {
      const joint = quaternions.subarray(at, at + 4);
      slerp(joint, first.quaternions.subarray(at, at + 4), blend, joint);
    }
    poses.push(quaternionsToPose(quaternions).map(short));
    // What the dance travels in the eight beats is taken back evenly.
    const back = (k: number) => place[k] - first.root[k] - ((end.root[k] - first.root[k]) * i) / count;
    root.push([short(back(0)), short(place[1] * (1 - blend) + first.root[1] * blend), short(back(2))]);
  }
  const id = clipId(poses, root);
  return {
    id,
    name: name.slice(0, 60),
    description: `Eight beats of “${name.slice(0, 60)}”.`,
    beats: BEATS,
    rate: RATE,
    poses,
    root,
  };
}

const short = (value: number) => Number(value.toFixed(4)) + 0;

/** The pelvis's way found from the feet, which files of other skeletons tell best. */
function onFloor(motion: Motion): Motion {
  const seconds = Math.min(motion.frames, 30 * spec.fps);
  const out = { ...emptyMotion(motion.frames), fps: motion.fps };
  out.quaternions.set(motion.quaternions);
  out.root.set(motion.root);
  cleanContacts(motion, out, 0, seconds, { keys: [] });
  return { ...out, frames: seconds };
}
