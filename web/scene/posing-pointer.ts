/** The pointer in pose mode: hovering, choosing, and grabbing a joint's dot to drag it. Mouse, pen and touch alike. */

/** What the pointer does; points are client coordinates, CSS pixels. */
export interface PointerHost {
  readonly active: boolean;
  /** The gizmo has the pointer. */
  readonly taken: boolean;
  /** Joint whose dot is under the pointer, where dots can be dragged. */
  grabbable(event: PointerEvent, claimed: boolean): number | null;
  /** Whether the press is on the chosen joint's own dot: that is for dragging it freely, although the arrows begin there too. */
  claim(event: PointerEvent): boolean;
  hover(event: PointerEvent | null): void;
  click(event: PointerEvent): void;
  /** A dot is held and begins to move. */
  grab(joint: number, from: PointerEvent): void;
  drag(event: PointerEvent): void;
  drop(): void;
  cancel(): void;
  /** Orbiting on or off. */
  orbit(on: boolean): void;
}

/** How far a pointer may move and still click, CSS pixels. */
const CLICK_SLACK = 6;

/** Listens to an element for as long as the signal is not aborted. */
export class PosePointer {
  private claimed = false;
  private pressed: { event: PointerEvent; dot: number | null; moving: boolean } | null = null;

  constructor(
    private readonly element: HTMLElement,
    private readonly host: PointerHost,
    signal: AbortSignal,
  ) {
    const listen = (type: 'pointerdown' | 'pointermove' | 'pointerup', act: (event: PointerEvent) => void) =>
      element.addEventListener(type, act, { signal });
    // Captured: claimed before the gizmo hears of the press, which otherwise has the first word.
    element.addEventListener(
      'pointerdown',
      (event) => (this.claimed = host.active && event.isPrimary && event.button === 0 && host.claim(event)),
      { signal, capture: true },
    );
    listen('pointerdown', (event) => this.down(event));
    listen('pointermove', (event) => this.move(event));
    listen('pointerup', (event) => this.up(event));
    element.addEventListener('pointerleave', () => host.hover(null), { signal });
    element.addEventListener(
      'pointercancel',
      () => {
        this.release();
        host.cancel();
      },
      { signal },
    );
  }

  /** Lets go of whatever is held, without a word to the host. */
  release(): void {
    if (this.pressed && this.pressed.dot !== null) this.host.orbit(true);
    this.pressed = null;
  }

  private down(event: PointerEvent): void {
    if (!event.isPrimary || event.button !== 0) return;
    this.pressed = null;
    if (!this.host.active || this.host.taken) return;
    const dot = this.host.grabbable(event, this.claimed);
    this.pressed = { event, dot, moving: false };
    if (dot === null) return;
    this.host.orbit(false);
    this.element.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    const { pressed, host } = this;
    if (!host.active || host.taken) return;
    if (!pressed) {
      if (event.buttons === 0) host.hover(event);
      return;
    }
    if (pressed.dot === null || pressed.event.pointerId !== event.pointerId) return;
    if (!pressed.moving) {
      if (!movedBy(pressed.event, event)) return;
      pressed.moving = true;
      host.grab(pressed.dot, pressed.event);
    }
    host.drag(event);
  }

  private up(event: PointerEvent): void {
    const { pressed, host } = this;
    if (!pressed || pressed.event.pointerId !== event.pointerId) return;
    this.release();
    if (!host.active) return;
    if (pressed.moving) host.drop();
    else if (!host.taken && !movedBy(pressed.event, event)) host.click(event);
  }
}

function movedBy(from: PointerEvent, to: PointerEvent): boolean {
  return Math.hypot(to.clientX - from.clientX, to.clientY - from.clientY) > CLICK_SLACK;
}
