"""Forward kinematics and mirroring of the figure in web/core/spec.json."""

from __future__ import annotations

import torch
from torch import Tensor

from spec import JOINT_COUNT, JOINTS, OFFSETS, PARENTS, ROTATION_SIZE


def _levels() -> list[list[int]]:
    """Joints by depth, so that FK runs level by level in a few large products instead of joint by joint."""
    depth = [0] * JOINT_COUNT
    for joint in range(1, JOINT_COUNT):
        depth[joint] = depth[PARENTS[joint]] + 1
    return [[j for j in range(JOINT_COUNT) if depth[j] == d] for d in range(max(depth) + 1)]


LEVELS = _levels()
# Where a joint's result stands after the levels are laid end to end, to bring it back into spec order.
_PLACE = torch.tensor([j for level in LEVELS for j in level]).argsort()
_OFFSETS = torch.tensor(OFFSETS, dtype=torch.float64)


def forward_kinematics(matrices: Tensor, root: Tensor | None = None) -> Tensor:
    """World joint positions [..., 24, 3] in metres from local rotations [..., 24, 3, 3] and pelvis positions [..., 3].

    Without `root` the pelvis stands at the origin.
    """
    return _chain(matrices, root)[0]


def world_rotations(matrices: Tensor) -> Tensor:
    """World rotations [..., 24, 3, 3] of local rotations [..., 24, 3, 3]."""
    return _chain(matrices, None)[1]


def _chain(matrices: Tensor, root: Tensor | None) -> tuple[Tensor, Tensor]:
    offsets = _OFFSETS.to(matrices)
    # Times zero instead of zeros_like, which the ONNX exporter turns into a constant of the example's length.
    first = matrices[..., 0, 0, :] * 0 if root is None else root
    positions, rotations = [first[..., None, :]], [matrices[..., :1, :, :]]
    for above, level in zip(LEVELS, LEVELS[1:]):
        parents = [above.index(PARENTS[j]) for j in level]
        turned = rotations[-1][..., parents, :, :]
        offset = (turned * offsets[level][:, None, :]).sum(-1)
        positions.append(positions[-1][..., parents, :] + offset)
        # Products written out: thousands of 3 x 3 matmul calls are slower than three broadcast multiplications.
        local = matrices[..., level, :, :]
        rotations.append(sum(turned[..., :, k, None] * local[..., k, None, :] for k in range(3)))
    return torch.cat(positions, -2)[..., _PLACE, :], torch.cat(rotations, -3)[..., _PLACE, :, :]


def _mirrored_joints() -> list[int]:
    swap = {"left": "right", "right": "left"}
    names = ["_".join(swap.get(part, part) for part in name.split("_")) for name in JOINTS]
    return [JOINTS.index(name) for name in names]


MIRRORED_JOINTS = _mirrored_joints()
# Reflection in x = 0 takes R to M R M with M = diag(-1, 1, 1); these are the signs of columns 0 and 1.
_MIRROR_SIX_D = torch.tensor([1.0, -1.0, -1.0, -1.0, 1.0, 1.0])
_MIRROR_ROOT = torch.tensor([-1.0, 1.0, 1.0])


def mirror_motion(motion: Tensor) -> Tensor:
    """Motion [..., 147] seen in a mirror: left and right limbs swap, the path's x changes sign."""
    rotations = motion[..., :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6))[..., MIRRORED_JOINTS, :]
    mirrored = rotations * _MIRROR_SIX_D.to(motion)
    return torch.cat([mirrored.flatten(-2), motion[..., ROTATION_SIZE:] * _MIRROR_ROOT.to(motion)], -1)
