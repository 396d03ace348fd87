import type { Camera, Scene } from 'three';
import { DEFAULT_TOOLS } from '../core/default-tools';
import { PARENTS } from '../core/skeleton';
import type { PoseTools } from '../core/types';
import { BalanceOverlay } from './balance-overlay';
import type { Figure } from './figure';
import { Gizmo } from './gizmo';
import { Handles } from './handles';
import { HeldDot } from './held-dot';
import { Picker, type JointHover } from './picker';
import { PoseChange } from './pose-change';
import type { PoseEdit } from './pose-edit';
import { PosePointer } from './posing-pointer';

export type { JointHover } from './picker';

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
  /** No animations. */
  calm: boolean;
}

const UPRIGHT = [0, 0, 0, 1];

/**
 * Pose mode: select a joint by its dot or its limb; turn it with a gizmo (forward kinematics), or move it, by arrows or by its dot, with
 * the body following (inverse kinematics).
 */
export class Posing {
  readonly selectListeners = new Set<(joint: number | null) => void>();
  readonly hoverListeners = new Set<(hover: JointHover | null) => void>();
  readonly handles = new Handles();
  private readonly change: PoseChange;
  private readonly balance = new BalanceOverlay();
  /** Made when pose mode is first entered: most visitors watch before they pose. */
  private gizmo: Gizmo | null = null;
  private pointer: PosePointer | null = null;
  private tools: PoseTools = DEFAULT_TOOLS;
  private readonly abort = new AbortController();
  private readonly picker: Picker;
  private active = false;
  private selected: number | null = null;
  private hovered: number | null = null;
  private snapping = false;
  private held: HeldDot | null = null;

  constructor(private readonly host: PosingHost) {
    this.change = new PoseChange(
      { holding: () => this.dragging || this.held !== null, changed: () => this.refresh() },
      host.calm,
    );
    this.picker = new Picker(host, this.handles);
    host.scene.add(this.handles.points, this.balance.group);
    const key = (event: KeyboardEvent) => this.onKey(event);
    // Captured, so that Esc takes a drag back before any other shortcut hears it.
    for (const type of ['keydown', 'keyup'] as const)
      window.addEventListener(type, key, { signal: this.abort.signal, capture: true });
  }

  /** The pose, with begin / change / commit / cancel. */
  get edit(): PoseEdit {
    return this.change.edit;
  }

  /** Enters or leaves pose mode. */
  setActive(active: boolean): void {
    if (!active) {
      this.cancelDrag();
      this.change.flush();
      this.select(null);
      this.hover(null);
    }
    this.active = active;
    if (active) {
      this.change.centre();
      this.prepare();
    }
    this.handles.points.visible = active;
    this.balance.group.visible = active && this.tools.balance;
    if (active) this.refresh();
    this.host.changed();
  }

  /** How the editor works from now on. */
  setTools(tools: PoseTools): void {
    if (tools.mode !== this.tools.mode) {
      this.cancelDrag();
      this.change.flush();
    }
    this.tools = tools;
    if (this.gizmo) this.equip(this.gizmo);
    this.balance.group.visible = this.active && tools.balance;
    this.refresh();
  }

  /** Shows a pose to edit, 24 x 3 axis-angle; the selection stays. A drag under way ends without a trace. */
  load(rotations: ArrayLike<number>): void {
    this.letGo();
    this.change.load(rotations);
    if (this.active) this.refresh();
  }

  /** Selects a joint, or none. */
  select(joint: number | null): void {
    if (joint === this.selected) return;
    this.change.flush();
    this.selected = joint;
    this.gizmo?.show(joint !== null);
    this.refresh();
    for (const listener of this.selectListeners) listener(joint);
  }

  /** Turns the selected joint about one of its own axes; quick repeats are one change. */
  nudge(axis: 'x' | 'y' | 'z', radians: number): void {
    const joint = this.selected;
    if (!this.active || joint === null || this.dragging) return;
    this.change.nudge(joint, axis, radians, this.tools);
  }

  /** Moves the selected joint, metres in the world, with the body following; quick repeats are one change. */
  move(x: number, y: number, z: number): void {
    const joint = this.selected;
    if (!this.active || joint === null || this.dragging) return;
    this.change.nudgeBy(joint, [x, y, z], this.tools);
  }

  /** Time goes by; true while something moves by itself. */
  update(seconds: number): boolean {
    return this.active && this.change.update(seconds);
  }

  /** Draws the edited pose: figure on the floor, dots and gizmo on its joints. */
  refresh(): void {
    const figure = this.host.figure();
    if (!figure || !this.active) return;
    const { root, edit } = this.change;
    const { quaternions } = edit;
    figure.show({ root, quaternions });
    const { joints, rotations } = figure.pose;
    this.handles.place(joints);
    this.handles.mark(this.hovered, this.selected, this.tools.pins);
    if (this.tools.balance) this.balance.update(joints);
    const joint = this.selected;
    if (joint !== null && this.gizmo) {
      const part = (values: ArrayLike<number>, at: number) => [0, 1, 2, 3].map((i) => values[at * 4 + i]);
      const parent = PARENTS[joint] < 0 ? UPRIGHT : part(rotations, PARENTS[joint]);
      const position = joints.subarray(joint * 3, joint * 3 + 3);
      this.gizmo.place(position, parent, part(quaternions, joint), part(rotations, joint));
    }
    this.host.changed();
  }

  /** Stops listening and frees the gizmo. */
  dispose(): void {
    this.change.dispose();
    this.abort.abort();
    this.gizmo?.dispose();
    this.balance.dispose();
    this.handles.dispose();
  }

  private prepare(): void {
    if (this.gizmo) return;
    const { camera, element, scene, orbit } = this.host;
    this.gizmo = new Gizmo(camera, element, scene, {
      start: () => {
        if (this.selected === null) return;
        this.change.flush();
        if (this.tools.mode === 'move') this.change.startMove(this.selected, this.tools);
        else this.change.startTurn(this.selected);
      },
      turned: (q) => this.selected !== null && this.edit.open && this.change.turn(this.selected, q, this.tools),
      moved: (position) => this.change.moveTo(position),
      end: () => this.finish(),
      changed: this.host.changed,
      busy: (on) => orbit(!on),
    });
    this.equip(this.gizmo);
    // After the gizmo, which has the first word on a press.
    const posing = this; // eslint-disable-line @typescript-eslint/no-this-alias -- the getters below are not ours
    this.pointer = new PosePointer(
      element,
      {
        get active() {
          return posing.active;
        },
        get taken() {
          return posing.dragging;
        },
        claim: (event) => {
          const own = this.tools.mode === 'move' && this.selected !== null && this.picker.dot(event) === this.selected;
          this.gizmo!.enabled = !own && this.selected !== null;
          return own;
        },
        grabbable: (event, claimed) =>
          this.tools.mode === 'move' && (claimed || !this.gizmo?.hovered) ? this.picker.dot(event) : null,
        hover: (event) => this.hover(event && !this.gizmo?.hovered ? this.picker.joint(event) : null),
        click: (event) => this.select(this.picker.joint(event)),
        grab: (joint, event) => this.grab(joint, event),
        drag: (event) => this.dragHeld(event),
        drop: () => this.finish(),
        cancel: () => this.cancelDrag(),
        orbit: (on) => {
          if (on && this.gizmo) this.gizmo.enabled = this.selected !== null;
          orbit(on);
        },
      },
      this.abort.signal,
    );
  }

  private equip(gizmo: Gizmo): void {
    gizmo.mode = this.tools.mode;
    gizmo.space = this.tools.space;
    gizmo.snapping = this.snapping;
  }

  private get dragging(): boolean {
    return this.gizmo?.dragging ?? false;
  }

  private onKey(event: KeyboardEvent): void {
    this.snapping = event.shiftKey;
    if (this.gizmo) this.gizmo.snapping = event.shiftKey;
    if (event.type === 'keydown' && event.key === 'Escape' && this.edit.open) {
      event.stopPropagation();
      this.cancelDrag();
    }
  }

  /** Keeps the change that is under way. */
  private finish(): void {
    this.held = null;
    this.change.keep();
  }

  private grab(joint: number, event: PointerEvent): void {
    this.select(joint);
    this.change.flush();
    this.held = new HeldDot(this.picker, this.host.camera, this.change.startMove(joint, this.tools), event);
    this.hover(null);
    this.host.element.style.cursor = 'grabbing';
  }

  private dragHeld(event: PointerEvent): void {
    const target = this.held?.at(event);
    if (target) this.change.moveTo(target);
  }

  private hover(joint: number | null): void {
    if (joint === this.hovered) return;
    this.hovered = joint;
    this.handles.mark(joint, this.selected, this.tools.pins);
    this.host.element.style.cursor = joint === null ? '' : this.tools.mode === 'move' ? 'grab' : 'pointer';
    this.host.changed();
    const hover = joint === null ? null : this.picker.label(joint);
    for (const listener of this.hoverListeners) listener(hover);
  }

  private cancelDrag(): void {
    this.letGo();
    this.change.cancel();
  }

  /** Takes everything out of the pointer's hands. */
  private letGo(): void {
    this.held = null;
    this.pointer?.release();
    if (!this.dragging) return;
    this.gizmo!.release();
    this.host.orbit(true);
  }
}
