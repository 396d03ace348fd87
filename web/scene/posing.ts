import { Group, MathUtils, Object3D, Raycaster, Vector2, Vector3, type Camera, type Scene } from 'three';
import { TransformControls } from 'three/addons/controls/TransformControls.js';
import { PARENTS } from '../core/skeleton';
import { pickBody, standingRoot } from './body-points';
import type { Figure } from './figure';
import { ACCENT, Handles } from './handles';
import { jointLabel, PoseEdit } from './pose-edit';

/** What the pointer is over: for a label beside it. */
export interface JointHover {
  joint: number;
  /** Plain-English name. */
  label: string;
  /** CSS pixels from the stage's top left corner. */
  x: number;
  y: number;
}

/** What posing needs from the stage. */
export interface PosingHost {
  camera: Camera;
  element: HTMLElement;
  scene: Scene;
  figure: () => Figure | null;
  /** Draws again. */
  changed: () => void;
  /** Orbiting on or off. */
  orbit: (on: boolean) => void;
}

/** Keyboard turns within this time are one change, so that holding a key is one step to undo. Milliseconds. */
const NUDGE_PAUSE = 450;
/** How far a pointer may move and still click, CSS pixels. */
const CLICK_SLACK = 6;

/** Pose mode: select a joint by its dot or its limb, turn it with a gizmo (forward kinematics). */
export class Posing {
  readonly edit = new PoseEdit();
  readonly selectListeners = new Set<(joint: number | null) => void>();
  readonly hoverListeners = new Set<(hover: JointHover | null) => void>();
  readonly handles = new Handles();
  /** Made when pose mode is first entered: most visitors watch before they pose. */
  private gizmo: TransformControls | null = null;
  /** Stands for the joint's parent and the joint; the gizmo turns the inner one. */
  private readonly frame = new Group();
  private readonly proxy = new Object3D();
  private readonly abort = new AbortController();
  private readonly ray = new Raycaster();
  private active = false;
  private selected: number | null = null;
  private hovered: number | null = null;
  private pressed: { x: number; y: number; id: number } | null = null;
  private nudgeTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly host: PosingHost) {
    this.frame.add(this.proxy);
    this.frame.visible = false;
    host.scene.add(this.frame, this.handles.points);
    this.listen();
  }

  /** Enters or leaves pose mode. */
  setActive(active: boolean): void {
    if (!active) {
      this.cancelDrag();
      this.flush();
      this.select(null);
      this.hover(null);
    }
    this.active = active;
    if (active) this.gizmo ??= this.createGizmo();
    this.handles.points.visible = active;
    if (active) this.refresh();
    this.host.changed();
  }

  /** Shows a pose to edit, 24 x 3 axis-angle; the selection stays. A drag under way ends without a trace. */
  load(rotations: ArrayLike<number>): void {
    this.endDrag();
    this.flush();
    this.edit.load(rotations);
    if (this.active) this.refresh();
  }

  /** Selects a joint, or none. */
  select(joint: number | null): void {
    if (joint === this.selected) return;
    this.flush();
    this.selected = joint;
    if (this.gizmo) {
      if (joint === null) this.gizmo.detach();
      else this.gizmo.attach(this.proxy);
      this.gizmo.enabled = joint !== null;
      this.gizmo.getHelper().visible = joint !== null;
    }
    this.refresh();
    for (const listener of this.selectListeners) listener(joint);
  }

  /** Turns the selected joint about one of its own axes; quick repeats are one change. */
  nudge(axis: 'x' | 'y' | 'z', radians: number): void {
    if (!this.active || this.selected === null || this.dragging) return;
    this.edit.rotate(this.selected, axis, radians);
    this.refresh();
    clearTimeout(this.nudgeTimer);
    this.nudgeTimer = setTimeout(() => this.flush(), NUDGE_PAUSE);
  }

  /** Draws the edited pose: figure on the floor, dots and gizmo on its joints. */
  refresh(): void {
    const figure = this.host.figure();
    if (!figure || !this.active) return;
    const { quaternions } = this.edit;
    figure.show({ root: standingRoot(quaternions), quaternions });
    this.handles.place(figure.pose.joints);
    this.handles.mark(this.hovered, this.selected);
    if (this.selected !== null) {
      const { joints, rotations } = figure.pose;
      const parent = PARENTS[this.selected];
      this.frame.position.fromArray(joints, this.selected * 3);
      if (parent < 0) this.frame.quaternion.identity();
      else this.frame.quaternion.fromArray(rotations, parent * 4);
      this.proxy.quaternion.fromArray(quaternions, this.selected * 4);
      this.frame.updateMatrixWorld(true);
    }
    this.host.changed();
  }

  /** Stops listening and frees the gizmo. */
  dispose(): void {
    clearTimeout(this.nudgeTimer);
    this.abort.abort();
    this.gizmo?.detach();
    this.gizmo?.dispose();
    this.handles.dispose();
  }

  private createGizmo(): TransformControls {
    const gizmo = new TransformControls(this.host.camera, this.host.element);
    gizmo.setMode('rotate');
    gizmo.setSpace('local');
    gizmo.setSize(0.62);
    gizmo.setColors('#ff7a70', '#7fd18b', '#6aa8ff', ACCENT);
    gizmo.showXYZE = false;
    gizmo.enabled = false;
    gizmo.getHelper().visible = false;
    this.host.scene.add(gizmo.getHelper());
    gizmo.addEventListener('change', this.host.changed);
    gizmo.addEventListener('mouseDown', () => {
      clearTimeout(this.nudgeTimer);
      this.edit.commit();
      this.edit.start();
    });
    gizmo.addEventListener('objectChange', () => {
      if (this.selected === null || !this.edit.open) return;
      this.edit.setJoint(this.selected, this.proxy.quaternion.toArray());
      this.refresh();
    });
    gizmo.addEventListener('mouseUp', () => this.edit.commit());
    gizmo.addEventListener('dragging-changed', ({ value }) => this.host.orbit(!value));
    return gizmo;
  }

  private get dragging(): boolean {
    return this.gizmo?.dragging ?? false;
  }

  private listen(): void {
    const { element } = this.host;
    const { signal } = this.abort;
    element.addEventListener('pointermove', (event) => this.onMove(event), { signal });
    element.addEventListener('pointerleave', () => this.hover(null), { signal });
    element.addEventListener(
      'pointerdown',
      (event) => {
        this.pressed =
          event.isPrimary && event.button === 0 ? { x: event.clientX, y: event.clientY, id: event.pointerId } : null;
        if (this.dragging) this.pressed = null;
      },
      { signal },
    );
    element.addEventListener('pointerup', (event) => this.onUp(event), { signal });
    element.addEventListener('pointercancel', () => this.cancelDrag(), { signal });
    const key = (event: KeyboardEvent) => {
      this.gizmo?.setRotationSnap(event.shiftKey ? MathUtils.degToRad(15) : null);
      if (event.type === 'keydown' && event.key === 'Escape' && this.edit.open) {
        event.stopPropagation();
        this.cancelDrag();
      }
    };
    // Captured, so that Esc takes a drag back before any other shortcut hears it.
    for (const type of ['keydown', 'keyup'] as const) window.addEventListener(type, key, { signal, capture: true });
  }

  private onMove(event: PointerEvent): void {
    if (!this.active || this.dragging || event.buttons !== 0) return;
    this.hover(this.gizmo?.axis ? null : this.at(event));
  }

  private onUp(event: PointerEvent): void {
    const { pressed } = this;
    this.pressed = null;
    if (!this.active || !pressed || pressed.id !== event.pointerId || this.dragging) return;
    if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK_SLACK) return;
    this.select(this.at(event));
  }

  /** Joint under the pointer: a dot within reach, else the limb that is hit. */
  private at(event: PointerEvent): number | null {
    const figure = this.host.figure();
    if (!figure) return null;
    const box = this.host.element.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const reach = event.pointerType === 'mouse' ? 12 : 20;
    const dot = this.handles.nearest(x, y, reach, this.host.camera, box.width, box.height);
    if (dot !== null) return dot;
    this.ray.setFromCamera(new Vector2((x / box.width) * 2 - 1, 1 - (y / box.height) * 2), this.host.camera);
    const { origin, direction } = this.ray.ray;
    return pickBody(origin.toArray(), direction.toArray(), figure.pose.joints, figure.pose.rotations);
  }

  private hover(joint: number | null): void {
    if (joint === this.hovered) return;
    this.hovered = joint;
    this.handles.mark(joint, this.selected);
    this.host.element.style.cursor = joint === null ? '' : 'pointer';
    this.host.changed();
    const hover = joint === null ? null : this.labelAt(joint);
    for (const listener of this.hoverListeners) listener(hover);
  }

  private labelAt(joint: number): JointHover | null {
    const figure = this.host.figure();
    if (!figure) return null;
    const v = new Vector3().fromArray(figure.pose.joints, joint * 3).project(this.host.camera);
    const { width, height } = this.host.element.getBoundingClientRect();
    return { joint, label: jointLabel(joint), x: ((v.x + 1) / 2) * width, y: ((1 - v.y) / 2) * height };
  }

  /** Keeps a keyboard change that is still open. */
  private flush(): void {
    clearTimeout(this.nudgeTimer);
    this.nudgeTimer = undefined;
    if (!this.dragging) this.edit.commit();
  }

  private cancelDrag(): void {
    clearTimeout(this.nudgeTimer);
    this.endDrag();
    if (!this.edit.open) return;
    this.edit.cancel();
    this.refresh();
  }

  private endDrag(): void {
    if (!this.gizmo?.dragging) return;
    this.gizmo.dragging = false;
    this.gizmo.axis = null;
  }
}
