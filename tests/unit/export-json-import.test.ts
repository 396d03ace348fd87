import { describe, expect, it, vi } from 'vitest';
import { createStore } from '../../web/app/store';
import { Player } from '../../web/audio/player';
import { emptyCurves, sampleCurves } from '../../web/core/curves';
import { writeCurvesJson } from '../../web/core/formats/curves-json';
import { jsonKind, readMotionClip } from '../../web/core/formats/motion-clip';
import { writeMotionJson } from '../../web/core/formats/motion-json';
import { MAX_FRAMES, suggestFrames } from '../../web/core/formats/pose-sequence';
import { writePoseFile } from '../../web/core/formats/pose-file';
import { emptyMotion } from '../../web/core/motion';
import { angleBetween, axisAngleToQuaternion, quaternionsToPose } from '../../web/core/rotation';
import { openFile } from '../../web/ui/files';
import { swingingMotion } from './dance';
import { fakeReporter, fakeServices, settled } from './support/app';

const motion = swingingMotion(150);
const music = { name: 'A song.mp3', start: 0, tempo: 120, beatsPerBar: 4 as const, beats: [0], downbeats: [0] };
const keyPoses = [0.5, 1, 2.5].map((time) => ({ time }));
const json = writeMotionJson(motion, { song: music, keyPoses });

/** Curves of five seconds: an arm goes up, with key poses at 1 and 3 seconds and one on a beat between them. */
function arm() {
  const curves = emptyCurves([1, 2, 3], 5, ['k1', 4, 'k2']);
  const angles = [0, 0.6, 1.2];
  angles.forEach((angle, k) => curves.keys.set(axisAngleToQuaternion([0, 0, angle]), k * 99 + 3 + 16 * 4));
  [0.2, 0.4, 0.8, 1].forEach((angle, n) => curves.inner.set(axisAngleToQuaternion([0, 0, angle]), n * 99 + 3 + 16 * 4));
  return curves;
}

function store() {
  const made = createStore(fakeServices(new Player(() => ({}) as AudioContext)), fakeReporter());
  return made;
}
const file = (text: string, name: string) => new File([text], name);

describe('a dance of ours as a source of poses', () => {
  it('comes back frame by frame, its key poses pointed out', () => {
    const { kind, clips } = readMotionClip(json);
    const [clip] = clips;
    expect([kind, clip.name, clip.fps, clip.frames, clip.marks]).toEqual([
      'Posebeat',
      'A song.mp3',
      30,
      150,
      [15, 30, 75],
    ]);
    for (let i = 0; i < clip.quaternions.length; i += 4) {
      expect(angleBetween(clip.quaternions.subarray(i, i + 4), motion.quaternions.subarray(i, i + 4))).toBeLessThan(
        1e-4,
      );
    }
    expect(suggestFrames(clip, 6)).toEqual([15, 30, 75]);
    expect(suggestFrames(clip, 2)).toEqual([15, 75]);
  });

  it('of curves is sampled, the visitor’s own key poses pointed out', () => {
    const curves = arm();
    const { clips } = readMotionClip(writeCurvesJson(curves));
    const [clip] = clips;
    expect([clip.fps, clip.frames, clip.marks]).toEqual([30, 151, [30, 90]]);
    const truth = sampleCurves(curves, 30);
    for (let i = 0; i < truth.quaternions.length; i += 4) {
      expect(angleBetween(clip.quaternions.subarray(i, i + 4), truth.quaternions.subarray(i, i + 4))).toBeLessThan(
        1e-4,
      );
    }
  });

  it('that is longer than can be held is thinned out, whatever length it claims', () => {
    const long = emptyMotion(MAX_FRAMES + 10);
    const [clip] = readMotionClip(writeMotionJson(long, { keyPoses: [{ time: 100 }] })).clips;
    expect([clip.fps, clip.frames, clip.marks]).toEqual([15, MAX_FRAMES / 2 + 5, [1500]]);
    const raw = JSON.parse(writeCurvesJson(arm())) as { duration: number };
    const endless = readMotionClip(JSON.stringify({ ...raw, duration: 1e12 })).clips[0];
    expect(endless.frames).toBeLessThanOrEqual(MAX_FRAMES);
  });

  it('is known by what stands inside', () => {
    expect(jsonKind(json.slice(0, 4096))).toBe('motion');
    expect(jsonKind(writeCurvesJson(arm()).slice(0, 4096))).toBe('curves');
    expect(jsonKind(writePoseFile([]))).toBe('poses');
    expect(jsonKind('{"format":"posebeat","version":2}')).toBeNull();
  });
});

describe('JSON that is chosen or dropped', () => {
  it.each([
    ['frames', json, 'Warm Circuit.json'],
    ['curves', writeCurvesJson(arm()), 'Warm Circuit.curves.json'],
  ])('of a dance in %s opens in the import panel and gives a starting clip and key poses', async (_, text, name) => {
    const page = store();
    await page.start();
    await page.loadSong(file('song', 'a song.mp3'));
    const before = page.state.document.value;
    openFile(page, file(text, name));
    await vi.waitFor(() => expect(page.state.poseImport.value?.kind).toBe('Posebeat'));
    expect(page.state.document.value).toBe(before);
    page.useFileAsSeed();
    expect(page.state.document.value.ownSeed?.name).toBe('Warm Circuit');
    page.useFileAsDance('beat');
    expect(page.state.document.value.keyPoses.length).toBeGreaterThan(8);
    page.chooseFrame(75);
    page.saveFrame();
    const { clips } = readMotionClip(text);
    expect(page.state.ownPoses.value[0].rotations).toEqual(
      quaternionsToPose(clips[0].quaternions.subarray(75 * 96, 76 * 96)),
    );
  });

  it('of poses and of projects goes where it belongs, whatever its name', async () => {
    const page = store();
    await page.start();
    const pose = { name: 'up', rotations: new Array<number>(72).fill(0.1) };
    openFile(page, file(writePoseFile([pose]), 'mine.json'));
    await vi.waitFor(() => expect(page.state.ownPoses.value).toHaveLength(1));
    openFile(page, file(JSON.stringify({ ...page.state.document.value, avatar: 'other' }), 'project.json'));
    await vi.waitFor(() => expect(page.state.document.value.avatar).toBe('other'));
  });

  it.each([
    ['cut off', json.slice(0, 3000)],
    ['of another skeleton', json.replace('"pelvis"', '"hips"')],
    ['newer', json.replace('"version": 1', '"version": 7')],
    ['without numbers', json.replace(/"rotations": \[\n\[[^,]*,/, '"rotations": [\n[null,')],
    ['of curves, cut off', writeCurvesJson(arm()).slice(0, 3000)],
  ])('that is damaged (%s) is refused in a sentence and changes nothing', async (_, text) => {
    const page = store();
    await page.start();
    const before = page.state.document.value;
    await page.importPoseFile(file(text, 'dance.json'));
    expect(page.state.notices.value.at(-1)?.text).toMatch(/^“dance\.json” was not opened\. [A-Z].+\.$/);
    expect(page.state.poseImport.value).toBeNull();
    expect(page.state.document.value).toBe(before);
    await settled();
  });
});
