/** A click on every beat, laid on the sound device's own clock, so that ears can check the beats of a song. */
import type { BeatGrid } from '../core/types';
import { lowerBound } from '../core/snap';
import type { Player, Score } from './player';
import { passes, type Segment } from './segment';

/** Clicks are laid this far ahead, seconds: more than a timer may be late. */
const AHEAD = 0.3;
/** Milliseconds between two looks ahead. */
const LOOK = 60;
/** A click is a short tone: hertz of a bar's first beat and of the others, and its length in seconds. */
const TONE = { bar: 1760, beat: 1175, length: 0.045, loudness: 0.5 } as const;
/** A click this little before the present is still laid: now. */
const LATE = 0.01;

/** A click to come. */
export interface Click {
  /** Seconds of the device's clock. */
  at: number;
  /** First beat of a bar. */
  accent: boolean;
}

/**
 * The beats that are played between two times of the clock, around loops as often as they come.
 * @param after - Seconds of the segment's clock, inclusive.
 * @param until - Exclusive.
 */
export function clicksBetween(grid: BeatGrid, segment: Segment, after: number, until: number): Click[] {
  const bars = new Set(grid.downbeats);
  return passes(segment, after, until).flatMap(({ start, end, at }) => {
    // The first moment of a pass may lie a rounding error behind the beat it begins on.
    const from = lowerBound(grid.beats, start - 1e-9);
    const to = lowerBound(grid.beats, end - 1e-9);
    return grid.beats.slice(from, to).map((beat) => ({
      at: Math.max(at, at + (beat - start) / segment.rate),
      accent: bars.has(beat),
    }));
  });
}

/** Clicks along with a player. */
export class Metronome {
  readonly #player: Player;
  #grid: BeatGrid | null = null;
  #timer: ReturnType<typeof setInterval> | undefined;
  #stopListening: (() => void) | null = null;
  /** Clicks are laid up to here, for this segment. */
  #laid: { segment: Segment; until: number } | null = null;
  readonly #pending = new Set<{ node: OscillatorNode; at: number }>();

  /** @param player - Whose song to click along with. */
  constructor(player: Player) {
    this.#player = player;
  }

  /** True while it is switched on. */
  get on(): boolean {
    return this.#timer !== undefined;
  }

  /** Switches it on or off. */
  set(on: boolean): void {
    if (on === this.on) return;
    if (on) {
      this.#timer = setInterval(() => this.#lay(), LOOK);
      this.#stopListening = this.#player.onChange(() => this.#lay());
      this.#lay();
    } else {
      clearInterval(this.#timer);
      this.#timer = undefined;
      this.#stopListening?.();
      this.#clear();
    }
  }

  /** Other beats from now on. */
  follow(grid: BeatGrid | null): void {
    if (grid === this.#grid) return;
    this.#grid = grid;
    this.#clear();
    if (this.on) this.#lay();
  }

  #lay(): void {
    const { score } = this.#player;
    // A seek, a loop, another speed, a pause: what was laid for the former segment must not sound.
    if (this.#laid && score?.segment !== this.#laid.segment) this.#clear();
    if (!score || !this.#grid) return;
    const now = score.context.currentTime;
    const after = this.#laid?.until ?? Math.max(now - LATE, score.segment.from);
    const until = now + AHEAD;
    if (until <= after) return;
    for (const click of clicksBetween(this.#grid, score.segment, after, until)) this.#sound(score, click);
    this.#laid = { segment: score.segment, until };
  }

  #sound({ context, output }: Score, { at, accent }: Click): void {
    const start = Math.max(at, context.currentTime);
    const node = context.createOscillator();
    const gain = context.createGain();
    node.frequency.value = accent ? TONE.bar : TONE.beat;
    gain.gain.setValueAtTime(accent ? TONE.loudness : TONE.loudness * 0.6, start);
    gain.gain.exponentialRampToValueAtTime(1e-3, start + TONE.length);
    node.connect(gain).connect(output);
    node.start(start);
    node.stop(start + TONE.length);
    const pending = { node, at: start };
    this.#pending.add(pending);
    node.onended = () => {
      this.#pending.delete(pending);
      gain.disconnect();
    };
  }

  /** Takes back what has not sounded yet. */
  #clear(): void {
    this.#laid = null;
    for (const { node } of this.#pending) node.stop();
    this.#pending.clear();
  }
}
