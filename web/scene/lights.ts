import { DirectionalLight, Group, HemisphereLight, Vector3 } from 'three';

/** Where the key light is, metres from the dancer. */
const KEY_PLACE = new Vector3(1.7, 3.9, 3.4);
/** What the shadow of a dancer of our figure's height may take, metres. */
const SHADOW = { left: -1.7, right: 1.7, top: 1.9, bottom: -1.6, near: 1, far: 9 } as const;

/** Key, fill and two rim lights round the origin. */
export class Lights {
  readonly group = new Group();
  readonly key = new DirectionalLight('#fff3e6', 2.5);

  constructor(shadows: boolean) {
    this.key.position.copy(KEY_PLACE);
    const cool = new DirectionalLight('#a9c6ff', 2.2);
    cool.position.set(-2.8, 2.6, -3.2);
    const warm = new DirectionalLight('#ffd0bd', 1.1);
    warm.position.set(3.4, 1.8, -2.6);
    this.group.add(this.key, this.key.target, cool, cool.target, warm, warm.target);
    this.group.add(new HemisphereLight('#c3cfe8', '#3a3844', 1.0));
    if (!shadows) return;
    this.key.castShadow = true;
    const { shadow } = this.key;
    shadow.mapSize.set(2048, 2048);
    shadow.radius = 3.5;
    shadow.bias = -0.0004;
    this.fit(1);
  }

  /** Makes room in the shadow's view for a dancer so many times our figure's height. */
  fit(size: number): void {
    // What is smaller keeps the shadow that is sharp enough for ours.
    const scale = Math.max(1, size);
    const { position, shadow } = this.key;
    position.copy(KEY_PLACE).multiplyScalar(scale);
    for (const side of ['left', 'right', 'top', 'bottom', 'far'] as const) shadow.camera[side] = SHADOW[side] * scale;
    shadow.camera.near = SHADOW.near;
    shadow.camera.updateProjectionMatrix();
    // A texel covers more of a larger dancer.
    shadow.normalBias = 0.018 * scale;
  }

  /** Moves the rig, and with it the shadow's view, to the figure. */
  follow(x: number, z: number): void {
    this.group.position.set(x, 0, z);
  }

  /** Frees the shadow map. */
  dispose(): void {
    this.key.shadow.dispose();
  }
}
