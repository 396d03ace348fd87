/** The stage: the figure, its floor, lights and camera, and the loop that draws them. */
import { Scene, WebGLRenderer } from 'three';
import type { CameraView } from '../core/document';
import { DEFAULT_LOOK, type FigureLook } from '../core/figure-look';
import type { FramePose, PoseTools } from '../core/types';
import { JOINT_COUNT } from '../core/skeleton';
import type { AvatarFigure } from './avatar';
import { AvatarPlace } from './avatar-place';
import { Figure } from './figure';
import { loadFigure, type FigureAsset } from './figure-asset';
import { createBackdrop, Floor } from './floor';
import { applyLook } from './filming-look';
import { FollowCamera } from './follow-camera';
import { QualityGovernor } from './framing';
import { Lights } from './lights';
import { Onion, type Ghost } from './onion';
import { Path } from './path';
import type { PathPicture } from './path-picture';
import { APART, aside, Beside } from './beside';
import { BodyClicks } from './body-clicks';
import { Posing, type JointHover } from './posing';
import type { PoseListener } from './pose-edit';
import { REST_HEIGHT } from './rest';

export type { JointHover } from './posing';
export type { PoseListener, PosePhase } from './pose-edit';
export { jointLabel } from './pose-edit';
export type { Ghost } from './onion';
export type { PathPicture } from './path-picture';

/** What the rest of the app does with the stage. Functions that take a listener return how to stop listening. */
export interface Stage {
  readonly canvas: HTMLCanvasElement;
  /** Resolves when the figure is there; rejects when it cannot be loaded. */
  readonly ready: Promise<void>;
  /** Draws a frame of the dance, so many seconds of it after the one before (0 = a jump). In pose mode it is kept for later. */
  show(pose: FramePose, seconds?: number): void;
  /** A character in the place of our figure, in the dance; null = our own. The same one again is drawn anew. */
  setAvatar(avatar: AvatarFigure | null): void;
  /** Draws a frame of another dance beside it, to the left; null = the dance is alone. */
  showBeside(pose: FramePose | null): void;
  /** Dresses our own figure, and the second dancer like it. */
  setLook(look: Readonly<FigureLook>): void;
  /** Calls back before each screen refresh, with performance.now(). */
  beforeFrame(callback: (now: number) => void): () => void;
  setMode(mode: 'dance' | 'pose'): void;
  readonly mode: 'dance' | 'pose';
  /** Pose mode: shows this pose for editing, 24 x 3 axis-angle. Listeners are not told. */
  editPose(rotations: ArrayLike<number>): void;
  onPoseChange(listener: PoseListener): () => void;
  selectJoint(joint: number | null): void;
  onSelect(listener: (joint: number | null) => void): () => void;
  onHover(listener: (hover: JointHover | null) => void): () => void;
  /** Turns the selected joint about one of its own axes; quick repeats make one change. */
  rotateSelected(axis: 'x' | 'y' | 'z', radians: number): void;
  /** Moves the selected joint, metres in the world, the body following; quick repeats make one change. */
  moveSelected(dx: number, dy: number, dz: number): void;
  /** How the gizmo and the dots work: turning or moving, limits, mirroring, pins, the balance hint. */
  setPoseTools(tools: PoseTools): void;
  /** Shows neighbouring key poses as ghosts, at most one of a kind, or none. */
  setGhosts(ghosts: readonly Ghost[] | null): void;
  /** Shows the path of a joint, or none. The picture is copied. */
  setPath(path: PathPicture | null): void;
  /** Calls back when the dancing figure is clicked, with the joint of the limb that was hit. Not in pose mode. */
  onBodyClick(listener: (joint: number) => void): () => void;
  /** Whether the camera goes with the dancer. */
  follow: boolean;
  /** Back to the opening view. */
  frameFigure(): void;
  /** The view as it can be kept: null = the opening view, which fits itself to any screen. */
  getView(): CameraView | null;
  setView(view: CameraView): void;
  /** Tells when the user has turned, zoomed or moved the camera, or asked for the opening view. */
  onView(listener: (view: CameraView | null) => void): () => void;
  /** A glow on the floor that fades by itself; strength 0..1. */
  pulse(strength?: number): void;
  /** Draws per second over the last second, and draw calls of the last one. */
  stats(): { fps: number; drawCalls: number; pixelRatio: number };
  dispose(): void;
}

/**
 * Builds the stage inside an element, whose size it follows.
 * @throws Error when the browser has no WebGL 2
 */
export function createStage(container: HTMLElement): Stage {
  return new WebGLStage(container);
}

class WebGLStage implements Stage {
  readonly canvas: HTMLCanvasElement;
  readonly ready: Promise<void>;
  mode: 'dance' | 'pose' = 'dance';
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly floor = new Floor();
  private readonly backdrop = createBackdrop();
  private readonly lights = new Lights(true);
  private readonly view: FollowCamera;
  private readonly posing: Posing;
  private readonly beside = new Beside();
  private readonly onion = new Onion();
  private readonly path = new Path();
  private readonly bodyClicks: BodyClicks;
  private readonly place: AvatarPlace;
  private ghosts: readonly Ghost[] | null = null;
  private look: Readonly<FigureLook> = DEFAULT_LOOK;
  private readonly calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
  private readonly governor = new QualityGovernor(Math.min(devicePixelRatio || 1, 2));
  private readonly callbacks = new Set<(now: number) => void>();
  private readonly watchers: { disconnect(): void }[] = [];
  private readonly draws: number[] = [];
  private readonly last: { root: Float32Array; quaternions: Float32Array };
  private figure: Figure | null = null;
  private asset: FigureAsset | null = null;
  private wantsFollow = true;
  private glow = 0;
  private dirty = true;
  private seen = true;
  private disposed = false;
  private before = 0;
  private drewBefore = false;
  private request = 0;

  constructor(private readonly container: HTMLElement) {
    this.renderer = createRenderer();
    this.canvas = this.renderer.domElement;
    Object.assign(this.canvas.style, { display: 'block', width: '100%', height: '100%', touchAction: 'none' });
    container.append(this.canvas);
    this.last = { root: new Float32Array([0, REST_HEIGHT, 0]), quaternions: new Float32Array(JOINT_COUNT * 4) };
    for (let joint = 0; joint < JOINT_COUNT; joint++) this.last.quaternions[joint * 4 + 3] = 1;

    this.view = new FollowCamera(this.canvas, this.calm);
    this.posing = new Posing({
      camera: this.view.camera,
      element: this.canvas,
      scene: this.scene,
      figure: () => this.figure,
      changed: () => (this.dirty = true),
      orbit: (on) => (this.view.controls.enabled = on),
      calm: this.calm,
    });
    this.place = new AvatarPlace((object) => this.renderer.compileAsync(object, this.view.camera, this.scene));
    this.bodyClicks = new BodyClicks(this.canvas, this.view.camera, () => (this.mode === 'dance' ? this.dancer : null));
    this.scene.add(
      this.backdrop,
      this.floor.mesh,
      this.lights.group,
      this.onion.group,
      this.path.group,
      this.beside.group,
      this.place.group,
    );
    this.canvas.addEventListener('dblclick', () => this.mode === 'dance' && this.frameFigure());
    this.canvas.addEventListener('webglcontextrestored', () => (this.dirty = true));
    this.watch();
    this.ready = this.loadFigure();
    this.ready.catch(() => undefined);
    this.request = requestAnimationFrame(this.tick);
  }

  get follow(): boolean {
    return this.wantsFollow;
  }

  set follow(on: boolean) {
    this.wantsFollow = on;
    this.view.follow = on || this.mode === 'pose';
  }

  show(pose: FramePose, seconds = 0): void {
    this.last.root.set(pose.root);
    this.last.quaternions.set(pose.quaternions);
    if (this.mode === 'dance') this.draw(seconds);
  }

  setAvatar(avatar: AvatarFigure | null): void {
    this.place.set(avatar, this.last, () => {
      this.makeRoom();
      if (this.mode === 'dance') this.draw();
      this.dirty = true;
    });
  }

  showBeside(pose: FramePose | null): void {
    const alone = this.beside.root === null;
    if (!pose && alone) return;
    this.beside.set(this.asset, pose);
    if (!pose !== alone) this.view.spread(pose ? 2 * APART : 0);
    if (this.mode === 'dance') this.draw();
  }

  setLook(look: Readonly<FigureLook>): void {
    this.look = look;
    this.figure?.wear(look);
    this.beside.wear(look);
    this.dirty = true;
  }

  beforeFrame(callback: (now: number) => void): () => void {
    this.callbacks.add(callback);
    return () => this.callbacks.delete(callback);
  }

  setMode(mode: 'dance' | 'pose'): void {
    if (mode === this.mode) return;
    this.mode = mode;
    this.posing.setActive(mode === 'pose');
    this.makeRoom();
    // The edited figure stands at the stage's centre, so the camera must come even if it does not follow the dance.
    this.view.follow = mode === 'pose' || this.wantsFollow;
    if (mode === 'dance') this.draw();
    else this.view.centreOn(0, 0);
  }

  editPose(rotations: ArrayLike<number>): void {
    this.posing.load(rotations);
  }

  onPoseChange(listener: PoseListener): () => void {
    return this.posing.edit.listen(listener);
  }

  selectJoint(joint: number | null): void {
    if (this.mode === 'pose') this.posing.select(joint);
  }

  onSelect(listener: (joint: number | null) => void): () => void {
    this.posing.selectListeners.add(listener);
    return () => this.posing.selectListeners.delete(listener);
  }

  onHover(listener: (hover: JointHover | null) => void): () => void {
    this.posing.hoverListeners.add(listener);
    return () => this.posing.hoverListeners.delete(listener);
  }

  rotateSelected(axis: 'x' | 'y' | 'z', radians: number): void {
    this.posing.nudge(axis, radians);
  }

  moveSelected(dx: number, dy: number, dz: number): void {
    this.posing.move(dx, dy, dz);
  }

  setPoseTools(tools: PoseTools): void {
    this.posing.setTools(tools);
  }

  setGhosts(ghosts: readonly Ghost[] | null): void {
    this.ghosts = ghosts;
    if (this.asset) this.onion.set(this.asset, ghosts);
    this.dirty = true;
  }

  setPath(path: PathPicture | null): void {
    this.path.set(path);
    this.dirty = true;
  }

  onBodyClick(listener: (joint: number) => void): () => void {
    return this.bodyClicks.listen(listener);
  }

  frameFigure(): void {
    this.view.frame();
    this.dirty = true;
  }

  getView(): CameraView | null {
    const follows = this.wantsFollow;
    if (follows && this.view.atHome) return null;
    const { position, target } = this.view.view(follows);
    return { follows, position: position.toArray(), target: target.toArray() };
  }

  setView(view: CameraView): void {
    this.follow = view.follows;
    this.view.restore(view, view.follows);
    this.dirty = true;
  }

  onView(listener: (view: CameraView | null) => void): () => void {
    // A camera that stands still comes to the edited figure for a while only: that is no view to keep.
    this.view.settled = () => (this.mode === 'dance' || this.wantsFollow) && listener(this.getView());
    return () => (this.view.settled = () => undefined);
  }

  pulse(strength = 1): void {
    if (!this.calm) this.glow = Math.max(this.glow, Math.min(strength, 1));
  }

  stats(): { fps: number; drawCalls: number; pixelRatio: number } {
    const now = performance.now();
    return {
      fps: this.draws.filter((time) => now - time < 1000).length,
      drawCalls: this.renderer.info.render.calls,
      pixelRatio: this.renderer.getPixelRatio(),
    };
  }

  dispose(): void {
    this.disposed = true;
    cancelAnimationFrame(this.request);
    for (const watcher of this.watchers) watcher.disconnect();
    this.posing.dispose();
    this.onion.dispose();
    this.place.dispose();
    this.beside.dispose();
    this.path.dispose();
    this.bodyClicks.dispose();
    this.view.dispose();
    this.figure?.dispose();
    this.floor.dispose();
    this.lights.dispose();
    this.backdrop.geometry.dispose();
    this.renderer.dispose();
    this.canvas.remove();
  }

  private async loadFigure(): Promise<void> {
    const asset = await loadFigure();
    if (this.disposed) return;
    const figure = new Figure(asset);
    figure.wear(this.look);
    this.scene.add(figure.mesh);
    figure.show(this.last);
    // Shaders are built beside the page's own work; nothing is drawn until they are there.
    await this.renderer.compileAsync(this.scene, this.view.camera);
    if (this.disposed) return figure.dispose();
    this.figure = figure;
    this.asset = asset;
    this.makeRoom();
    this.dirty = true;
    this.setGhosts(this.ghosts);
    if (this.mode === 'dance') this.draw();
    else this.posing.refresh();
  }

  /** Whom the dance is danced by: a character, or our figure. */
  private get dancer(): AvatarFigure | Figure | null {
    return this.place.avatar ?? this.figure;
  }

  /** Either our figure or a character is to be seen, and what is drawn around it has its size. Poses are edited on our figure. */
  private makeRoom(): void {
    const avatar = this.mode === 'dance' ? this.place.avatar : null;
    this.place.group.visible = avatar !== null;
    if (this.figure) this.figure.mesh.visible = avatar === null;
    for (const { group } of [this.onion, this.path]) group.scale.setScalar(avatar?.stride ?? 1);
    for (const part of [this.view, this.lights, this.floor]) part.fit(avatar?.size ?? 1);
  }

  private draw(seconds = 0): void {
    const stride = this.place.avatar?.stride ?? 1;
    const [x, z] = [this.last.root[0] * stride, this.last.root[2] * stride];
    const other = this.beside.root;
    this.view.aim(other ? (x + other[0]) / 2 : x, other ? (z + other[1]) / 2 : z);
    this.figure?.show(other ? aside(this.last, APART) : this.last);
    this.place.group.position.x = other ? APART : 0;
    this.place.avatar?.show(this.last, seconds);
    this.dirty = true;
  }

  private watch(): void {
    const size = new ResizeObserver(() => this.resize());
    size.observe(this.container);
    const sight = new IntersectionObserver(([entry]) => {
      this.seen = entry.isIntersecting;
      this.dirty = true;
    });
    sight.observe(this.container);
    this.watchers.push(size, sight);
    this.resize();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.container;
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.governor.ratio);
    this.renderer.setSize(width, height, false);
    this.posing.handles.ratio = this.governor.ratio;
    this.path.resize(width, height, this.governor.ratio);
    this.view.resize(width, height);
    // Drawn at once: an emptied canvas must not flash.
    if (this.figure) this.render();
  }

  private readonly tick = (now: number): void => {
    this.request = requestAnimationFrame(this.tick);
    const elapsed = now - this.before;
    this.before = now;
    for (const callback of this.callbacks) callback(now);
    const seconds = Math.min(Math.max(elapsed, 0), 100) / 1000;
    if (this.view.update(seconds)) this.dirty = true;
    if (this.posing.update(seconds)) this.dirty = true;
    if (this.glow > 0) {
      this.glow = this.glow < 0.01 ? 0 : this.glow * Math.exp(-seconds * 4.5);
      this.floor.glow = this.glow;
      this.dirty = true;
    }
    const draw = this.dirty && this.seen && this.figure !== null;
    if (draw) {
      if (this.drewBefore && this.governor.sample(elapsed)) this.lowerQuality();
      this.render();
      this.draws.push(now);
      while (now - this.draws[0] > 1000) this.draws.shift();
    }
    this.drewBefore = draw;
  };

  private lowerQuality(): void {
    if (this.figure) this.figure.detail = this.governor.detail;
    this.resize();
  }

  private render(): void {
    this.dirty = false;
    const [x, z] = this.view.centre;
    this.floor.follow(x, z);
    this.lights.follow(x, z);
    this.backdrop.position.copy(this.view.camera.position);
    this.floor.shade((this.mode === 'dance' ? this.dancer! : this.figure!).pose.joints);
    this.renderer.render(this.scene, this.view.camera);
  }
}

function createRenderer(): WebGLRenderer {
  let renderer: WebGLRenderer;
  try {
    renderer = new WebGLRenderer({ antialias: true, powerPreference: 'high-performance' });
  } catch {
    throw new Error(
      'This browser cannot show 3D (WebGL 2 is off). Turn on hardware acceleration or try another browser.',
    );
  }
  applyLook(renderer);
  return renderer;
}
