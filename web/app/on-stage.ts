import type { ProjectDocument } from '../core/document';
import { DEFAULT_LOOK } from '../core/figure-look';
import type { SceneRequest } from '../video/protocol';
import type { State } from './state';

/** The document that the dance on stage belongs to: that of now, or the held one while it is compared. */
export function documentOnStage({ compare, document }: State): ProjectDocument {
  const held = compare.value;
  return held?.shown === 'a' ? held.document : document.value;
}

/** Who is to be seen where a picture or a film is made: a character of the visitor's own, or our figure as a document dresses it. */
export function dancerOf({ avatar }: State, { look }: ProjectDocument): Pick<SceneRequest, 'look' | 'avatar'> {
  return { look: look ?? DEFAULT_LOOK, ...(avatar.value ? { avatar: avatar.value.source } : {}) };
}
