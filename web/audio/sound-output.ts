/** Where the sound goes: the device, opened when sound is first wanted, and its volume. */

/** Makes an AudioContext; tests give their own. */
export type ContextFactory = () => AudioContext;

/** The volume eases to a new one within about this time constant, seconds. */
const EASE = 0.015;

/** The sound device of a player. */
export class SoundOutput {
  readonly #createContext: ContextFactory;
  readonly #stateChanged: () => void;
  #context: AudioContext | null = null;
  #gain: GainNode | null = null;
  #volume = 0.9;
  #muted = false;

  /** @param stateChanged - Told when the browser lets the device run, or takes it away. */
  constructor(createContext: ContextFactory, stateChanged: () => void) {
    this.#createContext = createContext;
    this.#stateChanged = stateChanged;
  }

  /** The device; null until it was opened. */
  get context(): AudioContext | null {
    return this.#context;
  }
  /** The device, where it runs. */
  get running(): AudioContext | null {
    return this.#context?.state === 'running' ? this.#context : null;
  }
  /** What is connected here is heard at the volume; null until the device was opened. */
  get node(): AudioNode | null {
    return this.#gain;
  }
  /** 0..1. */
  get volume(): number {
    return this.#volume;
  }
  set volume(volume: number) {
    this.#volume = Math.min(Math.max(volume, 0), 1);
    this.#apply();
  }
  /** True when no sound is wanted. */
  get muted(): boolean {
    return this.#muted;
  }
  set muted(muted: boolean) {
    this.#muted = muted;
    this.#apply();
  }

  /** Opens the device, which may still wait for a click. */
  open(): AudioContext {
    if (this.#context) return this.#context;
    const context = this.#createContext();
    this.#context = context;
    this.#gain = context.createGain();
    this.#gain.connect(context.destination);
    this.#apply();
    context.addEventListener('statechange', this.#stateChanged);
    return context;
  }

  /** Closes the device. */
  close(): void {
    void this.#context?.close();
    this.#context = null;
  }

  #apply(): void {
    if (!this.#gain || !this.#context) return;
    // Squared, as ears hear it.
    this.#gain.gain.setTargetAtTime(this.#muted ? 0 : this.#volume ** 2, this.#context.currentTime, EASE);
  }
}
