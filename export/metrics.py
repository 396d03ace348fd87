"""Measures of a dance. Motion is [N, 147] (24 x 6D, root); the same definitions stand in web/core/metrics.ts."""

from __future__ import annotations

import torch
from torch import Tensor

from rotation import angle_between, six_d_to_matrix
from skeleton import forward_kinematics
from spec import FEET, FPS, ROTATION_SIZE, TOE_HEIGHT

CONTACT_HEIGHT = TOE_HEIGHT + 0.03  # metres; a toe joint below it counts as on the floor
FREEZE_SPEED = 0.05  # m/s; a body whose joints move slower than this on average stands still to the eye


def matrices_of(motion: Tensor) -> Tensor:
    """[..., 147] -> local rotations [..., 24, 3, 3] (or of the first joints only, from their first numbers)."""
    return six_d_to_matrix(motion[..., :ROTATION_SIZE].unflatten(-1, (-1, 6)))


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
    return jerk_of(joints(motion))


def jerk_of(positions: Tensor) -> float:
    """`mean_jerk` of joint positions [N, 24, 3]."""
    return float((positions.diff(n=3, dim=0) * FPS**3).norm(dim=-1).mean())


def kinetic_beats(speed: Tensor, extrema: bool = False) -> Tensor:
    """Frames (fractional) of the local minima of a speed curve [N - 1]: value t lies between frames t and t + 1.

    `extrema` adds the local maxima: paper A says "local extrema" (section 4.2.4), paper B and its sources say minima.
    """
    before, here, after = speed[:-2], speed[1:-1], speed[2:]
    found = (here < before) & (here <= after)
    if extrema:
        found |= (here > before) & (here >= after)
    return torch.nonzero(found)[:, 0] + 1.5


def motion_beats(motion: Tensor, extrema: bool = False) -> Tensor:
    """Frames (fractional) where the root-aligned mean joint speed has a local minimum (or, with `extrema`, a maximum)."""
    return kinetic_beats(mean_joint_speed(joints(motion)), extrema)


def hit_rate(found: Tensor, beats: Tensor, delta: int) -> float:
    """Share of the musical `beats` with a motion beat among `found` within +- delta frames. NaN without beats."""
    if len(beats) == 0:
        return float("nan")
    if len(found) == 0:
        return 0.0
    return float(((beats[:, None] - found[None, :]).abs().min(1).values <= delta + 1e-6).double().mean())


def beat_hit_rate(motion: Tensor, beats: Tensor, delta: int, extrema: bool = False) -> float:
    """Paper A's N_d&m / N_m over the musical beats (in frames) inside the motion. NaN without beats."""
    inside = beats[(beats >= 0) & (beats < motion.shape[0])]
    return hit_rate(motion_beats(motion, extrema), inside, delta)


def longest_freeze(speed: Tensor, threshold: float = FREEZE_SPEED) -> float:
    """Longest stretch in seconds over which the mean joint speed [N - 1] stays below `threshold` m/s."""
    longest = run = 0
    for slow in (speed < threshold).tolist():
        run = run + 1 if slow else 0
        longest = max(longest, run)
    return longest / FPS


def foot_skate(motion: Tensor) -> float:
    """Mean horizontal speed (m/s) of the toe joints over frames where that toe is lower than CONTACT_HEIGHT. NaN without contact.

    Speed at frame t is taken from t - 1 to t.
    """
    return skate_speed(joints(motion, with_root=True))


def skate_speed(positions: Tensor) -> float:
    """`foot_skate` of world joint positions [N, 24, 3]."""
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


def distance_to_key(frames: int, keys: Tensor) -> Tensor:
    """Frames [N] from each frame to the nearest of the key frames [M]."""
    return (torch.arange(frames)[:, None] - keys[None, :]).abs().min(1).values
