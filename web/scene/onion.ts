import { Color, EqualDepth, Group, Matrix4, ShaderMaterial, SkinnedMesh } from 'three';
import { poseToQuaternions } from '../core/rotation';
import { standingRoot } from './body-points';
import { Figure } from './figure';
import type { FigureAsset } from './figure-asset';
import { ACCENT } from './handles';

/** A neighbouring key pose to show beside the figure. */
export interface Ghost {
  /** 24 x 3 axis-angle, radians. */
  rotations: ArrayLike<number>;
  /** Pelvis position, metres; missing: standing at the centre of the stage. */
  root?: ArrayLike<number>;
  kind: 'before' | 'after';
}

/**
 * How the two differ, without relying on colour: what was is thin and striped, what comes is a filled body with a strong outline.
 * `fill` and `rim` are opacities where the body faces the eye and at its outline.
 */
const LOOKS = {
  before: { colour: new Color('#c9985a'), fill: 0.1, rim: 0.66, stripes: 1 },
  after: { colour: new Color(ACCENT), fill: 0.2, rim: 0.85, stripes: 0 },
} as const;

/** Onion skin: the key poses before and after as translucent bodies. Four draw calls when both are shown; no pointer ever hits them. */
export class Onion {
  readonly group = new Group();
  private readonly ghosts = new Map<Ghost['kind'], GhostFigure>();

  /**
   * Shows these ghosts, at most one of a kind, or none.
   * @param asset the figure's shape
   */
  set(asset: FigureAsset, ghosts: readonly Ghost[] | null): void {
    for (const kind of ['before', 'after'] as const) {
      const ghost = ghosts?.find((each) => each.kind === kind);
      let figure = this.ghosts.get(kind);
      if (ghost && !figure) {
        figure = new GhostFigure(asset, kind);
        this.ghosts.set(kind, figure);
        this.group.add(figure.group);
      }
      if (ghost) figure!.show(ghost);
      if (figure) figure.group.visible = ghost !== undefined;
    }
  }

  /** Frees the ghosts. */
  dispose(): void {
    for (const ghost of this.ghosts.values()) ghost.dispose();
  }
}

/** A body drawn twice: first only its depth, then its nearest surface, so that no inside shines through. */
class GhostFigure {
  readonly group = new Group();
  private readonly figure: Figure;
  private readonly veil: ShaderMaterial;

  constructor(asset: FigureAsset, kind: Ghost['kind']) {
    this.figure = new Figure(asset, asset.levels.length - 1, ghostMaterial(kind));
    const { mesh } = this.figure;
    mesh.castShadow = false;
    mesh.receiveShadow = false;
    this.veil = ghostMaterial(kind);
    Object.assign(this.veil, { colorWrite: false, depthWrite: true });
    const depth = new SkinnedMesh(mesh.geometry, this.veil);
    depth.bind(mesh.skeleton, new Matrix4());
    depth.frustumCulled = false;
    depth.boundingSphere = mesh.boundingSphere;
    // One ghost after the other: the second's depth must not hide the first before it is drawn.
    depth.renderOrder = kind === 'before' ? 1 : 3;
    mesh.renderOrder = depth.renderOrder + 1;
    (mesh.material as ShaderMaterial).depthFunc = EqualDepth;
    this.group.add(depth, mesh);
  }

  show({ rotations, root }: Ghost): void {
    const quaternions = poseToQuaternions(rotations);
    this.figure.show({ quaternions, root: root ?? standingRoot(quaternions) });
  }

  dispose(): void {
    this.figure.dispose();
    this.veil.dispose();
  }
}

function ghostMaterial(kind: Ghost['kind']): ShaderMaterial {
  const { colour, fill, rim, stripes } = LOOKS[kind];
  return new ShaderMaterial({
    transparent: true,
    depthWrite: false,
    // Where a ghost and the figure agree the figure is seen, not a flicker of both.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 4,
    uniforms: {
      colour: { value: colour },
      fill: { value: fill },
      rim: { value: rim },
      stripes: { value: stripes },
    },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
  });
}

const VERTEX = /* glsl */ `
#include <common>
#include <skinning_pars_vertex>
varying vec3 vFacing;
varying vec3 vToEye;
varying float vHeight;
void main() {
  #include <beginnormal_vertex>
  #include <skinbase_vertex>
  #include <skinnormal_vertex>
  #include <begin_vertex>
  #include <skinning_vertex>
  vec4 world = modelMatrix * vec4(transformed, 1.0);
  vec4 seen = viewMatrix * world;
  vHeight = world.y;
  vFacing = normalMatrix * objectNormal;
  vToEye = -seen.xyz;
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 colour;
uniform float fill, rim, stripes;
varying vec3 vFacing;
varying vec3 vToEye;
varying float vHeight;
void main() {
  float grazing = 1.0 - abs(dot(normalize(vFacing), normalize(vToEye)));
  float opacity = mix(fill, rim, smoothstep(0.25, 0.95, grazing));
  // Stripes every 3 cm of height, softened to about a pixel.
  float wave = abs(fract(vHeight / 0.03) - 0.5) * 2.0;
  float soft = clamp(fwidth(vHeight) / 0.03 * 2.0, 0.02, 1.0);
  float stripe = smoothstep(0.5 - soft, 0.5 + soft, wave);
  opacity *= mix(1.0, mix(0.35, 1.0, stripe), stripes);
  gl_FragColor = vec4(colour, opacity);
  #include <colorspace_fragment>
}`;
