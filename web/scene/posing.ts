import type { Camera, Scene } from 'three';
import { DEFAULT_TOOLS } from '../core/default-tools';
import { createIkSolver, type IkSolver } from '../core/ik';
import { PARENTS } from '../core/skeleton';
import type { PoseTools } from '../core/types';
import { BalanceOverlay } from './balance-overlay';
import type { Figure } from './figure';
import { FkTurn } from './fk-turn';
import { Footing } from './footing';
import { Gizmo } from './gizmo';
import { Handles } from './handles';
import { HeldDot } from './held-dot';
import { IkDrag } from './ik-drag';
import { Picker, type JointHover } from './picker';
import { PoseEdit, rotateLocal } from './pose-edit';
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

/** Keyboard changes within this time are one change, so that holding a key is one step to undo. Milliseconds. */
const NUDGE_PAUSE = 450;
const UPRIGHT = [0, 0, 0, 1];

/**
 * Pose mode: select a joint by its dot or its limb; turn it with a gizmo (forward kinematics), or move it, by arrows or by its dot, with
 * the body following (inverse kinematics).
 */
export class Posing {
  readonly edit = new PoseEdit();
  readonly selectListeners = new Set<(joint: number | null) => void>();
  readonly hoverListeners = new Set<(hover: JointHover | null) => void>();
  readonly handles = new Handles();
  private readonly turning = new FkTurn(this.edit);
  private readonly balance = new BalanceOverlay();
  private readonly footing: Footing;
  /** Made when pose mode is first entered: most visitors watch before they pose. */
  private gizmo: Gizmo | null = null;
  private pointer: PosePointer | null = null;
  private solver: IkSolver | null = null;
  private tools: PoseTools = DEFAULT_TOOLS;
  private readonly abort = new AbortController();
  private readonly picker: Picker;
  private active = false;
  private selected: number | null = null;
  private hovered: number | null = null;
  private snapping = false;
  private nudgeTimer: ReturnType<typeof setTimeout> | undefined;
  /** The drag by inverse kinematics under way and where its joint is wanted. */
  private drag: { ik: IkDrag; target: number[]; keys: boolean } | null = null;
  private held: HeldDot | null = null;

  constructor(private readonly host: PosingHost) {
    this.footing = new Footing(host.calm);
    this.picker = new Picker(host, this.handles);
    host.scene.add(this.handles.points, this.balance.group);
    const key = (event: KeyboardEvent) => this.onKey(event);
    // Captured, so that Esc takes a drag back before any other shortcut hears it.
    for (const type of ['keydown', 'keyup'] as const)
      window.addEventListener(type, key, { signal: this.abort.signal, capture: true });
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
    if (active) {
      this.footing.reset();
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
      this.flush();
    }
    this.tools = tools;
    if (this.gizmo) this.equip(this.gizmo);
    this.balance.group.visible = this.active && tools.balance;
    this.refresh();
  }

  /** Shows a pose to edit, 24 x 3 axis-angle; the selection stays. A drag under way ends without a trace. */
  load(rotations: ArrayLike<number>): void {
    this.letGo();
    this.flush();
    const before = this.edit.quaternions.slice();
    this.edit.load(rotations);
    // Another pose stands in the middle of the stage; the same one stays where its feet are.
    if (this.edit.quaternions.some((value, i) => Math.abs(value - before[i]) > 1e-5)) this.footing.reset();
    if (this.active) this.refresh();
  }

  /** Selects a joint, or none. */
  select(joint: number | null): void {
    if (joint === this.selected) return;
    this.flush();
    this.selected = joint;
    this.gizmo?.show(joint !== null);
    this.refresh();
    for (const listener of this.selectListeners) listener(joint);
  }

  /** Turns the selected joint about one of its own axes; quick repeats are one change. */
  nudge(axis: 'x' | 'y' | 'z', radians: number): void {
    const joint = this.selected;
    if (!this.active || joint === null || this.dragging) return;
    if (this.drag) this.flush();
    if (!this.edit.open) this.turning.start(joint);
    const q = this.edit.quaternions.slice();
    rotateLocal(q, joint, axis, radians);
    this.turn(joint, q.subarray(joint * 4, joint * 4 + 4));
    this.expire();
  }

  /** Moves the selected joint, metres in the world, with the body following; quick repeats are one change. */
  move(x: number, y: number, z: number): void {
    const joint = this.selected;
    if (!this.active || joint === null || this.dragging) return;
    if (!this.drag) this.beginMove(joint, true);
    if (!this.drag) return;
    const { target } = this.drag;
    this.moveTo([target[0] + x, target[1] + y, target[2] + z]);
    this.expire();
  }

  /** Time goes by; true while something moves by itself. */
  update(seconds: number): boolean {
    if (!this.active) return false;
    const moving = this.drag !== null && !this.drag.ik.settled;
    if (this.drag && moving) this.moveTo(this.drag.target);
    else if (this.footing.update(seconds)) this.refresh();
    return moving || this.footing.settling;
  }

  /** Draws the edited pose: figure on the floor, dots and gizmo on its joints. */
  refresh(): void {
    const figure = this.host.figure();
    if (!figure || !this.active) return;
    const { quaternions } = this.edit;
    figure.show({ root: this.root(), quaternions });
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
    clearTimeout(this.nudgeTimer);
    this.abort.abort();
    this.gizmo?.dispose();
    this.balance.dispose();
    this.handles.dispose();
  }

  private root(): ArrayLike<number> {
    return this.drag ? this.drag.ik.pose.root : this.footing.root(this.edit.quaternions);
  }

  private prepare(): void {
    if (this.gizmo) return;
    const { camera, element, scene, orbit } = this.host;
    this.gizmo = new Gizmo(camera, element, scene, {
      start: () => {
        if (this.selected === null) return;
        this.flush();
        if (this.tools.mode === 'move') this.beginMove(this.selected, false);
        else this.turning.start(this.selected);
      },
      turned: (q) => this.selected !== null && this.edit.open && this.turn(this.selected, q),
      moved: (position) => this.drag && this.moveTo(position),
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

  private turn(joint: number, rotation: ArrayLike<number>): void {
    this.turning.to(joint, rotation, this.tools);
    this.refresh();
  }

  private beginMove(joint: number, keys: boolean): void {
    if (!this.host.figure()) return;
    const root = this.root();
    this.edit.start();
    this.solver ??= createIkSolver();
    const ik = new IkDrag(this.solver, { root, quaternions: this.edit.quaternions }, joint, this.tools);
    this.drag = { ik, target: ik.from.slice(), keys };
  }

  private moveTo(target: ArrayLike<number>): void {
    if (!this.drag) return;
    this.drag.target = Array.from(target);
    this.edit.setAll(this.drag.ik.to(target).quaternions);
    this.refresh();
  }

  /** Keeps the change that is under way. */
  private finish(): void {
    const { drag } = this;
    this.held = null;
    this.drag = null;
    if (drag) this.footing.settle(drag.ik.pose.root);
    this.edit.commit();
    this.refresh();
  }

  private grab(joint: number, event: PointerEvent): void {
    this.select(joint);
    this.flush();
    this.beginMove(joint, false);
    if (!this.drag) return;
    this.held = new HeldDot(this.picker, this.host.camera, this.drag.ik.from, event);
    this.hover(null);
    this.host.element.style.cursor = 'grabbing';
  }

  private dragHeld(event: PointerEvent): void {
    const target = this.held?.at(event);
    if (target) this.moveTo(target);
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

  /** A keyboard change is kept when nothing more comes for a while. */
  private expire(): void {
    clearTimeout(this.nudgeTimer);
    this.nudgeTimer = setTimeout(() => this.flush(), NUDGE_PAUSE);
  }

  /** Keeps a keyboard change that is still open. */
  private flush(): void {
    clearTimeout(this.nudgeTimer);
    this.nudgeTimer = undefined;
    if (this.dragging || this.held) return;
    if (this.drag) this.finish();
    else this.edit.commit();
  }

  private cancelDrag(): void {
    clearTimeout(this.nudgeTimer);
    this.letGo();
    if (!this.edit.open) return;
    this.edit.cancel();
    this.refresh();
  }

  private letGo(): void {
    this.drag = null;
    this.held = null;
    this.pointer?.release();
    if (!this.dragging) return;
    this.gizmo!.release();
    this.host.orbit(true);
  }
}
