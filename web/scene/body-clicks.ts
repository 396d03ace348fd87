import { Raycaster, Vector2, type Camera } from 'three';
import { pickBody } from './body-points';

/** Whoever dances: world places and turns of the joints, 24 x 3 and 24 x 4. */
interface Clickable {
  pose: { joints: Float32Array; rotations: Float32Array };
}

/** How far a pointer may move and still click, CSS pixels. */
const CLICK_SLACK = 6;

/** Clicks on the limbs of a figure. It listens to nothing until somebody wants to know. */
export class BodyClicks {
  private readonly listeners = new Set<(joint: number) => void>();
  private readonly ray = new Raycaster();
  private readonly abort = new AbortController();
  private pressed: { x: number; y: number; id: number } | null = null;

  /** @param figure the one to hit, or null while clicks do not count */
  constructor(
    private readonly element: HTMLElement,
    private readonly camera: Camera,
    private readonly figure: () => Clickable | null,
  ) {
    const { signal } = this.abort;
    element.addEventListener('pointerdown', (event) => this.down(event), { signal });
    element.addEventListener('pointerup', (event) => this.up(event), { signal });
    element.addEventListener('pointercancel', () => (this.pressed = null), { signal });
  }

  /** Listens to clicks; returns how to stop. */
  listen(listener: (joint: number) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Stops listening. */
  dispose(): void {
    this.abort.abort();
  }

  private down(event: PointerEvent): void {
    const counts = event.isPrimary && event.button === 0 && this.listeners.size > 0;
    this.pressed = counts ? { x: event.clientX, y: event.clientY, id: event.pointerId } : null;
  }

  private up(event: PointerEvent): void {
    const { pressed } = this;
    this.pressed = null;
    const figure = this.figure();
    if (!pressed || !figure || pressed.id !== event.pointerId) return;
    if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK_SLACK) return;
    const box = this.element.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * 2 - 1;
    const y = 1 - ((event.clientY - box.top) / box.height) * 2;
    this.ray.setFromCamera(new Vector2(x, y), this.camera);
    const { origin, direction } = this.ray.ray;
    const joint = pickBody(origin.toArray(), direction.toArray(), figure.pose.joints, figure.pose.rotations);
    if (joint !== null) for (const listener of this.listeners) listener(joint);
  }
}
