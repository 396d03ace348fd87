/** Where the weight is: a ring on the floor under the centre of mass, and the outline of what the body stands on. */
import {
  BufferAttribute,
  BufferGeometry,
  CircleGeometry,
  Color,
  Group,
  InstancedMesh,
  Line,
  LineLoop,
  LineBasicMaterial,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  RingGeometry,
} from 'three';
import { centreOfMass, contacts, isBalanced, supportPolygon } from '../core/balance';

const STEADY = new Color('#6fd08c');
const FALLING = new Color('#ffb454');
const FLAT = -Math.PI / 2;
/** Above the floor, so that neither flickers through the other; metres. */
const LIFT = 0.006;
const MOST_CONTACTS = 16;
const MOST_CORNERS = 64;

/** The balance hint of the pose editor. */
export class BalanceOverlay {
  readonly group = new Group();
  private readonly tint = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.95,
    depthTest: false,
    depthWrite: false,
  });
  private readonly faint = new MeshBasicMaterial({ transparent: true, opacity: 0.32, depthWrite: false });
  private readonly plumb = new LineBasicMaterial({ transparent: true, opacity: 0.6, depthWrite: false });
  private readonly ring = new Mesh(new RingGeometry(0.038, 0.052, 40).rotateX(FLAT), this.tint);
  private readonly dot = new Mesh(new CircleGeometry(0.012, 20).rotateX(FLAT), this.tint);
  private readonly marks = new InstancedMesh(new CircleGeometry(0.05, 28).rotateX(FLAT), this.faint, MOST_CONTACTS);
  private readonly outline = new BufferAttribute(new Float32Array(MOST_CORNERS * 3), 3);
  private readonly border = new LineLoop(new BufferGeometry().setAttribute('position', this.outline), this.plumb);
  private readonly ends = new BufferAttribute(new Float32Array(6), 3);
  private readonly matrix = new Matrix4();

  constructor() {
    const line = new Line(new BufferGeometry().setAttribute('position', this.ends), this.plumb);
    this.marks.count = 0;
    for (const part of [line, this.border, this.marks]) part.frustumCulled = false;
    this.marks.renderOrder = 2;
    this.ring.renderOrder = this.dot.renderOrder = 3;
    this.group.add(line, this.border, this.marks, this.ring, this.dot);
    this.group.visible = false;
  }

  /**
   * Follows a pose.
   * @param joints 24 x 3 world positions, metres
   */
  update(joints: Float32Array): void {
    const [x, y, z] = centreOfMass(joints);
    const colour = isBalanced(joints) ? STEADY : FALLING;
    for (const material of [this.tint, this.faint, this.plumb]) material.color.copy(colour);
    this.ring.position.set(x, LIFT, z);
    this.dot.position.set(x, LIFT, z);
    this.ends.setXYZ(0, x, y, z);
    this.ends.setXYZ(1, x, LIFT, z);
    this.ends.needsUpdate = true;
    const corners = supportPolygon(joints).slice(0, MOST_CORNERS);
    corners.forEach(([cx, cz], i) => this.outline.setXYZ(i, cx, LIFT, cz));
    this.outline.needsUpdate = true;
    this.border.geometry.setDrawRange(0, corners.length);
    const standing = contacts(joints);
    this.marks.count = Math.min(standing.length, MOST_CONTACTS);
    standing.slice(0, MOST_CONTACTS).forEach((joint, i) => {
      this.marks.setMatrixAt(i, this.matrix.makeTranslation(joints[joint * 3], LIFT / 2, joints[joint * 3 + 2]));
    });
    this.marks.instanceMatrix.needsUpdate = true;
  }

  /** Frees the shapes. */
  dispose(): void {
    for (const part of this.group.children) (part as Mesh).geometry.dispose();
    this.marks.dispose();
    for (const material of [this.tint, this.faint, this.plumb]) material.dispose();
    this.group.removeFromParent();
  }
}
