/** Plain-English names of limbs. */
import type { Limb } from '../core/pose-tools';

/** A limb as people call it, e.g. "Left arm". */
export function limbLabel(limb: Limb): string {
  const words = limb.replace('_', ' ');
  return words[0].toUpperCase() + words.slice(1);
}
