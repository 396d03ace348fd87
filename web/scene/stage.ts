/** The stage: the figure, its floor, lights and camera, and the loop that draws them. */
import { Scene, WebGLRenderer } from 'three';
import type { CameraView } from '../core/document';
import type { FigureLook } from '../core/figure-look';
import type { FramePose, PoseTools } from '../core/types';
import type { AvatarFigure } from './avatar';
import { Dancers } from './dancers';
import { applyLook } from './filming-look';
import { FollowCamera } from './follow-camera';
import { FrameLoop } from './frame-loop';
import { QualityGovernor } from './framing';
import { Onion, type Ghost } from './onion';
import { Path } from './path';
import type { PathPicture } from './path-picture';
import { BodyClicks } from './body-clicks';
import { Posing, type JointHover } from './posing';
import type { PoseListener } from './pose-edit';
import type { Stage } from './stage-type';
import { Surroundings } from './surroundings';

export type { Stage } from './stage-type';
export type { JointHover } from './posing';

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
  private readonly surroundings = new Surroundings();
  private readonly dancers: Dancers;
  private readonly view: FollowCamera;
  private readonly posing: Posing;
  private readonly onion = new Onion();
  private readonly path = new Path();
  private readonly bodyClicks: BodyClicks;
  private ghosts: readonly Ghost[] | null = null;
  private readonly calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
  private readonly governor = new QualityGovernor(Math.min(devicePixelRatio || 1, 2));
  private readonly loop = new FrameLoop(this.governor, {
    update: (seconds) => this.update(seconds),
    lowerQuality: () => this.lowerQuality(),
    render: () => this.render(),
  });
  private readonly watchers: { disconnect(): void }[] = [];
  private wantsFollow = true;
  private dirty = true;
  private seen = true;

  constructor(private readonly container: HTMLElement) {
    this.renderer = createRenderer();
    this.canvas = this.renderer.domElement;
    Object.assign(this.canvas.style, { display: 'block', width: '100%', height: '100%', touchAction: 'none' });
    container.append(this.canvas);
    this.view = new FollowCamera(this.canvas, this.calm);
    this.dancers = new Dancers((object) => this.renderer.compileAsync(object, this.view.camera, this.scene));
    this.posing = new Posing({
      camera: this.view.camera,
      element: this.canvas,
      scene: this.scene,
      figure: () => this.dancers.figure,
      changed: () => (this.dirty = true),
      orbit: (on) => (this.view.controls.enabled = on),
      calm: this.calm,
    });
    this.bodyClicks = new BodyClicks(this.canvas, this.view.camera, () =>
      this.mode === 'dance' ? this.dancers.lead : null,
    );
    this.scene.add(this.surroundings.group, this.onion.group, this.path.group, this.dancers.group);
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
    this.dancers.keep(pose);
    if (this.mode === 'dance') this.draw(seconds);
  }

  setAvatar(avatar: AvatarFigure | null): void {
    this.dancers.setAvatar(avatar, () => {
      this.makeRoom();
      if (this.mode === 'dance') this.draw();
      this.dirty = true;
    });
  }

  showBeside(pose: FramePose | null): void {
    const before = this.dancers.apart;
    if (!pose && !before) return;
    this.dancers.setBeside(pose);
    const { apart } = this.dancers;
    if (apart !== before) this.view.spread(apart);
    if (this.mode === 'dance') this.draw();
  }

  setLook(look: Readonly<FigureLook>): void {
    this.dancers.wear(look);
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
    if (this.dancers.asset) this.onion.set(this.dancers.asset, ghosts);
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
    if (!this.calm) this.surroundings.pulse(strength);
  }

  stats(): { fps: number; drawCalls: number; pixelRatio: number } {
    return {
      fps: this.loop.fps,
      drawCalls: this.renderer.info.render.calls,
      pixelRatio: this.renderer.getPixelRatio(),
    };
  }

  dispose(): void {
    this.loop.stop();
    for (const watcher of this.watchers) watcher.disconnect();
    this.posing.dispose();
    this.onion.dispose();
    this.dancers.dispose();
    this.path.dispose();
    this.bodyClicks.dispose();
    this.view.dispose();
    this.surroundings.dispose();
    this.renderer.dispose();
    this.canvas.remove();
  }

  private async loadFigure(): Promise<void> {
    // Shaders are built beside the page's own work; nothing is drawn until they are there.
    if (!(await this.dancers.load(() => this.renderer.compileAsync(this.scene, this.view.camera)))) return;
    this.makeRoom();
    this.dirty = true;
    this.setGhosts(this.ghosts);
    if (this.mode === 'dance') this.draw();
    else this.posing.refresh();
  }

  /** What is drawn around whoever is to be seen has its size. */
  private makeRoom(): void {
    const { size, stride } = this.dancers.cast(this.mode === 'dance');
    for (const { group } of [this.onion, this.path]) group.scale.setScalar(stride);
    for (const part of [this.view, this.surroundings]) part.fit(size);
  }

  private draw(seconds = 0): void {
    this.view.aim(...this.dancers.dance(seconds));
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
    if (this.dancers.figure) this.render();
  }

  /** Time goes by; true when there is something to draw, and somebody to see it. */
  private update(seconds: number): boolean {
    if (this.view.update(seconds)) this.dirty = true;
    if (this.posing.update(seconds)) this.dirty = true;
    if (this.surroundings.update(seconds)) this.dirty = true;
    return this.dirty && this.seen && this.dancers.figure !== null;
  }

  private lowerQuality(): void {
    const { figure } = this.dancers;
    if (figure) figure.detail = this.governor.detail;
    this.resize();
  }

  private render(): void {
    this.dirty = false;
    const [x, z] = this.view.centre;
    const { lead, figure } = this.dancers;
    const shown = (this.mode === 'dance' ? lead : figure)!;
    this.surroundings.arrange(x, z, this.view.camera, shown.pose.joints);
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
