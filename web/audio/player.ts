/** The clock of the house: what `time()` says is what is heard, and everything that moves asks it. */
import type { LoopRange, Segment } from './segment';
import { SongCourse } from './song-course';
import { SoundOutput, type ContextFactory } from './sound-output';

export type { LoopRange } from './segment';
export type { ContextFactory } from './sound-output';

/** What other sounds need to go with the song. */
export interface Score {
  context: AudioContext;
  /** Volume and mute apply to what is connected here. */
  output: AudioNode;
  /** How the song lies on the context's clock from now on. */
  segment: Segment;
}

/** Slowest and fastest playback. */
export const SPEED_RANGE = { min: 0.25, max: 1.5 } as const;
/** The shortest loop, seconds. */
const MIN_LOOP = 0.1;

/**
 * Plays one decoded buffer and tells where in it the listener is.
 *
 * While the browser keeps sound locked (no click yet) or the player is muted from the start, it runs on the timer; the moment sound may
 * run, it starts at the place where the timer will be when the first sample is heard, so the handover has no jump.
 */
export class Player {
  readonly #output: SoundOutput;
  readonly #course: SongCourse;
  readonly #listeners = new Set<() => void>();
  #duration = 0;
  #playing = false;
  #position = 0;
  #speed = 1;
  #loop: LoopRange | null = null;
  #bounds: LoopRange | null = null;

  /**
   * @param createContext - Makes the AudioContext, called when sound is first wanted.
   * @param now - Milliseconds of a steady clock.
   */
  constructor(createContext: ContextFactory = () => new AudioContext(), now: () => number = () => performance.now()) {
    this.#output = new SoundOutput(createContext, () => this.#onStateChange());
    this.#course = new SongCourse(this.#output, now, () => ({
      duration: this.#duration,
      speed: this.#speed,
      loop: this.#loop,
      end: this.#last,
      partly: this.#bounds !== null,
    }));
  }

  /** True while the song runs. */
  get playing(): boolean {
    return this.#playing;
  }
  /** Playback rate, 1 = as recorded. */
  get speed(): number {
    return this.#speed;
  }
  /** The repeated stretch, or null. */
  get loop(): LoopRange | null {
    return this.#loop;
  }
  /** The part of the song that is played at all, or null. */
  get bounds(): LoopRange | null {
    return this.#bounds;
  }
  /** How the song lies on the sound device's clock; null while it is not heard. */
  get score(): Score | null {
    const segment = this.#course.latest;
    if (!this.#playing || !this.#course.audible || segment?.clock !== 'audio') return null;
    return { context: this.#output.context!, output: this.#output.node!, segment };
  }
  /** 0..1. */
  get volume(): number {
    return this.#output.volume;
  }
  /** True when no sound is wanted. */
  get muted(): boolean {
    return this.#output.muted;
  }
  /** Which clock drives the time now. */
  get clock(): 'audio' | 'timer' {
    return this.#course.audible ? 'audio' : 'timer';
  }

  /** Calls back after every change of state (not of time). Returns the way to stop that. */
  onChange(callback: () => void): () => void {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  /** Takes another song; the former one stops. Without a buffer (still decoding) the timer can already run. */
  load(duration: number, buffer: AudioBuffer | null): void {
    this.#course.stop();
    this.#playing = false;
    this.#position = 0;
    this.#loop = null;
    this.#bounds = null;
    this.#duration = duration;
    this.#course.buffer = buffer;
    this.#changed();
  }

  /** Gives the sound of a song that already runs; it joins in without a jump. */
  attach(buffer: AudioBuffer): void {
    this.#course.buffer = buffer;
    this.#duration = buffer.duration;
    this.#course.joinSound();
    this.#changed();
  }

  /** Starts at the current position; from the end it starts again. */
  play(): void {
    if (this.#playing || this.#duration <= 0) return;
    const start = this.#loop?.start ?? this.#first;
    const end = this.#loop?.end ?? this.#last;
    if (this.#position >= end - 1e-3) this.#position = start;
    this.#playing = true;
    this.#course.startAt(this.#position);
    this.#changed();
  }

  /** Stops where it is. */
  pause(): void {
    if (!this.#playing) return;
    this.#position = this.time();
    this.#playing = false;
    this.#course.stop();
    this.#changed();
  }

  /** Goes to a time in seconds; outside the song, or the part of it that is played, it goes to the nearest end. */
  seek(time: number): void {
    const target = Math.min(Math.max(Number.isFinite(time) ? time : 0, this.#first), this.#last);
    this.#position = this.#loop && this.#playing && target >= this.#loop.end ? this.#loop.start : target;
    if (this.#playing) this.#course.startAt(this.#position);
    this.#changed();
  }

  /** Repeats a stretch, or with null plays through. */
  setLoop(range: LoopRange | null): void {
    if (range) {
      range = this.#inside(range);
      if (!range) return;
    }
    const before = this.#loop;
    if (before?.start === range?.start && before?.end === range?.end) return;
    this.#loop = range;
    if (this.#playing) {
      if (range && this.time() >= range.end) this.#course.startAt(range.start);
      else this.#course.continue();
    }
    this.#changed();
  }

  /** Plays only a part of the song, or with null all of it; a loop that reaches beyond is cut, one outside it ends. */
  setBounds(range: LoopRange | null): void {
    const before = this.#bounds;
    const position = this.time();
    this.#bounds = null;
    const next = range && this.#inside(range);
    this.#bounds = next && (next.start > 0 || next.end < this.#duration) ? next : null;
    if (before?.start === this.#bounds?.start && before?.end === this.#bounds?.end) return;
    if (this.#loop) this.#loop = this.#inside(this.#loop);
    if (!this.#playing) this.#position = Math.min(Math.max(position, this.#first), this.#last);
    else if (position < this.#first || position >= this.#last) this.#course.startAt(this.#loop?.start ?? this.#first);
    else this.#course.continue();
    this.#changed();
  }

  /** Playback rate within SPEED_RANGE; the pitch follows, as on a record player. */
  setSpeed(speed: number): void {
    if (!Number.isFinite(speed)) return;
    this.#speed = Math.min(Math.max(speed, SPEED_RANGE.min), SPEED_RANGE.max);
    if (this.#playing) this.#course.continue();
    this.#changed();
  }

  /** 0..1. */
  setVolume(volume: number): void {
    this.#output.volume = volume;
    this.#changed();
  }

  /** Turning sound on inside a click also unlocks it in browsers that ask for one. */
  setMuted(muted: boolean): void {
    this.#output.muted = muted;
    if (!muted) this.unlock();
    this.#changed();
  }

  /** Opens the sound device; call it in a click. Does nothing while muted. */
  unlock(): void {
    if (this.#output.muted) return;
    const context = this.#output.open();
    if (context.state !== 'running') void context.resume().catch(() => undefined);
    else this.#course.joinSound();
  }

  /** Where in the song the listener is now, seconds. */
  time(): number {
    return this.#playing ? this.#course.time() : this.#position;
  }

  /** Stops at the end of the song, or of its part. Call it once a frame. */
  tick(): void {
    if (this.#playing && !this.#loop && this.time() >= this.#last) this.pause();
  }

  /** Closes the sound device. */
  dispose(): void {
    this.pause();
    this.#listeners.clear();
    this.#output.close();
  }

  get #first(): number {
    return this.#bounds?.start ?? 0;
  }

  get #last(): number {
    return Math.min(this.#bounds?.end ?? this.#duration, this.#duration);
  }

  /** A range within what is played; null when too little of it is left to hear. */
  #inside(range: LoopRange): LoopRange | null {
    const start = Math.max(this.#first, Math.min(range.start, range.end));
    const end = Math.min(this.#last, Math.max(range.start, range.end));
    return end - start < MIN_LOOP ? null : { start, end };
  }

  #onStateChange(): void {
    if (this.#output.running) this.#course.joinSound();
    else this.#course.leaveSound();
    this.#changed();
  }

  #changed(): void {
    for (const listener of this.#listeners) listener();
  }
}
