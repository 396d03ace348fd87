/** The gizmo on the selected joint: arcs that turn it, or arrows that move it. */
import { Group, MathUtils, Object3D, type Camera, type Scene } from 'three';
import { TransformControls } from 'three/addons/controls/TransformControls.js';
import { ACCENT } from './handles';

/** Steps while Shift is held. */
const SNAP = { turn: MathUtils.degToRad(15), move: 0.05 };

/** What a drag of the gizmo reports. */
export interface GizmoListener {
  start(): void;
  /** The joint's local rotation, x y z w. */
  turned(q: number[]): void;
  /** Where the joint is wanted, metres. */
  moved(position: number[]): void;
  end(): void;
  changed(): void;
  /** Whether the gizmo has the pointer, so that nothing else takes it. */
  busy(on: boolean): void;
}

/** Wraps three's TransformControls round a stand-in for the joint. */
export class Gizmo {
  /** Stands for the joint's parent and the joint; the gizmo acts on the inner one. */
  private readonly frame = new Group();
  private readonly proxy = new Object3D();
  private readonly controls: TransformControls;

  constructor(camera: Camera, element: HTMLElement, scene: Scene, listener: GizmoListener) {
    this.frame.add(this.proxy);
    this.frame.visible = false;
    const controls = new TransformControls(camera, element);
    this.controls = controls;
    controls.setMode('rotate');
    controls.setSpace('local');
    controls.setSize(0.62);
    controls.setColors('#ff7a70', '#7fd18b', '#6aa8ff', ACCENT);
    controls.showXYZE = false;
    controls.enabled = false;
    controls.getHelper().visible = false;
    scene.add(this.frame, controls.getHelper());
    controls.addEventListener('change', () => listener.changed());
    controls.addEventListener('mouseDown', () => listener.start());
    controls.addEventListener('objectChange', () => {
      if (this.mode === 'rotate') listener.turned(this.proxy.quaternion.toArray());
      else listener.moved(this.proxy.position.toArray());
    });
    controls.addEventListener('mouseUp', () => listener.end());
    controls.addEventListener('dragging-changed', ({ value }) => listener.busy(value as boolean));
  }

  get mode(): 'rotate' | 'move' {
    return this.controls.mode === 'rotate' ? 'rotate' : 'move';
  }

  set mode(mode: 'rotate' | 'move') {
    this.controls.setMode(mode === 'rotate' ? 'rotate' : 'translate');
    // Small planes between the arrows would cover the dots round about; the dot itself is dragged in the view's plane.
    for (const plane of ['showXY', 'showYZ', 'showXZ'] as const) this.controls[plane] = mode === 'rotate';
  }

  set space(space: 'local' | 'world') {
    this.controls.setSpace(space);
  }

  set snapping(on: boolean) {
    this.controls.setRotationSnap(on ? SNAP.turn : null);
    this.controls.setTranslationSnap(on ? SNAP.move : null);
  }

  /** Whether it takes the pointer's presses. */
  set enabled(on: boolean) {
    this.controls.enabled = on;
    if (!on) this.controls.axis = null;
  }

  /** Whether it is being dragged. */
  get dragging(): boolean {
    return this.controls.dragging;
  }

  /** Whether the pointer is on one of its parts. */
  get hovered(): boolean {
    return this.controls.axis !== null;
  }

  /** Shows it, or takes it away. */
  show(on: boolean): void {
    if (on) this.controls.attach(this.proxy);
    else this.controls.detach();
    this.controls.enabled = on;
    this.controls.getHelper().visible = on;
  }

  /**
   * Puts it on a joint.
   * @param parent world rotation of the joint's parent
   * @param local the joint's own rotation
   * @param world the joint's world rotation
   */
  place(
    position: ArrayLike<number>,
    parent: ArrayLike<number>,
    local: ArrayLike<number>,
    world: ArrayLike<number>,
  ): void {
    const { frame, proxy } = this;
    if (this.mode === 'rotate') {
      frame.position.set(position[0], position[1], position[2]);
      frame.quaternion.set(parent[0], parent[1], parent[2], parent[3]);
      proxy.position.set(0, 0, 0);
      proxy.quaternion.set(local[0], local[1], local[2], local[3]);
    } else {
      frame.position.set(0, 0, 0);
      frame.quaternion.identity();
      // Under a drag the arrows stay with the pointer, even where the joint cannot follow.
      if (!this.dragging) {
        proxy.position.set(position[0], position[1], position[2]);
        proxy.quaternion.set(world[0], world[1], world[2], world[3]);
      }
    }
    frame.updateMatrixWorld(true);
  }

  /** Lets go of a drag without reporting its end. */
  release(): void {
    this.controls.dragging = false;
    this.controls.axis = null;
  }

  /** Stops listening and frees its shapes. */
  dispose(): void {
    this.controls.detach();
    this.controls.dispose();
    this.frame.removeFromParent();
  }
}
