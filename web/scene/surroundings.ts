import { Group, type Camera, type ShaderMaterial } from 'three';
import { createBackdrop, Floor } from './floor';
import { Lights } from './lights';

/** What is round the dancer on the stage: floor, lamps and backdrop. */
export class Surroundings {
  readonly group = new Group();
  private readonly floor = new Floor();
  private readonly lights = new Lights(true);
  private readonly backdrop = createBackdrop();
  private glow = 0;

  /** @param onStage false for the lamps alone */
  constructor(onStage = true) {
    this.group.add(this.lights.group);
    if (onStage) this.group.add(this.backdrop, this.floor.mesh);
  }

  /** Makes shadows fit a dancer so many times our figure's height. */
  fit(size: number): void {
    this.lights.fit(size);
    this.floor.fit(size);
  }

  /**
   * Arranges everything for one picture.
   * @param x middle of the light on the floor, metres; likewise `z`
   * @param camera the picture is taken by it
   * @param joints of the dancer, 24 x 3 world positions, metres
   */
  arrange(x: number, z: number, camera: Camera, joints: Float32Array): void {
    this.floor.follow(x, z);
    this.lights.follow(x, z);
    this.backdrop.position.copy(camera.position);
    this.floor.shade(joints);
  }

  /** The floor glows as it does at one moment, 0..1. */
  shine(glow: number): void {
    this.floor.glow = glow;
  }

  /** A glow on the floor that fades by itself; strength 0..1. */
  pulse(strength: number): void {
    this.glow = Math.max(this.glow, Math.min(strength, 1));
  }

  /** Time goes by; true while something changes. */
  update(seconds: number): boolean {
    if (this.glow === 0) return false;
    this.glow = this.glow < 0.01 ? 0 : this.glow * Math.exp(-seconds * 4.5);
    this.floor.glow = this.glow;
    return true;
  }

  /** Frees all of it. */
  dispose(): void {
    this.floor.dispose();
    this.lights.dispose();
    this.backdrop.geometry.dispose();
    (this.backdrop.material as ShaderMaterial).dispose();
  }
}
