/** The loop that draws the stage: once a screen refresh at the most, and with less quality where that comes too late. */
import type { QualityGovernor } from './framing';

/** What the loop drives. */
export interface FrameHost {
  /** Moves what moves by itself, by seconds; says whether there is anything to draw. */
  update(seconds: number): boolean;
  /** The governor has lowered the quality. */
  lowerQuality(): void;
  render(): void;
}

/** Runs from `start` to `stop`. */
export class FrameLoop {
  private readonly callbacks = new Set<(now: number) => void>();
  /** When frames were drawn in the last second, performance.now(). */
  private readonly draws: number[] = [];
  private before = 0;
  private drewBefore = false;
  private request = 0;

  constructor(
    private readonly governor: QualityGovernor,
    private readonly host: FrameHost,
  ) {}

  /** Begins with the next screen refresh. */
  start(): void {
    this.request = requestAnimationFrame(this.tick);
  }

  /** Ends for good. */
  stop(): void {
    cancelAnimationFrame(this.request);
  }

  /** Calls back before each screen refresh, with performance.now(). Returns how to stop that. */
  beforeFrame(callback: (now: number) => void): () => void {
    this.callbacks.add(callback);
    return () => this.callbacks.delete(callback);
  }

  /** Frames drawn in the last second. */
  get fps(): number {
    const now = performance.now();
    return this.draws.filter((time) => now - time < 1000).length;
  }

  private readonly tick = (now: number): void => {
    this.request = requestAnimationFrame(this.tick);
    const elapsed = now - this.before;
    this.before = now;
    for (const callback of this.callbacks) callback(now);
    const draw = this.host.update(Math.min(Math.max(elapsed, 0), 100) / 1000);
    if (draw) {
      if (this.drewBefore && this.governor.sample(elapsed)) this.host.lowerQuality();
      this.host.render();
      this.draws.push(now);
      while (now - this.draws[0] > 1000) this.draws.shift();
    }
    this.drewBefore = draw;
  };
}
