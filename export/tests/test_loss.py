"""Eq. 13-16 and the added losses against computations by hand."""

import math

import pytest
import torch

import metrics
from loss import LossConfig, dance_loss, key_weight, reconstruction_loss
from samples import synthetic_motion
from spec import FPS, JOINT_COUNT, MOTION_SIZE, ROTATION_SIZE


def test_eq_15_by_hand():
    mask = torch.zeros(1, 10)
    mask[0, [2, 7]] = 1
    sigma, lam = 0.1, 3.0
    weight = key_weight(mask, lam, sigma)[0]

    def gaussian(t: int, key: int) -> float:
        return math.exp(-(((t - key) / FPS) ** 2) / (2 * sigma**2))

    assert float(weight[2]) == pytest.approx(1 + lam)
    assert float(weight[4]) == pytest.approx(1 + lam * gaussian(4, 2), rel=1e-5)  # nearer to 2 than to 7
    assert float(weight[5]) == pytest.approx(1 + lam * gaussian(5, 7), rel=1e-5)
    printed = key_weight(mask, lam, sigma, literal_sum=True)[0]
    assert float(printed[4]) == pytest.approx(2 + lam * (gaussian(4, 2) + gaussian(4, 7)), rel=1e-5)
    assert key_weight(torch.zeros(1, 4), lam, sigma).tolist() == [[1, 1, 1, 1]]


def test_eq_14_by_hand():
    target = torch.zeros(1, 3, MOTION_SIZE)
    predicted = target.clone()
    predicted[0, 0, 0] = 2.0  # joint 0
    predicted[0, 1, 6] = 3.0  # joint 1
    predicted[0, 2, ROTATION_SIZE] = 1.0  # root x
    mask = torch.tensor([[1.0, 0, 0]])
    valid, root_valid = torch.ones(1, 3, JOINT_COUNT), torch.ones(1, 3)
    config = LossConfig(lam=3, sigma=0.1, root=0.5)
    second = 1 + 3 * math.exp(-((1 / FPS) ** 2) / 0.02)
    third = 1 + 3 * math.exp(-((2 / FPS) ** 2) / 0.02)
    expected = (4 * 4 + second * 9 + third * 0.5) / 3
    assert float(reconstruction_loss(predicted, target, mask, valid, root_valid, config)) == pytest.approx(expected, rel=1e-5)
    valid[0, 1, 1] = 0
    root_valid[0, 2] = 0
    assert float(reconstruction_loss(predicted, target, mask, valid, root_valid, config)) == pytest.approx(16 / 3, rel=1e-5)


def _batch(motion: torch.Tensor) -> dict:
    frames = motion.shape[0]
    ones = torch.ones(1, frames)
    return {"target": motion[None], "valid": torch.ones(1, frames, JOINT_COUNT), "root_valid": ones, "key_mask": ones * 0}


def test_perfect_prediction_costs_nothing_but_real_sliding():
    motion = synthetic_motion(60, torch.Generator().manual_seed(0))
    _, terms = dance_loss(motion[None], _batch(motion), LossConfig())
    assert all(terms[name] < 2e-3 for name in ("reconstruction", "position", "velocity", "speed"))


def test_velocity_term_sees_a_root_that_runs_away():
    motion = synthetic_motion(60, torch.Generator().manual_seed(0))
    away = motion.clone()
    away[:, ROTATION_SIZE] += torch.arange(60) / FPS  # 1 m/s to the left
    _, terms = dance_loss(away[None], _batch(motion), LossConfig())
    assert terms["velocity"] == pytest.approx(1.0, abs=1e-3) and terms["position"] < 2e-3


def test_speed_term_punishes_standing_still():
    motion = synthetic_motion(60, torch.Generator().manual_seed(0))
    still = motion[:1].expand(60, -1)
    _, terms = dance_loss(still[None].clone(), _batch(motion), LossConfig())
    positions = metrics.joints(motion)
    real = ((positions[5:] - positions[:-5]).norm(dim=-1) * FPS / 5)[:45]  # three half seconds, over 5 frames each
    assert terms["speed"] == pytest.approx(float(real.view(3, 15, -1).mean(1).square().mean()), rel=0.01)


def test_speed_term_does_not_take_trembling_for_dance():
    motion = synthetic_motion(60, torch.Generator().manual_seed(0))
    still = motion[:1].expand(60, -1).clone()
    trembling = still.clone()
    trembling[::5] = motion[1]  # a jump every 5 frames: fast from frame to frame, at rest over 5 frames
    _, at_rest = dance_loss(still[None], _batch(motion), LossConfig())
    _, jumping = dance_loss(trembling[None], _batch(motion), LossConfig())
    assert jumping["speed"] == pytest.approx(at_rest["speed"], rel=1e-3)


def test_invalid_frames_do_not_count():
    motion = synthetic_motion(60, torch.Generator().manual_seed(0))
    batch, wrong = _batch(motion), motion.clone()
    wrong[30:] = synthetic_motion(30, torch.Generator().manual_seed(9))
    batch["valid"][:, 29:] = 0
    batch["root_valid"][:, 29:] = 0
    _, terms = dance_loss(wrong[None], batch, LossConfig())
    assert all(terms[name] < 3e-3 for name in ("reconstruction", "position", "velocity", "speed"))


def test_consistency_error_by_hand():
    motion = torch.zeros(5, MOTION_SIZE)
    keys = torch.zeros(2, ROTATION_SIZE)
    keys[0, 3], keys[1, :2] = 2.0, 1.0
    assert metrics.consistency_error(motion, torch.tensor([1, 4]), keys) == pytest.approx((4 + 2) / 2)


def test_smoothness_by_hand():
    motion = torch.zeros(3, MOTION_SIZE)
    motion[1, 0], motion[2, 0] = 1.0, 3.0  # differences 1 and 2, all others 0
    count = 2 * MOTION_SIZE
    mean = 3 / count
    deviation = math.sqrt(5 / count - mean**2)
    assert metrics.smoothness(motion) == pytest.approx(deviation / mean, rel=1e-6)


def test_beats_of_a_swinging_figure():
    frames = torch.arange(90)
    from rotation import axis_angle_to_matrix, matrix_to_six_d

    axis_angle = torch.zeros(90, JOINT_COUNT, 3)
    axis_angle[:, 16, 2] = torch.cos(2 * math.pi * frames / 30)  # stands still every 15 frames: 0, 15, 30 ...
    motion = torch.cat([matrix_to_six_d(axis_angle_to_matrix(axis_angle)).flatten(-2), torch.zeros(90, 3)], -1)
    beats = metrics.motion_beats(motion)
    assert beats.tolist() == pytest.approx([15, 30, 45, 60, 75], abs=0.51)
    assert metrics.beat_hit_rate(motion, torch.tensor([15.0, 30.0, 38.0, 60.0]), 2) == 0.75
    assert math.isnan(metrics.beat_hit_rate(motion, torch.zeros(0), 2))


def test_foot_skate_counts_low_toes_only():
    motion = synthetic_motion(30, torch.Generator().manual_seed(0), size=0.0)
    motion[:, ROTATION_SIZE:] = torch.tensor([0.0, 0.955, 0.0])
    motion[:, ROTATION_SIZE] += torch.arange(30) / FPS * 0.5
    motion[:, :6] = torch.tensor([1.0, 0, 0, 0, 1, 0])
    assert metrics.foot_skate(motion) == pytest.approx(0.5, rel=1e-3)
    motion[:, ROTATION_SIZE + 1] += 0.2
    assert math.isnan(metrics.foot_skate(motion))
