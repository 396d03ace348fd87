/** Camera maths without a camera: how far to stand back, and how a follow point eases after the dancer. */

/** What the opening view must hold: a standing figure with raised arms, metres. */
export const FIGURE_BOX = { height: 2.16, width: 1.7, depth: 0.8 };

/**
 * Distance at which a box facing a perspective camera fits the view, from the camera to the box's centre, metres.
 * @param fieldOfView vertical, radians
 * @param aspect width over height of the view
 * @param margin share of the view left free on each axis, 0..1
 */
export function framingDistance(
  fieldOfView: number,
  aspect: number,
  box: { height: number; width: number; depth: number } = FIGURE_BOX,
  margin = 0.08,
): number {
  const tangent = Math.tan(fieldOfView / 2) * (1 - margin);
  return Math.max(box.height / 2 / tangent, box.width / 2 / (tangent * aspect)) + box.depth / 2;
}

/** A value that eases towards a goal as a critically damped spring: quickest without overshoot. */
export class Spring {
  velocity = 0;

  /** @param settle about the time to cover most of the way, seconds */
  constructor(
    public value: number,
    private readonly settle: number,
  ) {}

  /** Moves on by `seconds` (exact for a goal that stands still) and returns the new value. */
  step(goal: number, seconds: number): number {
    const rate = 2 / this.settle;
    const offset = this.value - goal;
    const push = (this.velocity + rate * offset) * seconds;
    const decay = Math.exp(-rate * seconds);
    this.velocity = (this.velocity - rate * push) * decay;
    this.value = goal + (offset + push) * decay;
    return this.value;
  }
}

/** Frame times, milliseconds: slower than `late` is worth less resolution, slower than `crawl` fewer triangles too. */
const PACE = { aim: 18, late: 24, crawl: 60 };

/** Lowers the drawing resolution and the level of detail while frames are late. */
export class QualityGovernor {
  /** Level of detail that the machine can draw, 0 the finest. */
  detail = 0;
  private times: number[] = [];
  private readonly floor: number;

  /** @param ratio device pixels per CSS pixel at best quality */
  constructor(public ratio: number) {
    this.floor = Math.min(0.5, ratio);
  }

  /**
   * Takes the time between two frames drawn one after the other, milliseconds.
   * @returns whether quality has changed
   */
  sample(milliseconds: number): boolean {
    // A tab that slept says nothing about speed.
    if (milliseconds > 3000) return false;
    this.times.push(milliseconds);
    const elapsed = this.times.reduce((sum, time) => sum + time, 0);
    // A second of frames, but never so few that one hiccup decides.
    if (this.times.length < 5 || (this.times.length < 60 && elapsed < 1000)) return false;
    const median = this.times.sort((a, b) => a - b)[this.times.length >> 1];
    this.times = [];
    // 24 ms: slower than 42 frames a second, so neither a 50 Hz nor a 60 Hz screen's own pace.
    if (median < PACE.late || (this.ratio <= this.floor && this.detail > 0)) return false;
    if (median > PACE.crawl || this.ratio <= this.floor) this.detail = 1;
    this.ratio = Math.max(this.floor, this.ratio * Math.max(0.6, Math.sqrt(PACE.aim / median)));
    return true;
  }
}
