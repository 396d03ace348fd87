/** What the clock needs of an AudioContext. */
export interface ClockContext {
  readonly currentTime: number;
  readonly baseLatency?: number;
  readonly outputLatency?: number;
  getOutputTimestamp?: () => AudioTimestamp;
}

/** A larger step than this is a real jump (device change, sleep), not jitter: follow it at once. */
const JUMP_SECONDS = 0.05;
/** Share of each reading that enters the estimate; the context's own time comes in steps of a render buffer. */
const BLEND = 0.08;
/** An output timestamp that lies further behind the context's time than this is not believed. */
const MAX_LATENCY_SECONDS = 1;

/**
 * Context time of the sound that leaves the speakers now.
 *
 * The audio hardware is the clock: each reading is tied to it, so nothing can drift. Readings come in steps of a render buffer,
 * therefore the OFFSET between the two clocks is smoothed, never the time itself.
 */
export class HeardClock {
  #offset: number | null = null;

  /**
   * @param context - The running context.
   * @param nowMilliseconds - `performance.now()`.
   * @returns Seconds on the context's time axis.
   */
  read(context: ClockContext, nowMilliseconds: number): number {
    const now = nowMilliseconds / 1000;
    const measured = rawHeard(context, nowMilliseconds) - now;
    if (this.#offset === null || Math.abs(measured - this.#offset) > JUMP_SECONDS) this.#offset = measured;
    else this.#offset += (measured - this.#offset) * BLEND;
    return now + this.#offset;
  }

  /** Forgets the estimate; needed after the context was suspended. */
  reset(): void {
    this.#offset = null;
  }
}

function rawHeard(context: ClockContext, nowMilliseconds: number): number {
  const stamp = context.getOutputTimestamp?.();
  if (stamp?.contextTime !== undefined && stamp.performanceTime !== undefined && stamp.contextTime > 0) {
    const heard = stamp.contextTime + (nowMilliseconds - stamp.performanceTime) / 1000;
    const latency = context.currentTime - heard;
    if (latency > -JUMP_SECONDS && latency < MAX_LATENCY_SECONDS) return heard;
  }
  return context.currentTime - (context.outputLatency || context.baseLatency || 0);
}
