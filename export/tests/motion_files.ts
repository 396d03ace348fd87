/**
 * Writes a synthetic dance in every format with the page's own writers, and beside them where its joints are: what other people's
 * readers are held against. `npx tsx export/tests/motion_files.ts FOLDER [FRAMES]`
 */
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { jointsOf, wildMotion } from '../../tests/unit/support/wild-motion';
import { writeBvh } from '../../web/core/formats/bvh-write';
import { motionSamplers } from '../../web/core/formats/glb-motion';
import { writeGlb } from '../../web/core/formats/glb-write';
import { writeMotionJson } from '../../web/core/formats/motion-json';
import { writeNpz } from '../../web/core/formats/npz-write';
import { motionToAxisAngle } from '../../web/core/motion';
import { glbToFbx } from '../../web/scene/fbx-file';
import { resampleMotion } from '../../web/core/motion-resample';

const [folder, frames = '61'] = process.argv.slice(2);
if (!folder) throw new Error('Usage: npx tsx export/tests/motion_files.ts FOLDER [FRAMES]');
mkdirSync(folder, { recursive: true });
const motion = wildMotion(Number(frames), 5);
const save = (name: string, content: string | Uint8Array) => writeFileSync(join(folder, name), content);

save('dance.bvh', writeBvh(motion, { units: 'm' }));
save('dance-60-cm.bvh', writeBvh(resampleMotion(motion, 60), { units: 'cm' }));
const glb = writeGlb({ name: 'dance', samplers: motionSamplers(motion) });
save('dance.glb', glb);
save('dance.fbx', await glbToFbx(glb, motion.fps));
const origin = { motionHash: 'ab'.repeat(32), frames: motion.frames, from: 0, to: motion.frames, model: 'löwe “1”' };
save('dance.npz', writeNpz(motion, origin));
save('dance.json', writeMotionJson(motion, { origin }));
const joints = Array.from({ length: motion.frames }, (_, frame) => Array.from(jointsOf(motion, frame)));
const rotations = Array.from(motionToAxisAngle(motion));
save('truth.json', JSON.stringify({ fps: motion.fps, joints, rotations, root: Array.from(motion.root), origin }));
