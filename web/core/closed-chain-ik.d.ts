/** The part of closed-chain-ik that ik-body.ts uses; the package's own types are of boxed numbers and leave out what we need. */
declare module 'closed-chain-ik/src/core/index.js' {
  /** Degrees of freedom, in the order that setDoF wants. */
  export const DOF: Readonly<Record<'X' | 'Y' | 'Z' | 'EX' | 'EY' | 'EZ', number>>;

  /** A coordinate system in a tree of them. */
  export class Frame {
    setPosition(x: number, y: number, z: number): void;
    setQuaternion(x: number, y: number, z: number, w: number): void;
  }

  /** A rigid part. */
  export class Link extends Frame {
    addChild(joint: Joint): void;
  }

  /** What moves one part against another. */
  export class Joint extends Frame {
    readonly dof: readonly number[];
    /** Values of all six degrees of freedom: metres, radians. */
    readonly dofValues: Float32Array;
    setDoF(...dof: number[]): void;
    setDoFValues(...values: number[]): void;
    addChild(link: Link): void;
    makeClosure(link: Link): void;
    removeChild(link: Link): void;
    /** World matrix after a small change of one degree of freedom; true when it was made the other way. */
    getDeltaWorldMatrix(dof: number, delta: number, out: ArrayLike<number>): boolean;
  }

  /** A place in the world where a link should be. */
  export class Goal extends Joint {
    setGoalDoF(...dof: number[]): void;
  }

  /** Damped least squares over the chains that end in goals. */
  export class Solver {
    maxIterations: number;
    stallThreshold: number;
    dampingFactor: number;
    divergeThreshold: number;
    restPoseFactor: number;
    translationConvergeThreshold: number;
    rotationConvergeThreshold: number;
    translationErrorClamp: number;
    constructor(roots: readonly Frame[]);
    updateStructure(): void;
    solve(): number[];
  }
}
