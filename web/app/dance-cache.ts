/** Dances that were made on this page, so that undo, takes and comparisons bring the very same ones back at once. */
import { flattened, type UncorrectedDance } from '../core/finish';
import { rangeContext, sameMotion, type RangeLayer } from '../core/range-layer';
import type { Motion } from '../core/types';
import { madeFrom, recipeOf, sameGround, type DanceInputs, type RangeStep } from './recipe';
import type { Dance } from './state';

/** What is kept at most; the least recently wanted dances go first. Some 400 bytes a frame of a dance. */
const KEPT = { dances: 60, bytes: 96e6 };

/** A dance of which all inputs are known. */
type MadeDance = Dance & { inputs: DanceInputs };

interface Entry {
  dance: MadeDance;
  /** Of its song. */
  hash: string;
}

/** Remembers dances; parts that several share count once. */
export class DanceCache {
  /** The most recently wanted last. */
  private entries: Entry[] = [];

  /** @param frames length of the song at hand */
  constructor(private readonly frames: () => number) {}

  /** Keeps a dance that the document's own dials made; one made from the same gives way. Other songs' dances go. */
  remember(dance: Dance, hash: string): void {
    const { inputs } = dance;
    if (!inputs) return;
    this.entries = this.entries.filter(
      (entry) => entry.hash === hash && !this.fits(entry.dance, inputs) && entry.dance !== dance,
    );
    this.entries.push({ dance: { ...dance, inputs }, hash });
    while (this.entries.length > 1 && (this.entries.length > KEPT.dances || this.bytes() > KEPT.bytes)) {
      this.entries.shift();
    }
  }

  /** The dance that was made from these inputs; its strengths may be others where it can be finished again. */
  find(hash: string, inputs: DanceInputs): Dance | null {
    const found = this.entries.findLast((entry) => entry.hash === hash && this.fits(entry.dance, inputs));
    if (!found) return null;
    this.entries = [...this.entries.filter((entry) => entry !== found), found];
    return found.dance;
  }

  /** The whole dance below the ranges. */
  base(hash: string, inputs: DanceInputs): { uncorrected: UncorrectedDance; result: Dance['result'] } | null {
    const { base } = recipeOf(inputs, this.frames());
    for (const { dance } of this.similar(hash, inputs)) {
      const { uncorrected, result } = dance;
      const own = recipeOf(dance.inputs, this.frames()).base;
      if (uncorrected && own.seed === base.seed && own.variation === base.variation) {
        return { uncorrected: { ...uncorrected, layers: undefined }, result };
      }
    }
    return null;
  }

  /** What the network gave for a range in the same surroundings. */
  layer(hash: string, inputs: DanceInputs, below: UncorrectedDance, step: RangeStep): RangeLayer | null {
    const start = below.place?.from ?? 0;
    const [from, to] = [step.from - start, step.to - start];
    let context: Motion | null = null;
    for (const { dance } of this.similar(hash, inputs)) {
      for (const layer of dance.uncorrected?.layers ?? []) {
        if (layer.from !== from || layer.to !== to) continue;
        if (layer.seed !== step.seed || layer.variation !== step.variation) continue;
        context ??= rangeContext(flattened(below), from, to);
        if (sameMotion(layer.context, context)) return layer;
      }
    }
    return null;
  }

  private similar(hash: string, inputs: DanceInputs): Entry[] {
    return this.entries.filter((entry) => entry.hash === hash && sameGround(entry.dance.inputs, inputs, this.frames()));
  }

  private fits(dance: MadeDance, inputs: DanceInputs): boolean {
    return madeFrom(dance.inputs, inputs, dance.uncorrected !== undefined, this.frames());
  }

  private bytes(): number {
    const buffers = new Set<ArrayBufferLike>();
    const add = ({ root, quaternions }: Motion) => buffers.add(root.buffer).add(quaternions.buffer);
    for (const { dance } of this.entries) {
      add(dance.motion);
      const { curves } = dance;
      if (curves) for (const part of [curves.keys, curves.inner, curves.shape]) buffers.add(part.buffer);
      if (!dance.uncorrected) continue;
      add(dance.uncorrected.motion);
      for (const { motion, context } of dance.uncorrected.layers ?? []) {
        add(motion);
        add(context);
      }
    }
    return [...buffers].reduce((sum, { byteLength }) => sum + byteLength, 0);
  }
}
