import type { LoopRange } from './segment';

/** Fade in and out at every start and stop, so that seeks do not click, seconds. */
const FADE = 0.006;

/** How a song starts to sound. */
export interface SourceStart {
  /** Seconds of the context's clock. */
  from: number;
  /** Seconds of the song. */
  position: number;
  rate: number;
  loop: LoopRange | null;
  /** Seconds of the song where the sound ends by itself, also while nothing ticks (the page is in the background); null = its own end. */
  end: number | null;
}

/** One sounding of the song, from its start to its stop. */
export class SongSource {
  readonly #node: AudioBufferSourceNode;
  readonly #fade: GainNode;

  /** Begins to sound through `output`. */
  constructor(context: AudioContext, output: AudioNode, buffer: AudioBuffer, start: SourceStart) {
    const { from, position, rate, loop, end } = start;
    const node = context.createBufferSource();
    const { gain } = (this.#fade = context.createGain());
    this.#node = node;
    node.buffer = buffer;
    node.playbackRate.value = rate;
    gain.setValueAtTime(0, from);
    gain.linearRampToValueAtTime(1, from + FADE);
    node.connect(this.#fade).connect(output);
    if (loop) {
      node.loop = true;
      node.loopStart = loop.start;
      node.loopEnd = loop.end;
      node.start(from, position);
    } else if (end === null) {
      node.start(from, position);
    } else {
      const length = Math.max(0, end - position);
      const over = Math.max(from + FADE, from + length / rate);
      gain.setValueAtTime(1, Math.max(from + FADE, over - FADE));
      gain.linearRampToValueAtTime(0, over);
      node.start(from, position, length);
    }
  }

  /** Fades out from a time of the context's clock on, seconds. */
  stop(at: number): void {
    const { gain } = this.#fade;
    gain.setValueAtTime(1, at);
    gain.linearRampToValueAtTime(0, at + FADE);
    this.#node.stop(at + FADE);
    this.#node.onended = () => this.#fade.disconnect();
  }
}
