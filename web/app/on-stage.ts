import type { ProjectDocument } from '../core/document';
import type { State } from './state';

/** The document that the dance on stage belongs to: that of now, or the held one while it is compared. */
export function documentOnStage({ compare, document }: State): ProjectDocument {
  const held = compare.value;
  return held?.shown === 'a' ? held.document : document.value;
}
