/** Files that come with the page, addressed relative to it so that any sub-path works. */
import * as v from 'valibot';
import { parseDocument } from '../core/document-read';
import { decodeMotion } from '../core/formats/motion-binary';
import type { LibraryPose, SeedClip } from '../core/types';
import type { Assets } from './ports';

const rotations = v.pipe(v.array(v.number()), v.length(72));
const posesSchema = v.object({
  poses: v.array(v.object({ id: v.string(), name: v.string(), group: v.string(), rotations })),
});
const clipsSchema = v.object({
  clips: v.array(
    v.object({
      id: v.string(),
      name: v.string(),
      description: v.string(),
      beats: v.number(),
      rate: v.number(),
      poses: v.array(rotations),
      root: v.array(v.tuple([v.number(), v.number(), v.number()])),
    }),
  ),
});

/** @param base - Address of the page. */
export function createAssets(base: string): Assets {
  const get = async (path: string): Promise<Response> => {
    const response = await fetch(new URL(path, base));
    if (!response.ok) throw new Error(`${path}: ${response.status}`);
    return response;
  };
  const json = async (path: string): Promise<unknown> => (await get(path)).json();
  return {
    poses: async (): Promise<LibraryPose[]> => v.parse(posesSchema, await json('library/poses.json')).poses,
    seeds: async (): Promise<SeedClip[]> => v.parse(clipsSchema, await json('library/seeds.json')).clips,
    async demo() {
      const [raw, motion] = await Promise.all([json('demo/demo.json'), get('demo/dance.bin')]);
      return {
        document: parseDocument(raw).document,
        motion: decodeMotion(await motion.arrayBuffer()),
        songUrl: new URL('demo/song.mp3', base).href,
      };
    },
  };
}
