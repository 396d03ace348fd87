"""Measures of paper B, diversity and the distribution of poses, against values worked out by hand."""

from __future__ import annotations

import math

import pytest
import torch

import dance_metrics as dm
from rotation import yaw_matrix
from samples import synthetic_motion
from spec import JOINT_COUNT, ROTATION_SIZE
from test_metrics import standing
from windows import to_local_frame


def test_frechet_distance_of_known_gaussians():
    # Populations with mean (0, 0), (3, 4); variances (1, 4), (4, 1) along the axes, no correlation.
    a = torch.tensor([[1.0, 2.0], [1.0, -2.0], [-1.0, 2.0], [-1.0, -2.0]])
    b = torch.tensor([[2.0, 1.0], [2.0, -1.0], [-2.0, 1.0], [-2.0, -1.0]]) + torch.tensor([3.0, 4.0])
    # 9 + 16 + (1 + 4) + (4 + 1) - 2 (sqrt(1 * 4) + sqrt(4 * 1)) = 25 + 10 - 8.
    assert dm.frechet_distance(a, b) == pytest.approx(27)
    assert dm.frechet_distance(a, a) == pytest.approx(0, abs=1e-9)
    # Turned by 45 degrees the covariances do not commute; the distance must not change under a common turn.
    turn = yaw_matrix(torch.tensor(math.pi / 4))[[0, 2]][:, [0, 2]]
    assert dm.frechet_distance(a @ turn, b @ turn) == pytest.approx(27, rel=1e-5)


def test_pose_and_velocity_vectors_do_not_see_where_the_body_faces():
    motion = synthetic_motion(20, torch.Generator().manual_seed(1))
    turned = to_local_frame(motion, 5)
    assert torch.allclose(dm.pose_vectors(motion), dm.pose_vectors(turned), atol=1e-5)
    assert torch.allclose(dm.velocity_vectors(motion), dm.velocity_vectors(turned), atol=1e-3)
    # A body at rest: the left hip is (0.07, -0.09, 0) from the pelvis (spec.json), and nothing moves.
    rest = standing(3)
    assert dm.pose_vectors(rest)[0, :3].tolist() == pytest.approx([0.07, -0.09, 0])
    assert float(dm.velocity_vectors(rest).abs().max()) == 0
    # A body that turns on the spot by 0.1 rad a frame about +Y: the left hip at (0.07, ., 0) moves to (0.07 cos, ., -0.07 sin).
    spin = standing(2)
    spin[1, :6] = torch.cat([yaw_matrix(torch.tensor(0.1))[:, 0], yaw_matrix(torch.tensor(0.1))[:, 1]])
    expected = [30 * 0.07 * (math.cos(0.1) - 1), 0, -30 * 0.07 * math.sin(0.1)]
    assert dm.velocity_vectors(spin)[0, :3].tolist() == pytest.approx(expected, abs=1e-6)


def test_npss_of_two_pure_tones():
    t = torch.arange(8, dtype=torch.float64)
    one, two = (torch.cos(2 * math.pi * k * t / 8)[:, None] for k in (1, 2))
    # Power halves in bins 1 and 7 against 2 and 6. Cumulated: 0 .5 .5 .5 .5 .5 .5 1 against 0 0 .5 .5 .5 .5 1 1: differ by .5 twice.
    assert dm.npss_of(one, two) == pytest.approx(1.0)
    assert dm.npss_of(one, one) == pytest.approx(0, abs=1e-12)
    # A second dimension of the same shape but half the real amplitude (a quarter of the power) that is right: (1 * 4 + 0 * 1) / 5.
    assert dm.npss_of(torch.cat([one, one / 2], 1), torch.cat([two, one], 1)) == pytest.approx(0.8)


def test_npss_takes_quaternions_with_continuous_signs():
    motion = standing(4)
    # A pelvis that turns on about +Y by 120 degrees a frame: 0, 120, 240, 360. Half angles 0, 60, 120, 180, so w = 1, .5, -.5, -1.
    for frame in range(4):
        turn = yaw_matrix(torch.tensor(frame * 2 * math.pi / 3, dtype=torch.float64))
        motion[frame, :6] = torch.cat([turn[:, 0], turn[:, 1]])
    assert dm.power_values(motion)[:, 3].tolist() == pytest.approx([1, 0.5, -0.5, -1], abs=1e-6)
    assert dm.npss(motion, motion) == pytest.approx(0, abs=1e-9)


def test_position_variance():
    a, b = torch.zeros(5, JOINT_COUNT, 3), torch.zeros(5, JOINT_COUNT, 3)
    b[:, 3] = torch.tensor([0.2, 0.0, 0.4])
    # Two dances: variance = (difference / 2)^2, 0.01 + 0.04 for one joint of 24.
    assert dm.position_variance([a, b]) == pytest.approx(0.05 / 24, rel=1e-5)
    assert dm.position_variance([a, a]) == 0


def test_beat_consistency():
    beats = torch.tensor([10.0, 20.0, 40.0])
    # Nearest motion beats 0, 1.5 and 20 frames away: 0, 0.05 and 0.667 s; sigma is 0.05 s: 1, exp(-1/2), exp(-88.9).
    found = torch.tensor([10.0, 18.5])
    expected = (1 + math.exp(-0.5) + math.exp(-((21.5 / 30) ** 2) / (2 * 0.05**2))) / 3
    assert dm.beat_consistency(found, beats) == pytest.approx(expected, rel=1e-6)
    assert dm.beat_consistency(found[:0], beats) == 0
    assert math.isnan(dm.beat_consistency(found, beats[:0]))


def test_pairwise_distance():
    a, b, c = (torch.zeros(2, JOINT_COUNT, 3) for _ in range(3))
    b[:, 0, 1], c[:, 0, 1] = 0.3, -0.3
    # Distances 0.3, 0.3, 0.6 m of one joint in 24.
    assert dm.pairwise_distance([a, b, c]) == pytest.approx(0.4 / 24, rel=1e-5)


def test_pose_distribution():
    motion = synthetic_motion(2000, torch.Generator().manual_seed(4))
    poses = dm.PoseDistribution([motion])
    distance = poses.distance(motion)
    # Whitened by its own covariance, the mean square over the numbers is 1 where a direction moves, 0 where it is held: below 1 together.
    assert 0.3 < float((distance**2).mean()) < 1
    assert poses.quantile(0.5) == pytest.approx(float(distance.median()), rel=1e-3)
    # A body half a metre up is unlike anything seen: its height varies by 0.02 m (0.03 cos), so 25 deviations / sqrt(70) at least.
    lifted = motion.clone()
    lifted[:, ROTATION_SIZE + 1] += 0.5
    assert float(poses.distance(lifted).min()) > 2.5
