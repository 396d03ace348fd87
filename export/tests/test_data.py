"""Loading, windows, keys and augmentation on made-up clips."""

import json
import pickle

import numpy as np
import pytest
import torch

from conftest import make_clip
from data import load_clips, normalise_onset
from metrics import joints, matrices_of
from rotation import angle_between, heading
from skeleton import mirror_motion
from spec import BEAT, DOWNBEAT, FEATURE_COUNT, JOINT_COUNT, MOTION_SIZE, ONSET, ROTATION_SIZE, TOE_HEIGHT, TOES
from windows import NO_AUGMENTATION, Augmentation, WindowSampler, choose_keys, cut_window, key_distances, to_local_frame


def rng(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def test_prepared_folder(prepared_folder, tmp_path):
    clips = {clip.name: clip for clip in load_clips(prepared_folder, cache=tmp_path / "cache")}
    assert {c.source for c in clips.values()} == {"aist", "cmu", "tang"}
    assert clips["t"].split == "val" and clips["a"].split == "train"
    for clip in clips.values():
        assert clip.motion.shape == (120, MOTION_SIZE) and clip.music.shape == (120, FEATURE_COUNT)
        real = clip.root_valid
        toes = joints(clip.motion, with_root=True)[real][:, TOES, 1]
        assert float(torch.quantile(toes.flatten(), 0.05)) == pytest.approx(TOE_HEIGHT, abs=1e-4)
    assert not clips["p"].valid[5, 18] and clips["p"].valid[30, 18] and not clips["p"].root_valid[5]
    assert clips["c"].music.abs().sum() == 0
    # The cached copy is the same.
    again = {clip.name: clip for clip in load_clips(prepared_folder, cache=tmp_path / "cache")}
    assert torch.equal(again["a"].motion, clips["a"].motion) and torch.equal(again["a"].beats, clips["a"].beats)


def test_aist_music_loses_its_lag(prepared_folder):
    clip = next(c for c in load_clips(prepared_folder) if c.name == "a")
    # 120 bpm at 30 fps: a beat every 15 frames from 0; the grid in the file is 1.5 frames late.
    assert clip.beats[:3].tolist() == [0, 15, 30]
    assert clip.downbeats.tolist() == [0]
    assert clip.music[:, ONSET].nonzero()[:, 0].tolist() == [9, 10]  # the stored peak at 11 moves one to two frames earlier
    assert torch.allclose(clip.music[:, :12].norm(dim=-1), torch.ones(120), atol=1e-5)


def test_song_features_are_placed_by_audio_start(prepared_folder, tmp_path):
    table = np.zeros((60, FEATURE_COUNT), np.float32)
    table[30, 0] = 1  # frame 30 of the song is frame 0 of the dance
    folder = tmp_path / "features"
    folder.mkdir()
    table.tofile(folder / "t.f32")
    header = {"frames": 60, "fps": 30, "beats": [1.0, 1.5], "downbeats": [1.5]}
    (folder / "t.json").write_text(json.dumps(header))
    clip = next(c for c in load_clips(prepared_folder, folder) if c.name == "t")
    assert clip.music[:, 0].nonzero()[:, 0].tolist() == [0]
    assert clip.beats.tolist() == [0, 15] and clip.downbeats.tolist() == [15]
    (folder / "t.json").write_text(json.dumps(header | {"frames": 61}))
    with pytest.raises(ValueError, match="61 frames"):
        load_clips(prepared_folder, folder)


def test_folder_of_neither_kind(tmp_path):
    with pytest.raises(FileNotFoundError, match="neither"):
        load_clips(tmp_path)


def test_full_aistpp(tmp_path):
    motions = tmp_path / "motions"
    motions.mkdir()
    frames = 240
    raw = {"smpl_poses": np.zeros((frames, 72)), "smpl_trans": np.full((frames, 3), 90.0), "smpl_scaling": np.array([100.0])}
    raw["smpl_trans"][:, 0] += np.arange(frames)
    for name in ("gHO_sBM_cAll_d19_mHO0_ch01", "gHO_sBM_cAll_d19_mHO3_ch01", "gHO_sBM_cAll_d19_mHO1_ch01"):
        (motions / f"{name}.pkl").write_bytes(pickle.dumps(raw))
    (tmp_path / "ignore_list.txt").write_text("gHO_sBM_cAll_d19_mHO1_ch01\n")
    clips = load_clips(tmp_path)
    assert [clip.split for clip in clips] == ["train", "val"]
    assert clips[0].frames == frames // 2  # 60 -> 30 frames a second
    assert clips[0].motion[:2, ROTATION_SIZE].tolist() == pytest.approx([0, 0.02])  # centimetres -> metres
    assert set(clips[0].motion[0, :6].tolist()) == {0.0, 1.0}


def test_aistpp_pickle_may_not_run_code(tmp_path):
    motions = tmp_path / "motions"
    motions.mkdir()
    (motions / "gHO_sBM_cAll_d19_mHO0_ch01.pkl").write_bytes(pickle.dumps(print))
    with pytest.raises(pickle.UnpicklingError, match="builtins.print"):
        load_clips(tmp_path)


def test_onset_normalisation():
    assert normalise_onset(np.array([0.0, 1, 2, 100])).max() == 1
    assert normalise_onset(np.zeros(4)).tolist() == [0, 0, 0, 0]


def test_local_frame_puts_the_last_seed_frame_at_the_origin_facing_z(clip):
    local = to_local_frame(clip.motion, 60)
    assert local[59, [ROTATION_SIZE, ROTATION_SIZE + 2]].abs().max() < 1e-5
    assert abs(float(heading(matrices_of(local[59])[0]))) < 1e-5
    assert torch.allclose(local[:, ROTATION_SIZE + 1], clip.motion[:, ROTATION_SIZE + 1])
    # The body itself is untouched: joint distances from the pelvis stay.
    assert torch.allclose(joints(local).norm(dim=-1), joints(clip.motion).norm(dim=-1), atol=1e-5)


def test_key_distances():
    mask = torch.zeros(6)
    mask[[1, 4]] = 1
    to_previous, to_next = key_distances(mask)
    assert to_previous.tolist() == [-1, 0, 1, 2, 0, 1]
    assert to_next.tolist() == [1, 0, 2, 1, 0, -1]
    none = key_distances(torch.zeros(3))
    assert none[0].tolist() == [-1] * 3 and none[1].tolist() == [-1] * 3


def test_plain_window_is_the_clip(clip):
    window = cut_window(clip, 10, 90, rng(), keys=torch.tensor([0, 30]))
    local = to_local_frame(clip.motion[10:160], 60)
    assert torch.allclose(window.seed, local[:60]) and torch.allclose(window.target, local[60:])
    assert torch.equal(window.key_poses[30], window.target[30, :ROTATION_SIZE])
    assert window.key_poses[31].abs().sum() == 0 and window.key_mask.sum() == 2
    # Beats at clip frames 75, 90 ... stand at 5, 20 ... of the window.
    assert window.music[:, BEAT].nonzero()[:, 0].tolist() == [5, 20, 35, 50, 65, 80]
    assert window.music[:, DOWNBEAT].nonzero()[:, 0].tolist() == [50]


def test_no_keys_and_no_loss_where_the_data_is_not_real(clip):
    clip.valid[75, 3] = False
    window = cut_window(clip, 0, 160, rng(), keys=torch.tensor([10, 15]))
    assert window.key_mask.nonzero()[:, 0].tolist() == [10]
    assert window.valid[15, 3] == 0 and window.valid[15, 4] == 1
    assert window.valid[139].min() == 1 and window.valid[140:].max() == 0  # the clip ends at frame 200
    assert window.root_valid[140:].max() == 0


def test_tempo_augmentation_keeps_beats_on_the_motion(clip):
    faster = Augmentation(mirror=0, tempo=(1.2, 1.2), music_dropout=0, seed_noise=0)
    window = cut_window(clip, 0, 60, rng(), faster, keys=torch.zeros(0, dtype=torch.long))
    assert window.music[:, BEAT].nonzero()[:, 0].tolist() == [round(15 * k / 1.2 - 60) for k in range(5, 10)]
    # Output frame 60 shows the clip's frame 72; seen from the pelvis, bodies do not depend on the window's heading.
    mine, source = joints(window.target[0]), joints(clip.motion[72])
    assert torch.allclose(mine.norm(dim=-1), source.norm(dim=-1), atol=1e-4)


def test_mirror_augmentation(clip):
    window = cut_window(clip, 0, 60, rng(), Augmentation(1, (1, 1), 0, 0), keys=torch.tensor([5]))
    expected = to_local_frame(mirror_motion(clip.motion[:120]), 60)
    assert torch.allclose(window.target, expected[60:], atol=1e-5)


def test_seed_noise_leaves_target_and_stays_a_rotation(clip):
    clean = cut_window(clip, 0, 60, rng(), NO_AUGMENTATION, keys=torch.tensor([5]))
    noisy = cut_window(clip, 0, 60, rng(), Augmentation(0, (1, 1), 0, 1.0, seed_noise_size=0.1), keys=torch.tensor([5]))
    assert torch.equal(clean.target, noisy.target) and not torch.equal(clean.seed, noisy.seed)
    columns = noisy.seed[:, :ROTATION_SIZE].view(60, JOINT_COUNT, 2, 3)
    assert torch.allclose(columns.norm(dim=-1), torch.ones(60, JOINT_COUNT, 2), atol=1e-5)
    angles = angle_between(matrices_of(clean.seed), matrices_of(noisy.seed))
    assert 0.001 < float(angles.mean()) < 0.3


def test_chosen_keys_cover_all_patterns_and_stay_inside():
    counts = [len(choose_keys(240, torch.arange(0, 240, 15).float(), Augmentation(), rng(seed))) for seed in range(300)]
    assert min(counts) == 0 and max(counts) >= 14
    for seed in range(50):
        keys = choose_keys(240, torch.zeros(0), Augmentation(), rng(seed))
        assert len(keys) == 0 or (keys.min() >= 0 and keys.max() < 240 and torch.equal(keys, keys.unique()))


def test_sampler_state_is_its_generator():
    clips = [make_clip(200, 0), make_clip(90, 1), make_clip(40, 2)]
    a, b = WindowSampler(clips, tokens=600, lengths=(60, 90)), WindowSampler(clips, tokens=600, lengths=(60, 90))
    assert len(a.clips) == 2  # 40 frames cannot hold a seed
    a.batch()
    b.rng.set_state(a.rng.get_state())
    first, second = a.batch(), b.batch()
    assert all(torch.equal(first[name], second[name]) for name in first)
    assert first["music"].shape[0] == round(600 / (first["music"].shape[1] + 60))
