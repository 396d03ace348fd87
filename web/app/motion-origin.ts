/** Where a dance comes from, for the files that it leaves as. */
import type { ProjectDocument } from '../core/document';
import type { MotionOrigin } from '../core/formats/motion-origin';
import { hashBytes, motionHash } from './hash';
import type { Dance, State } from './state';

/** What identifies a project: its JSON but for where the visitor looks from. */
export function projectHash(document: ProjectDocument): Promise<string> {
  return hashBytes(new TextEncoder().encode(JSON.stringify({ ...document, camera: null })).buffer);
}

/**
 * The origin of a dance of this page, the one of now or the held one; what is not known of it is left out.
 * @param part - The frames that are in the file, [from, to); without it all.
 */
export async function originOf(
  { compare, document, stale }: State,
  dance: Dance,
  part = { from: 0, to: dance.motion.frames },
): Promise<MotionOrigin> {
  const { motion, inputs, result, byDials, keyStrength } = dance;
  const held = compare.value?.dance === dance ? compare.value.document : null;
  // A dance that the project has moved on from, or that a call made with other dials, is not the project's.
  const project = held ?? (stale.value ? null : document.value);
  const dials = byDials && inputs ? { ...inputs.dials, ...(keyStrength === undefined ? {} : { keyStrength }) } : {};
  return {
    motionHash: await motionHash(motion),
    frames: motion.frames,
    ...part,
    ...(byDials && project ? { projectHash: await projectHash(project) } : {}),
    ...(inputs ? { engine: inputs.engine ?? 'light' } : {}),
    ...dials,
    ...(result ? { model: result.model, backend: result.backend } : {}),
  };
}
