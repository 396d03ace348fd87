import {
  BackSide,
  BoxGeometry,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  Mesh,
  MeshBasicMaterial,
  PMREMGenerator,
  Scene,
  type Texture,
  type WebGLRenderer,
} from 'three';

/** Key, fill and two rim lights round the origin. */
export class Lights {
  readonly group = new Group();
  readonly key = new DirectionalLight('#fff1e0', 2.5);

  constructor(shadows: boolean) {
    this.key.position.set(1.9, 4.2, 3.0);
    const cool = new DirectionalLight('#8fb8ff', 2.4);
    cool.position.set(-2.8, 2.6, -3.2);
    const warm = new DirectionalLight('#ffb99a', 1.3);
    warm.position.set(3.4, 1.8, -2.6);
    this.group.add(this.key, this.key.target, cool, cool.target, warm, warm.target);
    this.group.add(new HemisphereLight('#b9c6e6', '#39322f', 0.55));
    if (!shadows) return;
    this.key.castShadow = true;
    const { shadow } = this.key;
    shadow.mapSize.set(1024, 1024);
    Object.assign(shadow.camera, { left: -1.7, right: 1.7, top: 1.9, bottom: -1.6, near: 1, far: 9 });
    shadow.radius = 5;
    shadow.bias = -0.0004;
    shadow.normalBias = 0.018;
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

/** Soft boxes in a dark room, filtered for reflections: they give the satin skin and the visor something to mirror. */
export function createSurroundings(renderer: WebGLRenderer): Texture {
  const room = new Scene();
  const box = new BoxGeometry();
  const panel = (
    colour: string,
    strength: number,
    position: [number, number, number],
    size: [number, number, number],
  ) => {
    const mesh = new Mesh(box, new MeshBasicMaterial({ color: new Color(colour).multiplyScalar(strength) }));
    mesh.position.set(...position);
    mesh.scale.set(...size);
    room.add(mesh);
  };
  const walls = new Mesh(box, new MeshBasicMaterial({ color: '#1b2029', side: BackSide }));
  walls.scale.set(12, 8, 12);
  room.add(walls);
  panel('#fff3e4', 9, [1.5, 3.6, 2.5], [3.4, 0.1, 2.4]);
  panel('#dfe9ff', 4, [-5.6, 1, 1], [0.1, 2.6, 3]);
  panel('#a9c4ff', 5, [-2, 1.5, -5.7], [3, 2.2, 0.1]);
  panel('#ffc9ae', 4, [5.6, 0.6, -1.5], [0.1, 2.4, 2.6]);
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(room, 0.05, 0.1, 30, { size: 64 }).texture;
  generator.dispose();
  box.dispose();
  for (const child of room.children) ((child as Mesh).material as MeshBasicMaterial).dispose();
  return texture;
}
