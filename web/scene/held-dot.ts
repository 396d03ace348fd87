/** A joint's dot that is held by the pointer: it moves in the plane through the joint that faces the camera. */
import { Plane, Vector3, type Camera } from 'three';
import type { Picker } from './picker';

/** Step of a drag while Shift is held, metres. */
const STEP = 0.05;

/** One dot, from the press on. */
export class HeldDot {
  private readonly plane: Plane;
  /** Where in the plane the pointer was. */
  private readonly pressed: Vector3;

  /** @param from where the joint is, metres in the world */
  constructor(
    private readonly picker: Picker,
    camera: Camera,
    private readonly from: readonly [number, number, number],
    press: PointerEvent,
  ) {
    const joint = new Vector3(...from);
    this.plane = new Plane().setFromNormalAndCoplanarPoint(camera.getWorldDirection(new Vector3()), joint);
    this.pressed = picker.aim(press).intersectPlane(this.plane, new Vector3()) ?? joint;
  }

  /** Where the pointer wants the joint, metres in the world; null where it points past the plane. */
  at(event: PointerEvent): number[] | null {
    const point = this.picker.aim(event).intersectPlane(this.plane, new Vector3());
    if (!point) return null;
    const way = point.sub(this.pressed).toArray();
    return way.map((c, i) => this.from[i] + (event.shiftKey ? Math.round(c / STEP) * STEP : c));
  }
}
