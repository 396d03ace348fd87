"""Measures of one motion, against values worked out by hand."""

from __future__ import annotations

import math

import pytest
import torch
from torch import Tensor

import metrics
from rotation import axis_angle_to_matrix, matrix_to_six_d
from spec import JOINT_COUNT, JOINTS, MOTION_SIZE, ROTATION_SIZE, TOE_HEIGHT

ELBOW = JOINTS.index("left_elbow")
FOREARM = math.hypot(0.26, 0.01)  # metres from elbow to wrist, spec.json


def standing(frames: int, height: float = 0.955) -> Tensor:
    """The rest pose [frames, 147]; at 0.955 m our figure's toes rest on the floor."""
    motion = torch.zeros(frames, MOTION_SIZE, dtype=torch.float64)
    motion[:, 0:ROTATION_SIZE:6] = 1
    motion[:, 4:ROTATION_SIZE:6] = 1
    motion[:, ROTATION_SIZE + 1] = height
    return motion


def with_elbow(angles: Tensor) -> Tensor:
    """The rest pose with the left elbow turned about z by angles [frames], radians."""
    motion = standing(len(angles))
    turn = axis_angle_to_matrix(torch.stack([0 * angles, 0 * angles, angles.double()], -1))
    motion[:, ELBOW * 6 : ELBOW * 6 + 6] = matrix_to_six_d(turn)
    return motion


def test_consistency_error_is_the_squared_distance_of_the_numbers():
    motion = standing(10)
    # A quarter turn about z takes columns (1,0,0), (0,1,0) to (0,1,0), (-1,0,0): 4 numbers off by 1.
    wanted = with_elbow(torch.tensor([math.pi / 2]))[:, :ROTATION_SIZE]
    assert metrics.consistency_error(motion, torch.tensor([3]), wanted) == pytest.approx(4)
    # Mean over two keys of which one is hit: (4 + 0) / 2.
    both = torch.cat([wanted, motion[:1, :ROTATION_SIZE]])
    assert metrics.consistency_error(motion, torch.tensor([3, 7]), both) == pytest.approx(2)


def test_smoothness_of_a_steady_slide():
    motion = standing(60)
    motion[:, ROTATION_SIZE] = torch.arange(60) * 0.01
    # One of 147 differences is 0.01, the others 0: mean m = 0.01 / 147, sd^2 = 0.01^2 / 147 - m^2, so sd / m = sqrt(146).
    assert metrics.smoothness(motion) == pytest.approx(math.sqrt(146), rel=1e-6)


def test_mean_joint_speed_counts_every_joint():
    positions = torch.zeros(3, JOINT_COUNT, 3)
    positions[1, 5, 0], positions[2, 5, 0] = 0.1, 0.4
    # One of 24 joints moves 0.1 and 0.3 m in 1/30 s: 3 / 24 and 9 / 24 m/s.
    assert metrics.mean_joint_speed(positions).tolist() == pytest.approx([3 / 24, 9 / 24], rel=1e-5)


def test_jerk_of_a_cubic():
    t = torch.arange(8, dtype=torch.float64) / 30
    positions = torch.zeros(8, JOINT_COUNT, 3, dtype=torch.float64)
    positions[:, 7, 1] = 4 * t**3
    # The third derivative of 4 t^3 is 24 m/s^3, and third differences of a cubic are exact; one joint of 24 has it.
    assert metrics.jerk_of(positions) == pytest.approx(1.0, rel=1e-9)


def test_motion_beats_are_minima_or_extrema_of_the_speed():
    speed = torch.tensor([3.0, 1.0, 2.0, 4.0, 4.0, 1.0, 1.0, 2.0])
    # Minima: value 1 (between frames 1 and 2, so 1.5), and the first of the two equal values 5: 5.5. Maximum: value 3 is above its left
    # and equal to its right: 3.5; value 4 is not above its left.
    assert metrics.kinetic_beats(speed).tolist() == [1.5, 5.5]
    assert metrics.kinetic_beats(speed, extrema=True).tolist() == [1.5, 3.5, 5.5]


def test_motion_beats_of_a_swinging_arm():
    motion = with_elbow(torch.cos(2 * math.pi * (torch.arange(91) - 0.25) / 30))
    # It turns round at 15.25, 30.25 ...: the slowest step is the one from 15 to 16, whose middle is 15.5.
    assert metrics.motion_beats(motion).tolist() == [15.5, 30.5, 45.5, 60.5, 75.5]


def test_beat_hit_rate():
    found = torch.tensor([10.0, 20.0])
    beats = torch.tensor([9.0, 12.0, 16.0, 30.0])
    # Distances 1, 2, 4, 10 frames.
    assert [metrics.hit_rate(found, beats, delta) for delta in (1, 2, 3, 4, 5)] == [0.25, 0.5, 0.5, 0.75, 0.75]
    assert math.isnan(metrics.hit_rate(found, beats[:0], 1))
    assert metrics.hit_rate(found[:0], beats, 5) == 0
    # Beats outside the motion do not count: of 30 (a turning point) and 99 only 30.
    swing = with_elbow(torch.cos(2 * math.pi * torch.arange(91) / 30))
    assert metrics.beat_hit_rate(swing, torch.tensor([30.0, 99.0, -3.0]), 1) == 1


def test_longest_freeze():
    speed = torch.full((60,), 0.3)
    speed[5:11] = 0.049  # 6 values
    speed[20:50] = 0.01  # 30 values: 1 s
    assert metrics.longest_freeze(speed) == pytest.approx(1.0)
    assert metrics.longest_freeze(speed, 0.005) == 0
    assert metrics.longest_freeze(speed, 9) == pytest.approx(2.0)


def test_foot_skate_is_the_speed_of_low_toes():
    motion = standing(31)
    motion[:, ROTATION_SIZE] = torch.arange(31) * 0.01
    # 0.01 m a frame is 0.3 m/s, on both feet.
    assert metrics.foot_skate(motion) == pytest.approx(0.3, rel=1e-4)
    motion[:, ROTATION_SIZE + 1] += 0.1
    assert math.isnan(metrics.foot_skate(motion))
    toes = metrics.joints(standing(1), with_root=True)[0, [10, 11], 1]
    assert toes.tolist() == pytest.approx([TOE_HEIGHT, TOE_HEIGHT], abs=1e-6)


def test_position_and_rotation_error():
    motion, other = standing(2), with_elbow(torch.tensor([0.0, math.pi / 2]))
    # A quarter turn moves wrist and hand by sqrt(2) times their distance to the z axis through the elbow, 2 joints of 24.
    flat = math.hypot(0.35, 0)
    expected = math.sqrt(2) * (FOREARM + flat) / 24
    assert metrics.position_error(motion, other).tolist() == pytest.approx([0, expected], rel=1e-6)
    # One joint of 24 by 90 degrees.
    assert metrics.rotation_error(motion, other).tolist() == pytest.approx([0, 90 / 24], abs=1e-4)
    # The root does not count.
    other[:, ROTATION_SIZE:] += 1
    assert metrics.position_error(motion, other).tolist() == pytest.approx([0, expected], rel=1e-6)


def test_distance_to_key():
    assert metrics.distance_to_key(8, torch.tensor([1, 6])).tolist() == [1, 0, 1, 2, 2, 1, 0, 1]
