/**
 * A starting clip of the visitor's own in a link: its name and description (texts), beats and poses a beat (bytes); its rotations in the
 * steps of key poses, number by number through time, each as the way from the one before (a signed byte, modulo 256); the pelvis's places
 * in steps of {@link PLACE}, axis by axis, in the same way (signed). What is read has the id that such a clip gets when it is made here.
 */
import { clipId } from '../clip-id';
import { POSE_SIZE } from '../document-schema';
import type { SeedClip } from '../types';
import { DamagedBytes, type ByteReader, type ByteWriter } from './byte-pack';
import { radians, rounded } from './share-pose';

/** Steps of a metre: half a centimetre, less than a rounded hip moves a foot. */
const PLACE = 200;
/** As in the document's schema. */
const MAX_BEATS = 32;
const MAX_RATE = 16;

/** Writes a clip. */
export function writeSeed(out: ByteWriter, { name, description, beats, rate, poses, root }: SeedClip): void {
  out.text(name);
  out.text(description);
  out.byte(beats);
  out.byte(rate);
  const steps = poses.map(rounded);
  for (let i = 0; i < POSE_SIZE; i += 1) steps.forEach((pose, t) => out.byte(pose[i] - (steps[t - 1]?.[i] ?? 0)));
  const places = root.map((place) => place.map((value) => Math.round(value * PLACE)));
  for (let k = 0; k < 3; k += 1) places.forEach((place, t) => out.signed(place[k] - (places[t - 1]?.[k] ?? 0)));
}

/**
 * Reads a clip; its poses and texts are unchecked.
 * @throws DamagedBytes
 */
export function readSeed(from: ByteReader): SeedClip {
  const [name, description, beats, rate] = [from.text(), from.text(), from.byte(), from.byte()];
  if (beats < 1 || beats > MAX_BEATS || rate < 1 || rate > MAX_RATE) throw new DamagedBytes('The clip has no length.');
  const poses = Array.from({ length: beats * rate }, () => new Array<number>(POSE_SIZE).fill(0));
  for (let i = 0; i < POSE_SIZE; i += 1) {
    let step = 0;
    for (const pose of poses) pose[i] = radians((step = ((step + from.byte()) << 24) >> 24));
  }
  const root = poses.map((): [number, number, number] => [0, 0, 0]);
  for (let k = 0; k < 3; k += 1) {
    let step = 0;
    for (const place of root) place[k] = (step += from.signed()) / PLACE;
  }
  return { id: clipId(poses, root), name, description, beats, rate, poses, root };
}
