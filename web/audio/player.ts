/** The clock of the house: what `time()` says is what is heard, and everything that moves asks it. */
import { HeardClock } from './heard-clock';
import { positionAt, type LoopRange, type Segment } from './segment';
import { SongSource } from './song-source';
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

/** Sources start this much in the future, so that the start is exact to the sample. */
const START_DELAY = 0.02;
/** Slowest and fastest playback. */
export const SPEED_RANGE = { min: 0.25, max: 1.5 } as const;
/** The shortest loop, seconds. */
export const MIN_LOOP = 0.1;

/**
 * Plays one decoded buffer and tells where in it the listener is.
 *
 * While the browser keeps sound locked (no click yet) or the player is muted from the start, it runs on the timer; the moment sound may
 * run, it starts at the place where the timer will be when the first sample is heard, so the handover has no jump.
 */
export class Player {
  readonly #output: SoundOutput;
  readonly #now: () => number;
  readonly #heard = new HeardClock();
  readonly #listeners = new Set<() => void>();
  #source: SongSource | null = null;
  #buffer: AudioBuffer | null = null;
  #duration = 0;
  #playing = false;
  #position = 0;
  #segments: Segment[] = [];
  #speed = 1;
  #loop: LoopRange | null = null;
  #bounds: LoopRange | null = null;

  /**
   * @param createContext - Makes the AudioContext, called when sound is first wanted.
   * @param now - Milliseconds of a steady clock.
   */
  constructor(createContext: ContextFactory = () => new AudioContext(), now: () => number = () => performance.now()) {
    this.#output = new SoundOutput(createContext, () => this.#onStateChange());
    this.#now = now;
  }

  /** Seconds. */
  get duration(): number {
    return this.#duration;
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
    const segment = this.#segments.at(-1);
    if (!this.#playing || !this.#audible() || segment?.clock !== 'audio') return null;
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
    return this.#audible() ? 'audio' : 'timer';
  }

  /** Calls back after every change of state (not of time). Returns the way to stop that. */
  onChange(callback: () => void): () => void {
    this.#listeners.add(callback);
    return () => this.#listeners.delete(callback);
  }

  /** Takes another song; the former one stops. Without a buffer (still decoding) the timer can already run. */
  load(duration: number, buffer: AudioBuffer | null): void {
    this.#stopSource();
    this.#playing = false;
    this.#segments = [];
    this.#position = 0;
    this.#loop = null;
    this.#bounds = null;
    this.#duration = duration;
    this.#buffer = buffer;
    this.#changed();
  }

  /** Gives the sound of a song that already runs; it joins in without a jump. */
  attach(buffer: AudioBuffer): void {
    this.#buffer = buffer;
    this.#duration = buffer.duration;
    if (this.#playing) this.#resumeSound();
    this.#changed();
  }

  /** Starts at the current position; from the end it starts again. */
  play(): void {
    if (this.#playing || this.#duration <= 0) return;
    const start = this.#loop?.start ?? this.#first;
    const end = this.#loop?.end ?? this.#last;
    if (this.#position >= end - 1e-3) this.#position = start;
    this.#playing = true;
    this.#startAt(this.#position);
    this.#changed();
  }

  /** Stops where it is. */
  pause(): void {
    if (!this.#playing) return;
    this.#position = this.time();
    this.#playing = false;
    this.#stopSource();
    this.#segments = [];
    this.#changed();
  }

  /** Goes to a time in seconds; outside the song, or the part of it that is played, it goes to the nearest end. */
  seek(time: number): void {
    const target = Math.min(Math.max(Number.isFinite(time) ? time : 0, this.#first), this.#last);
    this.#position = this.#loop && this.#playing && target >= this.#loop.end ? this.#loop.start : target;
    if (this.#playing) this.#startAt(this.#position);
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
      if (range && this.time() >= range.end) this.#startAt(range.start);
      else this.#continue();
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
    else if (position < this.#first || position >= this.#last) this.#startAt(this.#loop?.start ?? this.#first);
    else this.#continue();
    this.#changed();
  }

  /** Playback rate within SPEED_RANGE; the pitch follows, as on a record player. */
  setSpeed(speed: number): void {
    if (!Number.isFinite(speed)) return;
    this.#speed = Math.min(Math.max(speed, SPEED_RANGE.min), SPEED_RANGE.max);
    if (this.#playing) this.#continue();
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
    else if (this.#playing && !this.#source) this.#resumeSound();
  }

  /** Where in the song the listener is now, seconds. */
  time(): number {
    if (!this.#playing) return this.#position;
    return this.#positionOf(this.#activeSegment());
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

  #audible(): boolean {
    return this.#source !== null && this.#output.running !== null;
  }

  /** A fresh start at a position: what was heard before no longer counts. */
  #startAt(position: number): void {
    this.#stopSource();
    if (!this.#output.muted) this.#output.open();
    const { running, context, muted } = this.#output;
    if (running && this.#buffer) {
      const from = running.currentTime + START_DELAY;
      this.#segments = [this.#startSource(from, position)];
      return;
    }
    this.#segments = [this.#timerSegment(position)];
    if (context && !muted) void context.resume().catch(() => undefined);
  }

  /** New speed or loop from where the sound is being rendered, so that the listener hears no jump. */
  #continue(): void {
    const { context } = this.#output;
    const last = this.#segments.at(-1);
    if (!last) return;
    if (last.clock === 'audio' && context && this.#audible()) {
      const from = context.currentTime + START_DELAY;
      const position = this.#positionOf(last, from);
      this.#stopSource(from);
      this.#segments.push(
        this.#startSource(from, this.#loop && position >= this.#loop.end ? this.#loop.start : position),
      );
    } else {
      this.#segments = [this.#timerSegment(this.time())];
    }
  }

  /** From the timer to the sound: the source starts where the timer will be when its first sample is heard. */
  #resumeSound(): void {
    const context = this.#output.running;
    if (!this.#playing || !this.#buffer || !context || this.#source) return;
    this.#heard.reset();
    const timer = this.#segments.at(-1);
    if (!timer) return;
    const from = context.currentTime + START_DELAY;
    const untilHeard = from - this.#clockTime('audio');
    const position = this.#positionOf(timer, this.#clockTime('timer') + untilHeard);
    this.#segments = [timer, this.#startSource(from, position)];
  }

  #timerSegment(position: number): Segment {
    return this.#segment('timer', this.#now() / 1000, position);
  }

  #startSource(from: number, position: number): Segment {
    this.#source = new SongSource(this.#output.context!, this.#output.node!, this.#buffer!, {
      from,
      position: Math.min(position, Math.max(0, this.#duration - 1e-3)),
      rate: this.#speed,
      loop: this.#loop,
      end: this.#bounds ? this.#last : null,
    });
    return this.#segment('audio', from, position);
  }

  #segment(clock: Segment['clock'], from: number, position: number): Segment {
    return { clock, from, position, rate: this.#speed, loop: this.#loop, end: this.#last };
  }

  #stopSource(at = this.#output.context?.currentTime ?? 0): void {
    this.#source?.stop(at);
    this.#source = null;
  }

  #onStateChange(): void {
    if (this.#output.running) {
      this.#resumeSound();
    } else if (this.#playing && this.#source) {
      // The device was taken away (a call, sleep): the dance goes on silently and the sound joins in again later.
      const position = this.time();
      this.#stopSource();
      this.#heard.reset();
      this.#segments = [this.#timerSegment(position)];
    }
    this.#changed();
  }

  #changed(): void {
    for (const listener of this.#listeners) listener();
  }
}
