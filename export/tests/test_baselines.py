"""Baselines between key poses, against values worked out by hand."""

from __future__ import annotations

import math

import torch

from baselines import NearestNeighbour, cubic_rotations, slerp_rotations, with_path
from conftest import make_clip
from metrics import joints, matrices_of
from rotation import matrix_to_axis_angle
from skeleton import mirror_motion
from test_metrics import ELBOW, with_elbow
from windows import to_local_frame


def angles_of(rotations: torch.Tensor) -> torch.Tensor:
    return matrix_to_axis_angle(rotations)[:, ELBOW, 2]


def keys_at(frames: list[int], angles: list[float]) -> tuple[torch.Tensor, torch.Tensor]:
    return matrices_of(with_elbow(torch.tensor(angles))), torch.tensor(frames)


def test_slerp_turns_evenly():
    poses, keys = keys_at([0, 4, 6], [0.0, 0.8, 0.0])
    # 0.8 over 4 frames, then back over 2.
    expected = torch.tensor([0, 0.2, 0.4, 0.6, 0.8, 0.4, 0], dtype=torch.float64)
    assert torch.allclose(angles_of(slerp_rotations(poses, keys, 7)), expected, atol=1e-6)


def test_cubic_about_one_axis_is_catmull_rom():
    poses, keys = keys_at([0, 4, 8, 12], [0.0, 0.8, 0.8, 0.0])
    made = angles_of(cubic_rotations(poses, keys, 13))
    assert torch.allclose(made[::4], torch.tensor([0, 0.8, 0.8, 0], dtype=torch.float64), atol=1e-6)
    # Between 4 and 8, at the middle: (a + b) / 2 + (gap / 8)(v_a - v_b), slopes v = +-0.8 / 8 a frame: 0.8 + 4 / 8 * 0.2.
    assert math.isclose(float(made[6]), 0.9, abs_tol=1e-6)
    # Between 0 and 4: end slope 0.8 / 4, inner slope 0.1: 0.4 + 4 / 8 * (0.2 - 0.1).
    assert math.isclose(float(made[2]), 0.45, abs_tol=1e-6)


def test_nearest_neighbour_finds_a_turned_and_mirrored_stretch():
    clip = make_clip(120, seed=3)
    other = make_clip(150, seed=8)
    search = NearestNeighbour([other, clip])
    # The same stretch seen in a mirror and from elsewhere: the answer must be frame 20 of clip 1, mirrored.
    dance = to_local_frame(mirror_motion(clip.motion[20:51]), 1)
    keys = torch.tensor([0, 15, 30])
    assert search.find(dance, keys) == [(1, 20, True), (1, 35, True)]
    made = with_path(search.rotations(dance, keys), dance[:, -3:])
    assert float((joints(made) - joints(dance)).norm(dim=-1).max()) < 1e-4


def test_nearest_neighbour_passes_the_keys_and_shuns_repaired_joints():
    clip = make_clip(120, seed=3)
    search = NearestNeighbour([make_clip(150, seed=8), clip])
    dance = make_clip(40, seed=5).motion[:31]
    keys = torch.tensor([0, 10, 30])
    made = search.rotations(dance, keys)
    assert torch.allclose(made[keys], matrices_of(dance[keys]), atol=1e-4)
    clip.valid[25, 4] = False
    same = clip.motion[20:51]
    chosen = NearestNeighbour([clip]).find(same, torch.tensor([0, 15, 30]))
    assert chosen[0] != (0, 20, False) and chosen[1] == (0, 35, False)
