"""Measures of a dance. Motion is [N, 147] (24 x 6D, root); the same definitions stand in web/core/metrics.ts."""

from __future__ import annotations

import torch
from torch import Tensor

from rotation import angle_between, six_d_to_matrix
from skeleton import forward_kinematics
from spec import FEET, FPS, JOINT_COUNT, ROTATION_SIZE, TOE_HEIGHT

CONTACT_HEIGHT = TOE_HEIGHT + 0.03  # metres; a toe joint below it counts as on the floor


def matrices_of(motion: Tensor) -> Tensor:
    """[..., 147] -> local rotations [..., 24, 3, 3]."""
    return six_d_to_matrix(motion[..., :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)))


def joints(motion: Tensor, with_root: bool = False) -> Tensor:
    """[..., 147] -> joint positions [..., 24, 3] in metres; root-aligned (pelvis at the origin) unless `with_root`."""
    return forward_kinematics(matrices_of(motion), motion[..., ROTATION_SIZE:] if with_root else None)


def consistency_error(motion: Tensor, key_frames: Tensor, key_poses: Tensor) -> float:
    """E_c, eq. 13: squared L2 over the 144 rotation numbers, mean over the M key poses [M, 144]."""
    return float(((motion[key_frames, :ROTATION_SIZE] - key_poses) ** 2).sum(-1).mean())


def smoothness(motion: Tensor) -> float:
    """S_cv, eq. 16: sd / |mean| of the frame-to-frame differences over all 147 dimensions. Its mean is near 0: unstable."""
    difference = (motion[1:] - motion[:-1]).double()
    return float(difference.std(correction=0) / difference.mean().abs().clamp_min(1e-12))


def mean_joint_speed(positions: Tensor) -> Tensor:
    """Positions [N, 24, 3] -> mean speed of the joints between frames, [N - 1], m/s."""
    return ((positions[1:] - positions[:-1]) * FPS).norm(dim=-1).mean(-1)


def mean_jerk(motion: Tensor) -> float:
    """Mean length of the third difference of root-aligned joint positions, m/s^3. Report it relative to real dance."""
    third = joints(motion).diff(n=3, dim=0) * FPS**3
    return float(third.norm(dim=-1).mean())


def motion_beats(motion: Tensor) -> Tensor:
    """Frames (fractional: speeds lie between frames) where the root-aligned mean joint speed has a local minimum."""
    speed = mean_joint_speed(joints(motion))
    lower = (speed[1:-1] < speed[:-2]) & (speed[1:-1] <= speed[2:])
    return torch.nonzero(lower)[:, 0] + 1.5


def beat_hit_rate(motion: Tensor, beats: Tensor, delta: int) -> float:
    """Share of the musical beats (in frames) with a motion beat within +- delta frames. NaN without beats."""
    beats = beats[(beats >= 0) & (beats < motion.shape[0])]
    if len(beats) == 0:
        return float("nan")
    found = motion_beats(motion)
    if len(found) == 0:
        return 0.0
    return float(((beats[:, None] - found[None, :]).abs().min(1).values <= delta + 1e-6).double().mean())


def foot_skate(motion: Tensor) -> float:
    """Mean horizontal speed (m/s) of the toe joints over frames where that toe is lower than CONTACT_HEIGHT. NaN without contact.

    Speed at frame t is taken from t - 1 to t.
    """
    positions = joints(motion, with_root=True)
    speeds = []
    for foot in FEET.values():
        toe = positions[:, foot["toe"]]
        horizontal = ((toe[1:] - toe[:-1]) * FPS)[:, [0, 2]].norm(dim=-1)
        speeds.append(horizontal[toe[1:, 1] < CONTACT_HEIGHT])
    pooled = torch.cat(speeds)
    return float(pooled.mean()) if len(pooled) else float("nan")


def position_error(predicted: Tensor, target: Tensor) -> Tensor:
    """Mean root-aligned joint position error of each frame [N], metres."""
    return (joints(predicted) - joints(target)).norm(dim=-1).mean(-1)


def rotation_error(predicted: Tensor, target: Tensor) -> Tensor:
    """Mean geodesic angle between local rotations of each frame [N], degrees."""
    return torch.rad2deg(angle_between(matrices_of(predicted), matrices_of(target)).mean(-1))
