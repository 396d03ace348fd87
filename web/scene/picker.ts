/** What the pointer is over in pose mode. */
import { Raycaster, Vector2, Vector3, type Camera, type Ray } from 'three';
import { pickBody } from './body-points';
import type { Figure } from './figure';
import type { Handles } from './handles';
import { jointLabel } from './pose-edit';

/** A joint under the pointer: for a label beside it. */
export interface JointHover {
  joint: number;
  /** Plain-English name. */
  label: string;
  /** CSS pixels from the stage's top left corner. */
  x: number;
  y: number;
}

/** What a joint's dot reaches, CSS pixels. */
const REACH = { mouse: 12, touch: 22 };

/** Finds joints under the pointer, by their dots and by the body. */
export class Picker {
  private readonly ray = new Raycaster();

  constructor(
    private readonly host: { camera: Camera; element: HTMLElement; figure: () => Figure | null },
    private readonly handles: Handles,
  ) {}

  /** The ray from the eye through the pointer; the same object each time. */
  aim(event: PointerEvent): Ray {
    const box = this.host.element.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.ray.setFromCamera(new Vector2(x * 2 - 1, 1 - y * 2), this.host.camera);
    return this.ray.ray;
  }

  /** Joint whose dot is within reach. */
  dot(event: PointerEvent): number | null {
    const { left, top, width, height } = this.host.element.getBoundingClientRect();
    const reach = event.pointerType === 'mouse' ? REACH.mouse : REACH.touch;
    return this.handles.nearest(event.clientX - left, event.clientY - top, reach, this.host.camera, width, height);
  }

  /** Joint under the pointer: a dot within reach, else the limb that is hit. */
  joint(event: PointerEvent): number | null {
    const figure = this.host.figure();
    if (!figure) return null;
    const dot = this.dot(event);
    if (dot !== null) return dot;
    const { origin, direction } = this.aim(event);
    return pickBody(origin.toArray(), direction.toArray(), figure.pose.joints, figure.pose.rotations);
  }

  /** Name and place of a joint on the screen. */
  label(joint: number): JointHover | null {
    const figure = this.host.figure();
    if (!figure) return null;
    const v = new Vector3().fromArray(figure.pose.joints, joint * 3).project(this.host.camera);
    const { width, height } = this.host.element.getBoundingClientRect();
    return { joint, label: jointLabel(joint), x: ((v.x + 1) / 2) * width, y: ((1 - v.y) / 2) * height };
  }
}
