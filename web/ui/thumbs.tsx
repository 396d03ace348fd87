import { signal, type Signal } from '@preact/signals';
import { createContext } from 'preact';
import { useContext, useEffect, useMemo, useRef } from 'preact/hooks';
import type { FigureLook } from '../core/figure-look';
import { forwardKinematics, PARENTS } from '../core/skeleton';
import { poseToQuaternions } from '../core/rotation';

/** Renders a pose to an object URL. */
export interface Thumbnailer {
  /** Another look than the one of a new project is for this picture only. */
  render(rotations: readonly number[], size: number, azimuth?: number, look?: FigureLook): Promise<string>;
}

/** Pictures are rendered once at this size (CSS pixels; twice as many real ones) and scaled down where they are shown. */
const SIZE = 96;

/** Pictures of poses, rendered when they come into sight and kept as long as their pose. */
export class Thumbnails {
  readonly #cache = new WeakMap<readonly number[], Signal<string | null>>();
  readonly #queue: (readonly number[])[] = [];
  #thumbnailer: Thumbnailer | null = null;
  #calm: () => Promise<void> = () => Promise.resolve();
  #busy = false;

  /**
   * Gives the renderer; what was asked for before is rendered now.
   * @param calm - Resolves when the page has nothing more urgent to do.
   */
  connect(thumbnailer: Thumbnailer, calm: () => Promise<void>): void {
    this.#thumbnailer = thumbnailer;
    this.#calm = calm;
    void this.#work();
  }

  /** The picture's address, null until it is there. */
  of(rotations: readonly number[]): Signal<string | null> {
    let address = this.#cache.get(rotations);
    if (!address) this.#cache.set(rotations, (address = signal<string | null>(null)));
    return address;
  }

  /**
   * A picture of the figure in some look, made in a calm moment; null where there is no 3D.
   * @returns an object URL, which the caller revokes
   */
  async dressed(rotations: readonly number[], look: FigureLook): Promise<string | null> {
    await this.#calm();
    return this.#thumbnailer?.render(rotations, SIZE, undefined, look).catch(() => null) ?? null;
  }

  /** Asks for the picture. */
  want(rotations: readonly number[]): void {
    if (this.of(rotations).value || this.#queue.includes(rotations)) return;
    this.#queue.push(rotations);
    void this.#work();
  }

  /** Takes back what is out of sight again before its turn came: who scrolls fast waits for what is seen. */
  unwant(rotations: readonly number[]): void {
    const at = this.#queue.indexOf(rotations);
    if (at >= 0) this.#queue.splice(at, 1);
  }

  async #work(): Promise<void> {
    if (this.#busy || !this.#thumbnailer) return;
    this.#busy = true;
    for (let next = this.#queue.shift(); next; next = this.#queue.shift()) {
      await this.#calm();
      try {
        this.of(next).value = await this.#thumbnailer.render(next, SIZE);
      } catch {
        break; // no 3D here: the drawn figures stay
      }
    }
    this.#busy = false;
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

/** A pose as a drawn figure; unless it is a `sketch`, that asks for the rendered one. */
export function DrawnPose({ rotations, sketch = false }: { rotations: readonly number[]; sketch?: boolean }) {
  const thumbnails = useContext(ThumbnailsContext);
  const drawing = useRef<SVGSVGElement>(null);
  useEffect(() => {
    if (sketch) return;
    const observer = new IntersectionObserver((entries) => {
      if (entries.at(-1)!.isIntersecting) thumbnails.want(rotations);
      else thumbnails.unwant(rotations);
    });
    observer.observe(drawing.current!);
    return () => observer.disconnect();
  }, [rotations, sketch, thumbnails]);
  const bones = useMemo(() => {
    const joints = forwardKinematics(poseToQuaternions(rotations), [0, 0, 0]);
    return PARENTS.map((parent, joint) => {
      if (parent < 0) return null;
      const [a, b] = [parent * 3, joint * 3];
      return { x1: joints[a], y1: -joints[a + 1], x2: joints[b], y2: -joints[b + 1] };
    });
  }, [rotations]);
  return (
    <svg ref={drawing} class="pose-picture drawn" viewBox="-1 -1.05 2 2.1" aria-hidden="true">
      {bones.map((bone, i) => bone && <line key={i} {...bone} />)}
    </svg>
  );
}
