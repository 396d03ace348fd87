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
import { FrameLoop } from './frame-loop';
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
import type { Stage } from './stage-type';

export type { Stage } from './stage-type';
export type { JointHover } from './posing';
export type { PoseListener, PosePhase } from './pose-edit';
export { jointLabel } from './pose-edit';
export type { Ghost } from './onion';
export type { PathPicture } from './path-picture';

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
  private readonly loop = new FrameLoop(this.governor, {
    update: (seconds) => this.update(seconds),
    lowerQuality: () => this.lowerQuality(),
    render: () => this.render(),
  });
  private readonly watchers: { disconnect(): void }[] = [];
  private readonly last: { root: Float32Array; quaternions: Float32Array };
  private figure: Figure | null = null;
  private asset: FigureAsset | null = null;
  private wantsFollow = true;
  private glow = 0;
  private dirty = true;
  private seen = true;
  private disposed = false;

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
    this.loop.start();
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
    return this.loop.beforeFrame(callback);
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
    return {
      fps: this.loop.fps,
      drawCalls: this.renderer.info.render.calls,
      pixelRatio: this.renderer.getPixelRatio(),
    };
  }

  dispose(): void {
    this.disposed = true;
    this.loop.stop();
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

  /** Time goes by; true when there is something to draw, and somebody to see it. */
  private update(seconds: number): boolean {
    if (this.view.update(seconds)) this.dirty = true;
    if (this.posing.update(seconds)) this.dirty = true;
    if (this.glow > 0) {
      this.glow = this.glow < 0.01 ? 0 : this.glow * Math.exp(-seconds * 4.5);
      this.floor.glow = this.glow;
      this.dirty = true;
    }
    return this.dirty && this.seen && this.figure !== null;
  }

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
