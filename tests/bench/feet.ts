/**
 * How the feet stand in both engines' dances through the same suggested key poses, with the shipped models. Prints a Markdown table.
 *
 *     npx tsx tests/bench/feet.ts [--seconds=60] [SONG...]
 *
 * Songs are read with ffmpeg; without one it is a synthesised song.
 */
import { basename } from 'node:path';
import { measureDance } from '../../web/app/report';
import { bodyTrack } from '../../web/core/contact-body';
import type { Motion } from '../../web/core/types';
import { synthesise } from '../e2e/support/songs';
import { danceTo, decode, type Sound } from './dances';

const paths = process.argv.slice(2).filter((argument) => !argument.startsWith('--'));
const seconds = Number(/^--seconds=(\d+)$/.exec(process.argv.find((a) => a.startsWith('--seconds=')) ?? '')?.[1] ?? 60);

/** Deepest that anything is below the floor, metres. */
function deepest(motion: Motion): number {
  const { ground } = bodyTrack(motion);
  return ground.reduce((most, y, t) => Math.max(most, y - motion.root[t * 3 + 1]), 0);
}

const songs: [string, Sound][] = paths.length
  ? paths.map((path) => [basename(path).slice(0, 24), decode(path)])
  : [['synthesised', { samples: synthesise({ seconds }), rate: 44100 }]];
console.log('| song | engine | feet, cm/s | below floor, cm | jerk, m/s³ | speed, m/s | E_c |');
console.log('|---|---|---|---|---|---|---|');
for (const [name, { samples, rate }] of songs) {
  const sound = { samples: samples.subarray(0, seconds * rate), rate };
  const { keyPoses, curved, light } = await danceTo(sound, { light: true });
  for (const [engine, motion] of [
    ['light', light!],
    ['curves', curved],
  ] as const) {
    const { footSkate, jerk, meanSpeed, consistencyError } = measureDance(motion, keyPoses, null);
    const cells = [
      name,
      engine,
      (footSkate * 100).toFixed(1),
      (deepest(motion) * 100).toFixed(2),
      jerk.toFixed(0),
      meanSpeed.toFixed(2),
      consistencyError.toExponential(1),
    ];
    console.log(`| ${cells.join(' | ')} |`);
  }
}
