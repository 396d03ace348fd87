import { describe, expect, it } from 'vitest';
import { Player } from '../../web/audio/player';
import { createStore } from '../../web/app/store';
import { withinLimits } from '../../web/core/joint-limits';
import { headingOfPose } from '../../web/core/pose-tools';
import { axisAngleToQuaternion, poseToQuaternions } from '../../web/core/rotation';
import { forwardKinematics, JOINT_COUNT, jointIndex, mirrorPose } from '../../web/core/skeleton';
import { standingRoot } from '../../web/scene/body-points';
import { fakeReporter, fakeServices } from './support/app';

const REST = new Array<number>(72).fill(0);
const ELBOW = jointIndex('left_elbow');
const RIGHT_ELBOW = jointIndex('right_elbow');
const CHEST = jointIndex('spine3');

function pose(turns: Record<string, [number, number, number]>): number[] {
  const rotations = [...REST];
  for (const [name, turn] of Object.entries(turns)) rotations.splice(jointIndex(name) * 3, 3, ...turn);
  return rotations;
}

async function editor(rotations: readonly number[] = REST) {
  const store = createStore(fakeServices(new Player(() => ({}) as AudioContext)), fakeReporter());
  await store.start();
  await store.loadSong(new File(['song'], 'a.mp3'));
  store.state.notices.value = [];
  store.editPose(rotations);
  const draft = () => store.state.draft.value!;
  const at = (joint: number) => draft().rotations.slice(joint * 3, joint * 3 + 3);
  return { store, draft, at };
}

describe('the editor’s own undo', () => {
  it('takes 250 steps back to the start and brings them again', async () => {
    const { store, draft } = await editor();
    const shapes = [draft().rotations];
    for (let i = 1; i <= 250; i++) {
      store.setJointDegrees(CHEST, [0, (i % 12) + 0.01 * i, 0]);
      shapes.push(draft().rotations);
    }
    for (let i = 249; i >= 0; i--) {
      store.undo();
      expect(draft().rotations).toBe(shapes[i]);
    }
    expect(draft().canUndo).toBe(false);
    for (let i = 1; i <= 250; i++) store.redo();
    expect(draft().rotations).toBe(shapes[250]);
    expect(draft().canRedo).toBe(false);
  });

  it('makes one step of a drag, none of a click, and none of a cancelled drag', async () => {
    const { store, draft } = await editor();
    store.changePose(draft().rotations, 'start');
    for (const angle of [0.1, 0.2, 0.3]) store.changePose(pose({ spine3: [0, angle, 0] }), 'change');
    store.changePose(pose({ spine3: [0, 0.3, 0] }), 'commit');
    store.changePose(draft().rotations, 'start');
    store.changePose([...draft().rotations], 'commit');
    store.changePose(draft().rotations, 'start');
    store.changePose(pose({ spine3: [0, 0.4, 0] }), 'change');
    store.changePose(pose({ spine3: [0, 0.3, 0] }), 'cancel');
    expect(draft().rotations).toEqual(pose({ spine3: [0, 0.3, 0] }));
    store.undo();
    expect(draft().rotations).toEqual(REST);
    expect(draft().canUndo).toBe(false);
  });

  it('survives leaving: a dropped pose comes back with its steps', async () => {
    const { store, draft } = await editor();
    store.setJointDegrees(CHEST, [0, 12, 0]);
    store.setJointDegrees(CHEST, [0, 10, 0]);
    const shape = draft().rotations;
    store.closeDraft();
    expect(store.state.draft.value).toBeNull();
    const [notice] = store.state.notices.value;
    expect(notice.action?.label).toBe('Bring it back');
    notice.action!.run();
    expect(draft().rotations).toEqual(shape);
    store.undo();
    store.undo();
    expect(draft().rotations).toEqual(REST);
    store.closeDraft();
  });

  it('drops nothing in silence when another pose is opened, and asks nothing when nothing was changed', async () => {
    const { store, draft } = await editor();
    store.closeDraft();
    expect(store.state.notices.value).toEqual([]);
    store.editPose(REST);
    store.setJointDegrees(CHEST, [0, 12, 0]);
    const shape = draft().rotations;
    store.editPose(pose({ head: [0.2, 0, 0] }));
    expect(draft().canUndo).toBe(false);
    store.state.notices.value[0].action!.run();
    expect(draft().rotations).toEqual(shape);
  });

  it('goes on where a key pose was left', async () => {
    const { store, draft } = await editor();
    store.setJointDegrees(CHEST, [0, 12, 0]);
    store.keepDraft();
    expect(store.state.draft.value).toBeNull();
    store.editKey(store.state.document.value.keyPoses[0].id);
    store.setJointDegrees(CHEST, [0, 15, 0]);
    store.keepDraft();
    const [key] = store.state.document.value.keyPoses;
    expect(key.rotations[CHEST * 3 + 1]).toBeCloseTo((15 * Math.PI) / 180, 9);
    store.editKey(key.id);
    store.undo();
    store.undo();
    expect(draft().rotations).toEqual(REST);
  });

  it('is kept by dropping it on the timeline; of a key pose that drops a copy', async () => {
    const { store, draft } = await editor();
    store.setJointDegrees(CHEST, [0, 12, 0]);
    store.dropDraftAt(2.2);
    expect(store.state.draft.value).toBeNull();
    const [key] = store.state.document.value.keyPoses;
    expect(key.time).toBe(2.2);
    store.editKey(key.id);
    store.dropDraftAt(4);
    expect(draft().keyId).toBe(key.id);
    expect(store.state.document.value.keyPoses.map(({ time }) => time)).toEqual([2.2, 4]);
  });

  it('stays in the editor where a locked key pose has its place', async () => {
    const { store, draft } = await editor();
    store.addKey(REST, 2, { exact: true });
    store.toggleLock();
    store.seek(2);
    store.setJointDegrees(CHEST, [0, 12, 0]);
    const shape = draft().rotations;
    store.keepDraft();
    expect(draft().rotations).toEqual(shape);
    store.dropDraftAt(2);
    expect(draft().rotations).toEqual(shape);
    store.dropDraftAt(4);
    expect(store.state.draft.value).toBeNull();
    expect(store.state.document.value.keyPoses.map(({ time }) => time)).toEqual([2, 4]);
  });

  it('does not open a locked key pose', async () => {
    const { store } = await editor();
    store.keepDraft();
    const [key] = store.state.document.value.keyPoses;
    key.locked = true;
    store.editKey(key.id);
    expect(store.state.draft.value).toBeNull();
    expect(store.state.notices.value[0].text).toContain('locked');
  });
});

describe('typed values', () => {
  it('stop at the joint’s limits and say so; without limits anything goes', async () => {
    const { store, at } = await editor();
    store.setJointDegrees(CHEST, [0, 170, 0]);
    expect(withinLimits(CHEST, axisAngleToQuaternion(at(CHEST)))).toBe(true);
    expect(store.state.poseWord.value).toBe('Chest stopped at its limit.');
    store.toggleLimits();
    store.setJointDegrees(CHEST, [0, 170, 0]);
    expect(at(CHEST)[1]).toBeCloseTo((170 * Math.PI) / 180, 9);
  });

  it('go to both sides where both move', async () => {
    const { store, at } = await editor();
    store.toggleMirrorEdit();
    store.setJointDegrees(ELBOW, [0, -60, 0]);
    expect(at(ELBOW)[1]).toBeCloseTo(-Math.PI / 3, 9);
    expect(at(RIGHT_ELBOW)[1]).toBeCloseTo(Math.PI / 3, 9);
  });

  it('mean the world where the tools do', async () => {
    const { store, at } = await editor(pose({ spine3: [0, 0.3, 0] }));
    store.toggleSpace();
    store.setJointDegrees(jointIndex('neck'), [0, 30, 0]);
    expect(at(jointIndex('neck'))[1]).toBeCloseTo(Math.PI / 6 - 0.3, 6);
  });
});

describe('typed places', () => {
  it('take a hand there, the body following, in one step, with the limits kept', async () => {
    const { store, draft, at } = await editor();
    const wrist = jointIndex('left_wrist');
    const place = () => {
      const quaternions = poseToQuaternions(draft().rotations);
      return forwardKinematics(quaternions, standingRoot(quaternions)).slice(wrist * 3, wrist * 3 + 3);
    };
    await store.moveJointTo(wrist, [0.35, 1.2, 0.35]);
    const [x, y, z] = place();
    expect(Math.hypot(x - 0.35, y - 1.2, z - 0.35)).toBeLessThan(0.02);
    for (let joint = 1; joint < JOINT_COUNT; joint++)
      expect(withinLimits(joint, axisAngleToQuaternion(at(joint)))).toBe(true);
    store.undo();
    expect(draft().rotations).toEqual(REST);
  });
});

describe('resetting and mirroring', () => {
  const bent = pose({ left_elbow: [0, -1, 0], right_elbow: [0, 0.5, 0], left_knee: [0.5, 0, 0], spine1: [0.2, 0, 0] });

  it('resets a joint, a limb, both limbs when both sides move, and the pose, in one step each', async () => {
    const { store, draft, at } = await editor(bent);
    store.resetJoint(ELBOW);
    expect(at(ELBOW)).toEqual([0, 0, 0]);
    store.undo();
    store.resetLimb('left_arm');
    expect(at(ELBOW)).toEqual([0, 0, 0]);
    expect(at(RIGHT_ELBOW)).toEqual([0, 0.5, 0]);
    store.undo();
    store.toggleMirrorEdit();
    store.resetLimb('left_arm');
    expect(at(RIGHT_ELBOW)).toEqual([0, 0, 0]);
    store.undo();
    store.resetPose();
    expect(draft().rotations).toEqual(REST);
    store.undo();
    expect(draft().rotations).toEqual(bent);
  });

  it('mirrors the pose or one limb', async () => {
    const { store, draft, at } = await editor(bent);
    store.mirrorDraft();
    expect(draft().rotations).toEqual(mirrorPose(bent));
    store.undo();
    store.mirrorLimb('left_arm');
    expect(at(RIGHT_ELBOW)).toEqual([0, 1, 0]);
    expect(at(jointIndex('left_knee'))).toEqual([0.5, 0, 0]);
  });
});

describe('copying', () => {
  it('takes a pose from one key pose to another, and onto selected ones in one step', async () => {
    const shape = pose({ left_elbow: [0, -1, 0], head: [0, 0.2, 0] });
    const { store, draft } = await editor(shape);
    store.copyPose();
    store.closeDraft();
    store.editPose(REST);
    store.pastePose();
    expect(draft().rotations).toEqual(shape);
    store.closeDraft();
    const ids = [1, 2, 3].map((time) => store.addKey(REST, time));
    store.selectKey(ids[0]);
    store.selectKey(ids[2], true);
    store.pastePoseOntoKeys();
    expect(store.state.document.value.keyPoses.map((key) => key.rotations)).toEqual([shape, REST, shape]);
    store.undo();
    expect(store.state.document.value.keyPoses.map((key) => key.rotations)).toEqual([REST, REST, REST]);
  });

  it('takes a pose copied on the timeline into the editor', async () => {
    const shape = pose({ left_elbow: [0, -1, 0] });
    const { store, draft } = await editor();
    store.addKey(shape, 2);
    store.copyKeys();
    store.pastePose();
    expect(draft().rotations).toEqual(shape);
  });

  it('takes a limb to the other side when that side is chosen', async () => {
    const { store, at } = await editor(pose({ left_elbow: [0, -1, 0], head: [0, 0.2, 0] }));
    store.selectJoint(ELBOW);
    store.copyLimbOfJoint();
    store.selectJoint(RIGHT_ELBOW);
    store.pastePose();
    expect(at(RIGHT_ELBOW)).toEqual([0, 1, 0]);
    store.selectJoint(null);
    store.resetPose();
    store.pastePose();
    expect(at(ELBOW)).toEqual([0, -1, 0]);
    expect(at(RIGHT_ELBOW)).toEqual([0, 0, 0]);
    expect(at(jointIndex('head'))).toEqual([0, 0, 0]);
  });

  it('is kept within the limits, and says so', async () => {
    const { store, at } = await editor(pose({ left_elbow: [0, 2, 0] }));
    store.copyPose();
    store.resetPose();
    store.pastePose();
    expect(store.state.poseWord.value).toBe('Pose pasted. Left elbow stopped at its limit.');
    expect(withinLimits(ELBOW, axisAngleToQuaternion(at(ELBOW)))).toBe(true);
  });

  it('says when there is nothing to paste', async () => {
    const { store } = await editor();
    store.pastePose();
    expect(store.state.poseWord.value).toBe('Nothing is copied yet.');
  });
});

describe('blending', () => {
  const other = pose({ left_elbow: [0, -1, 0] });

  it('is live, one step however far it goes, and can be cancelled', async () => {
    const { store, draft, at } = await editor();
    store.addKey(other, 2);
    expect(store.canBlend('next')).toBe(true);
    expect(store.canBlend('previous')).toBe(false);
    for (const amount of [0.2, 0.9, 0.5]) store.blendWith('next', amount);
    expect(at(ELBOW)[1]).toBeCloseTo(-0.5, 9);
    expect(store.cancelBlend()).toBe(true);
    expect(draft().rotations).toEqual(REST);
    expect(draft().canUndo).toBe(false);
    store.blendWith('next', 0.9);
    store.blendWith('next', 0.25);
    store.keepBlend();
    expect(at(ELBOW)[1]).toBeCloseTo(-0.25, 9);
    expect(store.state.poseBlend.value).toBeNull();
    store.undo();
    expect(draft().rotations).toEqual(REST);
    expect(draft().canUndo).toBe(false);
  });

  it('becomes a step by whatever is done next, and is part of what is kept', async () => {
    const { store, at } = await editor();
    store.addKey(other, 2);
    store.blendWith('next', 0.5);
    store.setJointDegrees(CHEST, [0, 10, 0]);
    store.undo();
    expect(at(ELBOW)[1]).toBeCloseTo(-0.5, 9);
    store.blendWith('next', 1);
    store.keepDraft();
    const kept = store.state.document.value.keyPoses.find((key) => key.time === 0)!;
    expect(kept.rotations[ELBOW * 3 + 1]).toBeCloseTo(-1, 9);
  });

  it('takes a pose of the library from where the figure looks', async () => {
    const { store, draft } = await editor(pose({ pelvis: [0, 1, 0] }));
    store.state.poses.value = [{ id: 'a', name: 'A', group: 'G', rotations: other }];
    store.blendWith('pose:a', 1);
    expect(headingOfPose(draft().rotations)).toBeCloseTo(1, 9);
  });
});

describe('turning and variations', () => {
  it('turns the figure live, one step a drag', async () => {
    const { store, draft } = await editor();
    for (const degrees of [10, 40, 90]) store.previewHeading(degrees);
    store.settlePose();
    expect(headingOfPose(draft().rotations)).toBeCloseTo(Math.PI / 2, 9);
    store.previewHeading(-30);
    store.settlePose();
    expect(headingOfPose(draft().rotations)).toBeCloseTo(-Math.PI / 6, 9);
    store.undo();
    store.undo();
    expect(draft().rotations).toEqual(REST);
  });

  it('varies within the limits, differently each time, from the same pose', async () => {
    const { store, draft, at } = await editor();
    const seen: string[] = [];
    let furthest = 0;
    store.setVariationAmount(0.5);
    for (let i = 0; i < 30; i++) {
      store.varyPose();
      seen.push(JSON.stringify(draft().rotations));
      for (let joint = 1; joint < JOINT_COUNT; joint++)
        expect(withinLimits(joint, axisAngleToQuaternion(at(joint)))).toBe(true);
      furthest = Math.max(furthest, Math.hypot(...at(CHEST)));
    }
    expect(new Set(seen).size).toBe(30);
    // Thirty steps of a random walk would have gone further than one variation can.
    expect(furthest).toBeLessThan(0.5 * 2 * Math.hypot(0.07, 0.1, 0.07) + 1e-6);
    for (let i = 0; i < 30; i++) store.undo();
    expect(draft().rotations).toEqual(REST);
  });
});

describe('pins', () => {
  it('are put on the chosen joint and taken off, and go with the pose', async () => {
    const { store } = await editor();
    store.togglePin();
    expect(store.state.poseWord.value).toBe('Choose a joint to pin first.');
    store.selectJoint(jointIndex('left_hand'));
    store.togglePin();
    expect([...store.state.poseTools.value.pins]).toEqual([jointIndex('left_hand')]);
    store.togglePin();
    expect(store.state.poseTools.value.pins.size).toBe(0);
    store.togglePin();
    store.editPose(REST);
    expect(store.state.poseTools.value.pins.size).toBe(0);
  });
});
