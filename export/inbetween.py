"""The in-betweener: what usually happens between two key poses, told from four neighbouring poses and the times between them.

It is the learned base that the dance transformer starts from. One look at a gap costs a hundredth of a window of the
transformer, so the same training minutes show it a hundred times more gaps; on small data that decides. Its residual over
SLERP is a cubic (Catmull-Rom) curve through knots evenly spaced over the gap and zero at both ends: the keys stay exact.
All inputs and outputs are free of the place and the heading of the dancer.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import torch
from torch import Tensor, nn

from rotation import unit
from skeleton import forward_kinematics
from spec import JOINT_COUNT, ROTATION_SIZE

ANCHORS = 4  # the key before the last, the key before, the key after, the one after that
_POSE_SIZE = 6 + (ROTATION_SIZE - 6) + 3 * JOINT_COUNT  # pelvis in the heading of `before`, limbs' 6D, places of the joints
STANDING = 0.9  # metres, about the pelvis's mean height
GAP_SIZE = ANCHORS * _POSE_SIZE + 5


@dataclass
class InbetweenConfig:
    """Sizes."""

    width: int = 512
    hidden: int = 1024
    blocks: int = 3
    knots: int = 14

    def as_dict(self) -> dict:
        return asdict(self)


@dataclass
class Gap:
    """A stretch between two neighbouring poses; leading axes are free ([B, T] in the model, [B] in training)."""

    poses: tuple[Tensor, Tensor, Tensor, Tensor]  # local rotations [..., 24, 3, 3]: earlier, before, after, later
    joints: tuple[Tensor, Tensor, Tensor, Tensor]  # their joint positions [..., 72] in the pelvis's own frame, metres
    seconds: Tensor  # [..., 3]: earlier to before, before to after, after to later (0: there is no later one)
    inner: Tensor  # [...] 1 where `earlier` is a key, 0 where it is a frame of the seed


def body_joints(matrices: Tensor) -> Tensor:
    """Local rotations [..., 24, 3, 3] -> joint positions [..., 72] in the pelvis's frame, metres."""
    still = matrices[..., :1, :, :] * 0 + torch.eye(3, dtype=matrices.dtype, device=matrices.device)
    return forward_kinematics(torch.cat([still, matrices[..., 1:, :, :]], -3)).flatten(-2)


def level_heading(forward: Tensor) -> tuple[Tensor, Tensor]:
    """Forward axis of a pelvis [..., 3] -> (sine, cosine) [..., 1] of its direction on the floor."""
    flat = unit(torch.cat([forward[..., :1], forward[..., 2:]], -1))
    sine, cosine = flat.split(1, -1)
    return sine, cosine


def gap_features(gap: Gap) -> Tensor:
    """[..., GAP_SIZE], the same wherever the dancer stands and faces."""
    sine, cosine = level_heading(gap.poses[1][..., 0, :, 2])
    sine, cosine = sine[..., None], cosine[..., None]
    parts = []
    for matrices, places in zip(gap.poses, gap.joints):
        x, y, z = matrices[..., 0, :, :2].transpose(-1, -2).split(1, -1)  # two columns of the pelvis, each [..., 2, 1]
        turned = torch.cat([cosine * x - sine * z, y, sine * x + cosine * z], -1).flatten(-2)
        parts += [turned, matrices[..., 1:, :, :2].transpose(-1, -2).flatten(-3), places]
    later = (gap.seconds[..., 2:] > 0).to(gap.seconds)
    return torch.cat([*parts, gap.seconds, gap.inner[..., None], later], -1)


def cubic_weights(fraction: Tensor, knots: int) -> Tensor:
    """Weights [..., knots + 2] of evenly spaced knots (both ends included) at `fraction` [...] in 0..1: Catmull-Rom's kernel."""
    at = torch.arange(knots + 2, device=fraction.device, dtype=fraction.dtype)
    x = (fraction[..., None] * (knots + 1) - at).abs()
    near = (1.5 * x - 2.5) * x * x + 1
    far = ((-0.5 * x + 2.5) * x - 4) * x + 2
    return torch.where(x < 1, near, torch.where(x < 2, far, torch.zeros_like(x)))


class Inbetweener(nn.Module):
    """Gap -> curve of the residual over SLERP and of the pelvis's velocity and height."""

    def __init__(self, config: InbetweenConfig) -> None:
        super().__init__()
        self.config = config
        self.register_buffer("mean", torch.zeros(GAP_SIZE))
        self.register_buffer("scale", torch.ones(GAP_SIZE))
        self.enter = nn.Linear(GAP_SIZE, config.width)
        self.blocks = nn.ModuleList(
            nn.Sequential(
                nn.LayerNorm(config.width),
                nn.Linear(config.width, config.hidden),
                nn.ReLU(),
                nn.Linear(config.hidden, config.width),
            )
            for _ in range(config.blocks)
        )
        self.norm = nn.LayerNorm(config.width)
        self.turns = nn.Linear(config.width, config.knots * ROTATION_SIZE)
        self.path = nn.Linear(config.width, (config.knots + 2) * 3)
        # An untrained one leaves SLERP as it is and stands.
        for last in (*(block[3] for block in self.blocks), self.turns, self.path):
            nn.init.zeros_(last.weight)
            nn.init.zeros_(last.bias)
        with torch.no_grad():
            self.path.bias.view(-1, 3)[:, 1] = STANDING

    def curves(self, gap: Gap, noise: float = 0.0) -> tuple[Tensor, Tensor]:
        """Knots of the rotation residual [..., knots, 144] and of (side m/s, height m, forward m/s) [..., knots + 2, 3].

        `noise` is the standard deviation added to the standardised inputs (training only).
        """
        x = ((gap_features(gap) - self.mean) * self.scale).clamp(-5, 5)
        if noise > 0:
            x = x + noise * torch.randn_like(x)
        x = self.enter(x)
        for block in self.blocks:
            x = x + block(x)
        x = self.norm(x)
        turns, path = self.turns(x), self.path(x)
        return turns.unflatten(-1, (self.config.knots, ROTATION_SIZE)), path.unflatten(-1, (self.config.knots + 2, 3))

    def forward(self, gap: Gap, fraction: Tensor) -> tuple[Tensor, Tensor]:
        """At `fraction` [...] of each gap: residual [..., 144] and (side, height, forward) [..., 3]."""
        return sample_curves(*self.curves(gap), fraction)


def sample_curves(turns: Tensor, path: Tensor, fraction: Tensor) -> tuple[Tensor, Tensor]:
    """Curves [..., knots, 144] and [..., knots + 2, 3] at `fraction` [...]: zero residual at 0 and 1."""
    weights = cubic_weights(fraction, turns.shape[-2])[..., None]
    return (turns * weights[..., 1:-1, :]).sum(-2), (path * weights).sum(-2)
