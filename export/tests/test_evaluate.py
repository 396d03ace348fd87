"""The evaluation itself: tasks, windows chained, sums, bars, songs played over and over, the page's dances."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
import torch

import metrics
from baselines import slerp_rotations, with_path
from conftest import make_clip
from evaluate import choose_clips
from evaluation import bars
from evaluation.dances import back_to_world, cut, free_rollout, make_task, real_seeded, rollout
from evaluation.endurance import looped_song
from evaluation.shipped import make_dances, order_of
from evaluation.table import core_table
from evaluation.tally import Tally
from spec import BEAT, ROTATION_SIZE, SEED_FRAMES
from windows import to_local_frame

TINY = Path(__file__).resolve().parents[2] / "tests" / "golden" / "tiny.onnx"


def slerp_network(inputs: dict[str, torch.Tensor]) -> torch.Tensor:
    """Stands for the network: SLERP between the keys it is shown, on the spot; without keys the last seed pose."""
    frames = inputs["key_mask"].shape[1]
    path = inputs["seed"][0, -1:, ROTATION_SIZE:].expand(frames, -1)
    keys = torch.nonzero(inputs["key_mask"][0])[:, 0]
    if len(keys) == 0:
        return inputs["seed"][:, -1:].expand(-1, frames, -1)
    return with_path(slerp_rotations(metrics.matrices_of(inputs["key_poses"][0, keys]), keys, frames), path)[None]


def test_pieces_lie_side_by_side_from_key_to_key():
    # 700 frames: 60 seed, then 639 // 60 * 60 + 1 = 601 with a key every 60. Windows hold 239 // 60 * 60 + 1 = 181 frames.
    task = make_task(make_clip(700), 60)
    assert task is not None and task.frames == 601
    assert task.pieces == [(0, 181), (180, 181), (360, 181), (540, 61)]
    assert int(task.between.sum()) == 601 - 11 and task.keys.tolist() == list(range(0, 601, 60))
    assert make_task(make_clip(90), 30) is None


def test_windows_come_back_to_where_they_were():
    motion = make_clip(100, seed=2).motion
    local = to_local_frame(motion, 40)
    assert torch.allclose(back_to_world(local, motion[39]), motion, atol=1e-5)


def test_chained_and_real_seeded_windows_agree_with_the_baseline_that_the_network_copies():
    task = make_task(make_clip(500, seed=4), 30)
    expected = slerp_rotations(metrics.matrices_of(task.real[task.keys]), task.keys, task.frames)
    dance = rollout(task, slerp_network)
    assert dance.shape == task.real.shape
    assert torch.allclose(metrics.matrices_of(dance), expected, atol=1e-4)
    for made, (start, frames) in zip(real_seeded(task, slerp_network), task.pieces):
        assert torch.allclose(metrics.matrices_of(made), expected[start : start + frames], atol=1e-4)
    # On the spot: the path stays where the seed ended.
    assert torch.allclose(dance[:, ROTATION_SIZE:], task.seed[-1:, ROTATION_SIZE:].expand(task.frames, -1), atol=1e-4)


def test_free_rollout_holds_the_pose_of_a_network_that_holds_it():
    clip = make_clip(100)
    dance = free_rollout(torch.zeros(500, 15), clip.motion[:SEED_FRAMES], slerp_network, 30)
    assert dance.shape == (500, 147)
    assert torch.allclose(dance, clip.motion[SEED_FRAMES - 1].expand(500, -1), atol=1e-4)
    assert metrics.longest_freeze(metrics.mean_joint_speed(metrics.joints(dance))) == pytest.approx(499 / 30)


def test_table_rows():
    clips = [make_clip(400, seed=1), make_clip(330, seed=2)]
    result = core_table(clips, slerp_network, (1.0,))["1"]
    assert set(result) == {"aist", "all"} and set(result["all"]) == {"real", "slerp", "cubic", "model", "rollout"}
    rows = result["all"]
    assert rows["real"]["position_cm"] == 0 and rows["real"]["speed_ratio"] == 1 and rows["real"]["NPSS"] == 0
    for same in ("position_cm", "rotation_deg", "speed_ratio", "jerk_ratio", "hit3", "NPSS", "PFD"):
        assert rows["rollout"][same] == pytest.approx(rows["slerp"][same], rel=1e-2, abs=1e-3)
    # Key poses every 30 frames: the farthest frame is 15 from one, and errors grow on the way there.
    curve = rows["slerp"]["by_distance"]
    assert curve["frames"] == list(range(1, 16)) and curve["position_cm"][0] < curve["position_cm"][14]


def test_tally_weighs_by_frames_and_sorts_by_distance():
    tally = Tally()
    tally.add("speed", 1.0, 10)
    tally.add("speed", 4.0, 20)
    tally.add("speed", math.nan, 99)
    assert tally.mean("speed") == pytest.approx(3)  # (10 + 80) / 30
    tally.add_errors(torch.tensor([1.0, 3.0, 8.0]), torch.tensor([10.0, 30.0, 50.0]), torch.tensor([1, 1, 4]))
    tally.add_errors(torch.tensor([2.0]), torch.tensor([20.0]), torch.tensor([1]))
    assert tally.by_distance() == {"frames": [1, 4], "position_cm": [2.0, 8.0], "rotation_deg": [20.0, 50.0]}


def test_clips_are_spread():
    clips = [make_clip(70, seed=i) for i in range(6)]
    assert [clip.name for clip in choose_clips(clips, "train", 3)] == ["made_0", "made_2", "made_4"]
    assert len(choose_clips(clips, "train", 0)) == 6 and choose_clips(clips, "val", 2) == []


def test_bars():
    row = {"E_c": 0.05, "position_cm": 8.0, "speed_ratio": 0.9, "jerk_ratio": 1.4, "hit3": 0.45, "skate_ratio": 0.8}
    rows = {"real": {"hit3": 0.5}, "slerp": {"position_cm": 10.0}, bars.SHIPPED: row, bars.LOOSE: row, bars.NETWORK: row | {"E_c": 0.01}}
    found = {bar["figure"]: bar for bar in bars.bars({"1": {"all": rows}}, None)}
    assert found["E_c at strength 0"]["shipped_met"] is False and found["E_c at strength 0"]["network_met"] is True
    assert found["E_c at strength 1"]["shipped_met"] is False and found["E_c at strength 1"]["network_met"] is None
    # 8 cm instead of 10 is 20 % less; 0.45 of 0.5 is 0.9.
    assert found["position error below SLERP"]["shipped"] == pytest.approx(20)
    assert found["beat hit rate, delta 3 / real"]["shipped"] == pytest.approx(0.9)
    assert [found[name]["shipped_met"] for name in ("mean joint speed / real", "jerk / real", "foot skate / real, after clean-up")] == [
        True,
        False,
        True,
    ]
    long = {"minutes": 3, "real_95": 1.3, "network, no fillers": {}, "shipped, fillers on": {}}
    figures = {"distance_ratio": 1.1, "distance_last_minute": 1.4, "freeze_s": 0.5}
    long["network, no fillers"] = {"a": figures, "b": figures | {"freeze_s": 2.0}}
    found = {bar["figure"]: bar for bar in bars.bars({}, long)}
    assert found["longest freeze"]["network"] == 2.0 and found["longest freeze"]["network_met"] is False
    assert found["longest freeze"]["shipped"] is None and "-" in bars.markdown(list(found.values()))


def test_a_song_is_played_again_from_its_first_downbeat():
    clip = make_clip(400)  # beats every 15 frames, downbeats every 60: 0 to 360
    song = looped_song(clip, 800)
    assert song is not None and song.music.shape == (800, 15)
    assert torch.equal(song.beats, torch.arange(0, 800, 15).float())
    assert torch.equal(song.music[360 + 7, :12], song.music[7, :12])
    assert song.music[:, BEAT].nonzero()[:, 0].tolist() == list(range(0, 800, 15))
    assert song.grid()["tempo"] == pytest.approx(120) and song.grid()["beatsPerBar"] == 4
    assert looped_song(make_clip(200), 800) is None  # 180 frames between downbeats: less than 8 s


def test_the_page_dances_through_the_keys():
    clip = make_clip(200, seed=6)
    task = make_task(clip, 30)
    made = make_dances(TINY, [order_of(task, {"loose": {"keyStrength": 0.0}, "exact": {}})])[0]
    wanted = task.real[task.keys, :ROTATION_SIZE]
    assert made["exact"].shape == task.real.shape
    assert metrics.consistency_error(made["exact"], task.keys, wanted) < 1e-6
    assert metrics.consistency_error(made["loose"], task.keys, wanted) > 1e-3
    # It goes on from the real opening, not from the page's starting clip: the path starts where the seed ended.
    assert float((made["exact"][0, ROTATION_SIZE:] - task.seed[-1, ROTATION_SIZE:]).norm()) < 0.15
    assert [piece.shape[0] for piece in cut(made["exact"], task)] == [frames for _, frames in task.pieces]
