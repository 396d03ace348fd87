import { PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { FIGURE_BOX, framingDistance, Spring } from './framing';

/** Height of the point that the camera looks at, metres. */
const LOOK_HEIGHT = 1.0;
/** Opening view: a little to the figure's left and a little above its eyes. */
const VIEW = { azimuth: 0.42, elevation: 0.13 };

/** Damping has come to rest this long after the hand let go, milliseconds. */
const SETTLE_TIME = 700;
/** A click that moves the camera less than this, metres, is no wish for another view. */
const STILL = 1e-3;

/** An orbit camera whose centre eases after the dancer. What the user turned, zoomed or moved stays as it is. */
export class FollowCamera {
  readonly camera = new PerspectiveCamera(30, 1, 0.05, 120);
  readonly controls: OrbitControls;
  /** Whether the camera goes with the dancer. */
  follow = true;
  private readonly springs = [new Spring(0, 0.55), new Spring(0, 0.55)];
  private readonly goal = [0, 0];
  private touched = false;
  /** How far apart two dancers are, metres. */
  private room = 0;
  /** Size of the dancer; our figure has 1. */
  private size = 1;
  private moved = false;
  /** What the hand began goes on: damping, or the way back to the opening view. */
  private easing = false;
  /** Told when the camera rests where the user turned it to, or is back at the opening view. */
  settled: () => void = () => undefined;
  private settling: ReturnType<typeof setTimeout> | undefined;
  private gliding: { from: Vector3; to: Vector3; fromTarget: Vector3; toTarget: Vector3; progress: number } | null =
    null;

  constructor(
    element: HTMLElement,
    private readonly calm: boolean,
  ) {
    this.controls = new OrbitControls(this.camera, element);
    this.controls.enableDamping = !calm;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = 0.9;
    this.controls.maxDistance = 14;
    this.controls.maxPolarAngle = Math.PI * 0.515;
    this.controls.zoomToCursor = false;
    let before = this.view(true);
    this.controls.addEventListener('start', () => {
      clearTimeout(this.settling);
      if (this.settling === undefined) before = this.view(true);
      this.touched = true;
      this.gliding = null;
    });
    this.controls.addEventListener('end', () => this.settle(() => before));
    // Without damping the controls move the camera in the event itself, and the next update finds nothing left to do.
    this.controls.addEventListener('change', () => (this.moved = true));
    this.jump();
  }

  /** Where the dancer is; the camera eases there over the next frames. */
  aim(x: number, z: number): void {
    // With reduced motion the view stands still until the dancer is about to leave it.
    const slack = this.calm ? 0.9 : 0.04;
    const [dx, dz] = [x - this.goal[0], z - this.goal[1]];
    const distance = Math.hypot(dx, dz);
    if (distance <= slack) return;
    const share = this.calm ? 1 : (distance - slack) / distance;
    this.goal[0] += dx * share;
    this.goal[1] += dz * share;
  }

  /** Sends the camera's centre to a point, whatever `follow` says next. */
  centreOn(x: number, z: number): void {
    this.goal[0] = x;
    this.goal[1] = z;
  }

  /** Centre of the stage's light and shadow: the eased position of the dancer. */
  get centre(): [number, number] {
    return [this.springs[0].value, this.springs[1].value];
  }

  /** New size of the view. Until the user has touched the camera, the whole figure is kept in it. */
  resize(width: number, height: number): void {
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    if (!this.touched) this.jump();
  }

  /** Where the camera is and what it looks at, metres; `relative` to the centre that follows the dancer, or in the world. */
  view(relative: boolean): { position: Vector3; target: Vector3 } {
    const [x, z] = relative ? this.centre : [0, 0];
    const centre = new Vector3(x, 0, z);
    return { position: this.camera.position.clone().sub(centre), target: this.controls.target.clone().sub(centre) };
  }

  /** Puts the camera where `view` said it was. */
  restore(view: { position: readonly number[]; target: readonly number[] }, relative: boolean): void {
    const [x, z] = relative ? this.centre : [0, 0];
    this.touched = true;
    this.gliding = null;
    this.camera.position.set(view.position[0] + x, view.position[1], view.position[2] + z);
    this.controls.target.set(view.target[0] + x, view.target[1], view.target[2] + z);
    this.controls.update();
  }

  /** True while the opening view is shown, which fits itself to the size of the stage. */
  get atHome(): boolean {
    return !this.touched;
  }

  /** Makes room for two dancers this far apart, metres; the opening view goes back for them. */
  spread(width: number): void {
    this.room = width;
    if (!this.touched) this.frame();
  }

  /** Makes the opening view fit a dancer of another size; our figure has 1. */
  fit(size: number): void {
    if (size === this.size) return;
    this.size = size;
    if (!this.touched) this.frame();
  }

  /** Glides (or, with reduced motion, jumps) back to the opening view round the figure. */
  frame(): void {
    this.touched = false;
    this.settle(() => null);
    if (this.calm) return this.jump();
    const { position, target } = this.home();
    this.gliding = {
      from: this.camera.position.clone(),
      to: position,
      fromTarget: this.controls.target.clone(),
      toTarget: target,
      progress: 0,
    };
  }

  /**
   * Moves on by `seconds`.
   * @returns whether the view changed
   */
  update(seconds: number): boolean {
    let moved = false;
    if (this.follow) {
      const before = this.centre;
      this.springs.forEach((spring, i) => spring.step(this.goal[i], seconds));
      const shift = new Vector3(this.springs[0].value - before[0], 0, this.springs[1].value - before[1]);
      if (shift.length() > 1e-6) {
        for (const point of [this.camera.position, this.controls.target]) point.add(shift);
        for (const point of [this.gliding?.from, this.gliding?.to, this.gliding?.fromTarget, this.gliding?.toTarget])
          point?.add(shift);
        moved = true;
      }
    }
    if (this.gliding) {
      const glide = this.gliding;
      glide.progress = Math.min(1, glide.progress + seconds / 0.6);
      const t = 1 - (1 - glide.progress) ** 3;
      this.camera.position.lerpVectors(glide.from, glide.to, t);
      this.controls.target.lerpVectors(glide.fromTarget, glide.toTarget, t);
      if (glide.progress === 1) this.gliding = null;
      moved = true;
    }
    this.controls.update(seconds);
    this.easing = this.moved || this.gliding !== null;
    moved ||= this.moved;
    this.moved = false;
    return moved;
  }

  private settle(before: () => { position: Vector3; target: Vector3 } | null): void {
    clearTimeout(this.settling);
    this.settling = setTimeout(() => {
      // On a slow machine the same way takes longer.
      if (this.easing) return this.settle(before);
      this.settling = undefined;
      const [from, to] = [before(), this.view(true)];
      const still = from && from.position.distanceTo(to.position) + from.target.distanceTo(to.target) < STILL;
      if (!still) this.settled();
    }, SETTLE_TIME);
  }

  /** Stops listening. */
  dispose(): void {
    clearTimeout(this.settling);
    this.controls.dispose();
  }

  private jump(): void {
    const { position, target } = this.home();
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
  }

  private home(): { position: Vector3; target: Vector3 } {
    const [x, z] = this.centre;
    const { size } = this;
    const target = new Vector3(x, LOOK_HEIGHT * size, z);
    const { width, height, depth } = FIGURE_BOX;
    const box = { height: height * size, width: width * size + this.room, depth: depth * size };
    const distance = framingDistance((this.camera.fov * Math.PI) / 180, this.camera.aspect, box);
    const flat = Math.cos(VIEW.elevation) * distance;
    const position = target
      .clone()
      .add(
        new Vector3(Math.sin(VIEW.azimuth) * flat, Math.sin(VIEW.elevation) * distance, Math.cos(VIEW.azimuth) * flat),
      );
    return { position, target };
  }
}
