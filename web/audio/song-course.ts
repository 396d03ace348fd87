/** How a song runs, on the sound device or, while that is silent, on the timer; and where in it the listener is. */
import { HeardClock } from './heard-clock';
import { positionAt, type LoopRange, type Segment } from './segment';
import { SongSource } from './song-source';
import type { SoundOutput } from './sound-output';

/** How the song is played from now on. */
export interface Manner {
  /** Of the whole song, seconds. */
  duration: number;
  speed: number;
  loop: LoopRange | null;
  /** Where it ends, seconds of the song. */
  end: number;
  /** That is before the song's own end. */
  partly: boolean;
}

/** Sources start this much in the future, so that the start is exact to the sample. */
const START_DELAY = 0.02;

/** The course of a song, from its start to its stop. */
export class SongCourse {
  /** The sound; null while it is still decoded. */
  buffer: AudioBuffer | null = null;
  readonly #output: SoundOutput;
  readonly #now: () => number;
  readonly #manner: () => Manner;
  readonly #heard = new HeardClock();
  #source: SongSource | null = null;
  /** What is heard now, and what comes next; none while the song stands. */
  #segments: Segment[] = [];

  /**
   * @param now - Milliseconds of a steady clock.
   * @param manner - Asked for whenever the song starts anew.
   */
  constructor(output: SoundOutput, now: () => number, manner: () => Manner) {
    this.#output = output;
    this.#now = now;
    this.#manner = manner;
  }

  /** Whether it is the sound device that the song runs on. */
  get audible(): boolean {
    return this.#source !== null && this.#output.running !== null;
  }

  /** How the song lies on its clock from now on; null while it stands. */
  get latest(): Segment | null {
    return this.#segments.at(-1) ?? null;
  }

  /** Where in the song the listener is now, seconds. Only while it runs. */
  time(): number {
    return this.#positionOf(this.#activeSegment());
  }

  /** A fresh start at a position: what was heard before no longer counts. */
  startAt(position: number): void {
    this.#stopSource();
    if (!this.#output.muted) this.#output.open();
    const { running, context, muted } = this.#output;
    if (running && this.buffer) {
      const from = running.currentTime + START_DELAY;
      this.#segments = [this.#startSource(from, position)];
      return;
    }
    this.#segments = [this.#timerSegment(position)];
    if (context && !muted) void context.resume().catch(() => undefined);
  }

  /** In a new manner from where the sound is being rendered, so that the listener hears no jump. */
  continue(): void {
    const { context } = this.#output;
    const last = this.latest;
    if (!last) return;
    if (last.clock === 'audio' && context && this.audible) {
      const { loop } = this.#manner();
      const from = context.currentTime + START_DELAY;
      const position = this.#positionOf(last, from);
      this.#stopSource(from);
      this.#segments.push(this.#startSource(from, loop && position >= loop.end ? loop.start : position));
    } else {
      this.#segments = [this.#timerSegment(this.time())];
    }
  }

  /** From the timer to the sound, where it runs: the source starts where the timer will be when its first sample is heard. */
  joinSound(): void {
    const context = this.#output.running;
    const timer = this.latest;
    if (!timer || !this.buffer || !context || this.#source) return;
    this.#heard.reset();
    const from = context.currentTime + START_DELAY;
    const untilHeard = from - this.#clockTime('audio');
    const position = this.#positionOf(timer, this.#clockTime('timer') + untilHeard);
    this.#segments = [timer, this.#startSource(from, position)];
  }

  /** The device was taken away (a call, sleep): the song goes on silently, and its sound joins in again later. */
  leaveSound(): void {
    if (!this.latest || !this.#source) return;
    const position = this.time();
    this.#stopSource();
    this.#heard.reset();
    this.#segments = [this.#timerSegment(position)];
  }

  /** Stands still. */
  stop(): void {
    this.#stopSource();
    this.#segments = [];
  }

  #activeSegment(): Segment {
    for (let i = this.#segments.length - 1; i > 0; i -= 1) {
      const segment = this.#segments[i];
      if (this.#clockTime(segment.clock) >= segment.from) {
        this.#segments.splice(0, i); // the listener has passed the ones before
        return segment;
      }
    }
    return this.#segments[0];
  }

  #clockTime(clock: Segment['clock']): number {
    const { context } = this.#output;
    return clock === 'timer' || !context ? this.#now() / 1000 : this.#heard.read(context, this.#now());
  }

  #positionOf(segment: Segment, at = this.#clockTime(segment.clock)): number {
    return positionAt(segment, at);
  }

  #timerSegment(position: number): Segment {
    return this.#segment('timer', this.#now() / 1000, position);
  }

  #startSource(from: number, position: number): Segment {
    const { duration, speed, loop, end, partly } = this.#manner();
    this.#source = new SongSource(this.#output.context!, this.#output.node!, this.buffer!, {
      from,
      position: Math.min(position, Math.max(0, duration - 1e-3)),
      rate: speed,
      loop,
      end: partly ? end : null,
    });
    return this.#segment('audio', from, position);
  }

  #segment(clock: Segment['clock'], from: number, position: number): Segment {
    const { speed, loop, end } = this.#manner();
    return { clock, from, position, rate: speed, loop, end };
  }

  #stopSource(at = this.#output.context?.currentTime ?? 0): void {
    this.#source?.stop(at);
    this.#source = null;
  }
}
