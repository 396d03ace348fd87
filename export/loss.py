"""The weighted reconstruction loss (eq. 14-15) and the position and velocity losses added to it."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from rotation import six_d_to_matrix
from skeleton import forward_kinematics
from spec import FPS, JOINT_COUNT, ROTATION_SIZE, TOE_HEIGHT, TOES


@dataclass
class LossConfig:
    """Weights of the terms. `lam` and `sigma` are lambda and sigma of eq. 15; sigma is in seconds."""

    lam: float = 3.0
    sigma: float = 0.1
    literal_sum: bool = False  # eq. 15 as printed: adds "1" once per key pose
    root: float = 0.2  # of the three root numbers within eq. 14
    reconstruction: float = 0.5  # eq. 14 itself
    position: float = 10.0  # joint positions, root-aligned, metres
    velocity: float = 0.6  # joint velocities in the world, m/s
    speed: float = 4.0  # how fast each joint moves, whatever the direction, (m/s) squared
    foot: float = 0.6  # sliding of planted toes, m/s


def key_weight(key_mask: Tensor, lam: float, sigma: float, literal_sum: bool = False) -> Tensor:
    """omega(t) of eq. 15 [B, T] from the key mask [B, T].

    Read as 1 + lambda * max over key poses of exp(-(t - t_i)^2 / 2 sigma^2), sigma in seconds. `literal_sum` gives the
    printed sum over i of (1 + lambda * Gaussian), which is 0 for a window without key poses.
    """
    frames = key_mask.shape[-1]
    t = torch.arange(frames, device=key_mask.device) / FPS
    gaussian = torch.exp(-((t[:, None] - t[None, :]) ** 2) / (2 * sigma**2))  # [T, T]
    per_key = gaussian * key_mask[..., None, :]  # [B, T, T]: from frame t (row) to key t_i (column)
    if literal_sum:
        return key_mask.sum(-1, keepdim=True) + lam * per_key.sum(-1)
    return 1 + lam * per_key.max(-1).values


def reconstruction_loss(
    predicted: Tensor, target: Tensor, key_mask: Tensor, valid: Tensor, root_valid: Tensor, config: LossConfig
) -> Tensor:
    """Eq. 14: mean over frames of omega(t) * ||y - y^||^2 over the motion numbers, masked joints left out.

    predicted, target [B, T, 147]; key_mask, root_valid [B, T]; valid [B, T, 24].
    """
    square = (predicted - target) ** 2
    rotations = square[..., :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)).sum(-1)
    per_frame = (rotations * valid).sum(-1) + config.root * square[..., ROTATION_SIZE:].sum(-1) * root_valid
    weight = key_weight(key_mask, config.lam, config.sigma, config.literal_sum)
    return (weight * per_frame).mean()


def _masked_mean(values: Tensor, mask: Tensor) -> Tensor:
    return (values * mask).sum() / mask.sum().clamp(min=1)


def _norm(vector: Tensor) -> Tensor:
    return (vector * vector).sum(-1).add(1e-8).sqrt()


# Speed is taken over this many frames: over one frame, trembling would pass for dancing.
SPEED_FRAMES = 5


def _pooled_speed(positions: Tensor) -> Tensor:
    """[B, T, J, 3] metres -> mean speed of each joint over half seconds [B, n, J], m/s."""
    speed = _norm(positions[:, SPEED_FRAMES:] - positions[:, :-SPEED_FRAMES]) * (FPS / SPEED_FRAMES)
    length = FPS // 2
    whole = speed.shape[1] // length * length
    return speed[:, :whole].unflatten(1, (-1, length)).mean(2)


def dance_loss(predicted: Tensor, batch: dict[str, Tensor], config: LossConfig) -> tuple[Tensor, dict[str, float]]:
    """All terms together -> (loss, each term's value)."""
    target, valid, root_valid = batch["target"], batch["valid"], batch["root_valid"]
    terms = {"reconstruction": reconstruction_loss(predicted, target, batch["key_mask"], valid, root_valid, config)}

    def positions(motion: Tensor) -> Tensor:
        matrices = six_d_to_matrix(motion[..., :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)))
        return forward_kinematics(matrices)

    ours, real = positions(predicted), positions(target)
    # A joint's place is only known if every joint above it is; whole frames are simpler and lose little.
    whole = valid.all(-1).float() if valid.dtype == torch.bool else valid.min(-1).values
    terms["position"] = _masked_mean(_norm(ours - real).mean(-1), whole)

    ours_world = ours + predicted[..., None, ROTATION_SIZE:]
    real_world = real + target[..., None, ROTATION_SIZE:]
    ours_velocity, real_velocity = ((p[:, 1:] - p[:, :-1]) * FPS for p in (ours_world, real_world))
    moving = whole[:, 1:] * whole[:, :-1] * root_valid[:, 1:] * root_valid[:, :-1]
    terms["velocity"] = _masked_mean(_norm(ours_velocity - real_velocity).mean(-1), moving)

    # Regression to the mean makes uncertain stretches stand still; this term asks for the right amount of motion there.
    # Each half second also looks SPEED_FRAMES ahead; all of it must be real.
    length, count = FPS // 2, (whole.shape[1] - SPEED_FRAMES) // (FPS // 2)
    reach = whole.unfold(1, length + SPEED_FRAMES, length)[:, :count]
    # The square asks for the mean speed where the real one is uncertain; the absolute difference would ask for the median, which is less.
    apart = (_pooled_speed(ours) - _pooled_speed(real)).square().mean(-1)
    terms["speed"] = _masked_mean(apart, reach.min(-1).values)

    toes_real = real_world[:, 1:, TOES]
    planted = (toes_real[..., 1] < TOE_HEIGHT + 0.03) & (_norm(real_velocity[:, :, TOES]) < 0.25)
    slide = _norm(ours_velocity[:, :, TOES][..., [0, 2]])
    terms["foot"] = _masked_mean(slide, planted * moving[..., None])

    weights = {"reconstruction": config.reconstruction, "position": config.position, "velocity": config.velocity}
    weights |= {"speed": config.speed, "foot": config.foot}
    loss = sum(weights[name] * value for name, value in terms.items())
    return loss, {name: float(value.detach()) for name, value in terms.items()}
