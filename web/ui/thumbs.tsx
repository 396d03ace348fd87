import { signal, type Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useMemo } from 'preact/hooks';
import { forwardKinematics, PARENTS } from '../core/skeleton';
import { poseToQuaternions } from '../core/rotation';

/** Renders a pose to an object URL. */
export interface Thumbnailer {
  render(rotations: readonly number[], size: number): Promise<string>;
}

/** Pictures are rendered once at this size (CSS pixels; twice as many real ones) and scaled down where they are shown. */
const SIZE = 96;

/** Pictures of poses, rendered when first asked for and kept as long as their pose. */
export class Thumbnails {
  readonly #cache = new WeakMap<readonly number[], Signal<string | null>>();
  #thumbnailer: Thumbnailer | null = null;
  #waiting: (() => void)[] = [];

  /** Gives the renderer; what was asked for before is rendered now. */
  connect(thumbnailer: Thumbnailer): void {
    this.#thumbnailer = thumbnailer;
    for (const start of this.#waiting.splice(0)) start();
  }

  /** The picture's address, null until it is there. */
  of(rotations: readonly number[]): Signal<string | null> {
    const known = this.#cache.get(rotations);
    if (known) return known;
    const address = signal<string | null>(null);
    this.#cache.set(rotations, address);
    const start = () => {
      this.#thumbnailer?.render(rotations, SIZE).then(
        (url) => (address.value = url),
        () => undefined, // the drawn figure stays
      );
    };
    if (this.#thumbnailer) start();
    else this.#waiting.push(start);
    return address;
  }
}

/** The page's pictures of poses. */
export const ThumbnailsContext = createContext(new Thumbnails());

/** A pose as a picture: a drawn figure at once, the rendered one when it is ready. */
export function PosePicture({ rotations }: { rotations: readonly number[] }) {
  const address = useContext(ThumbnailsContext).of(rotations);
  if (address.value) return <img class="pose-picture" src={address.value} alt="" draggable={false} />;
  return <DrawnPose rotations={rotations} />;
}

function DrawnPose({ rotations }: { rotations: readonly number[] }) {
  const bones = useMemo(() => {
    const joints = forwardKinematics(poseToQuaternions(rotations), [0, 0, 0]);
    return PARENTS.map((parent, joint) => {
      if (parent < 0) return null;
      const [a, b] = [parent * 3, joint * 3];
      return { x1: joints[a], y1: -joints[a + 1], x2: joints[b], y2: -joints[b + 1] };
    });
  }, [rotations]);
  return (
    <svg class="pose-picture drawn" viewBox="-1 -1.05 2 2.1" aria-hidden="true">
      {bones.map((bone, i) => bone && <line key={i} {...bone} />)}
    </svg>
  );
}
