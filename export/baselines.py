"""What a network has to beat between key poses: SLERP, a cubic curve, and the most alike stretch of the training set.

None of them has a path over the floor of its own; callers put them on the real one.
"""

from __future__ import annotations

import torch
from torch import Tensor

from data import Clip
from metrics import joints, matrices_of
from rotation import (
    axis_angle_to_quaternion,
    heading,
    matrix_to_quaternion,
    matrix_to_six_d,
    quaternion_to_axis_angle,
    quaternion_to_matrix,
    slerp,
    yaw_matrix,
)
from skeleton import mirror_motion


def with_path(rotations: Tensor, path: Tensor) -> Tensor:
    """Rotations [N, 24, 3, 3] and root [N, 3] -> motion [N, 147]."""
    return torch.cat([matrix_to_six_d(rotations).flatten(-2), path], -1)


def _between(frames: int, keys: Tensor) -> tuple[Tensor, Tensor]:
    """For each frame [N] the number of the key before it and the share of the way to the next. Keys begin at 0 and end at N - 1."""
    t = torch.arange(frames)
    index = (torch.searchsorted(keys, t, right=True) - 1).clamp(0, len(keys) - 2)
    share = (t - keys[index]).float() / (keys[index + 1] - keys[index])
    return index, share


def slerp_rotations(poses: Tensor, keys: Tensor, frames: int) -> Tensor:
    """SLERP through key poses [M, 24, 3, 3] at `keys` [M] -> [N, 24, 3, 3]."""
    index, share = _between(frames, keys)
    quaternions = matrix_to_quaternion(poses)
    return quaternion_to_matrix(slerp(quaternions[index], quaternions[index + 1], share[:, None, None]))


def _product(a: Tensor, b: Tensor) -> Tensor:
    """Quaternion product a b [..., 4], x y z w."""
    av, aw, bv, bw = a[..., :3], a[..., 3:], b[..., :3], b[..., 3:]
    vector = aw * bv + bw * av + torch.linalg.cross(av, bv)
    return torch.cat([vector, aw * bw - (av * bv).sum(-1, keepdim=True)], -1)


def _step(a: Tensor, b: Tensor) -> Tensor:
    """Rotation vector [..., 3] that takes quaternion a to b, in a's own frame."""
    return quaternion_to_axis_angle(_product(torch.cat([-a[..., :3], a[..., 3:]], -1), b))


def cubic_rotations(poses: Tensor, keys: Tensor, frames: int) -> Tensor:
    """Catmull-Rom (Kochanek-Bartels with tension, bias and continuity 0) through key poses, in rotation space -> [N, 24, 3, 3].

    Velocity at a key: mean of the steps on both sides per frame, so unequal gaps do not overshoot; one step at the ends. Between
    keys runs the cubic Bezier curve of those velocities in its cumulative form (Kim, Kim, Shin 1995).
    """
    quaternions = matrix_to_quaternion(poses)
    gaps = (keys[1:] - keys[:-1]).to(poses.dtype)[:, None, None]
    steps = _step(quaternions[:-1], quaternions[1:]) / gaps
    velocity = torch.cat([steps[:1], (steps[:-1] + steps[1:]) / 2, steps[-1:]])
    index, share = _between(frames, keys)
    t = share[:, None, None].to(poses.dtype)
    start, end, third = quaternions[index], quaternions[index + 1], gaps[index] / 3
    leave, arrive = velocity[index] * third, velocity[index + 1] * third
    after, before = _product(start, axis_angle_to_quaternion(leave)), _product(end, axis_angle_to_quaternion(-arrive))
    middle = _step(after, before)
    rest = 1 - t
    curve = start
    for way, weight in ((leave, 1 - rest**3), (middle, t * t * (3 - 2 * t)), (arrive, t**3)):
        curve = _product(curve, axis_angle_to_quaternion(way * weight))
    return quaternion_to_matrix(curve / curve.norm(dim=-1, keepdim=True))


class NearestNeighbour:
    """Finds, for each gap between two keys, the training stretch of that length whose first and last poses are most alike.

    Poses are compared as root-aligned joint positions in the heading of the stretch's first frame, so where it faces is free and how
    much it turns is not. Mirrored stretches count too. Stretches with repaired joints do not.
    """

    def __init__(self, clips: list[Clip]) -> None:
        self.clips = clips
        self._poses = [joints(clip.motion) for clip in clips]
        self._turns = [yaw_matrix(-heading(matrices_of(clip.motion)[:, 0])) for clip in clips]
        # Number of frames with any repaired joint up to each frame: a stretch is clean if it does not grow.
        self._broken = [torch.cat([torch.zeros(1), (~clip.valid.all(-1)).float().cumsum(0)]) for clip in clips]

    @staticmethod
    def _ends(poses: Tensor, turns: Tensor, first: Tensor, last: Tensor) -> Tensor:
        """First and last poses of stretches [n, 138], seen in the heading of the first."""
        turn = turns[first].transpose(-1, -2)
        return torch.cat([(poses[at] @ turn)[:, 1:].flatten(1) for at in (first, last)], -1)

    def find(self, dance: Tensor, keys: Tensor) -> list[tuple[int, int, bool]]:
        """Best (clip, start, mirrored) for each gap of a dance [N, 147] whose poses are known at `keys` [M] only."""
        queries = []
        for motion in (dance, mirror_motion(dance)):
            turns = yaw_matrix(-heading(matrices_of(motion[keys])[:, 0]))
            places = torch.arange(len(keys))
            queries.append(self._ends(joints(motion[keys]), turns, places[:-1], places[1:]))
        wanted = torch.cat(queries)  # [2 (M - 1), 138]
        lengths = (keys[1:] - keys[:-1]).repeat(2)
        best = torch.full((len(wanted),), float("inf"))
        place = torch.zeros(len(wanted), 2, dtype=torch.long)
        for length in lengths.unique().tolist():
            asked = torch.nonzero(lengths == length)[:, 0]
            for number, (poses, turns, broken) in enumerate(zip(self._poses, self._turns, self._broken)):
                first = torch.arange(len(poses) - length)
                first = first[broken[first + length + 1] == broken[first]]
                if len(first) == 0:
                    continue
                nearest, at = torch.cdist(wanted[asked], self._ends(poses, turns, first, first + length)).min(1)
                better = nearest < best[asked]
                best[asked] = torch.where(better, nearest, best[asked])
                place[asked] = torch.where(better[:, None], torch.stack([torch.full_like(at, number), first[at]], -1), place[asked])
        gaps = len(keys) - 1
        chosen = []
        for gap in range(gaps):
            mirrored = bool(best[gaps + gap] < best[gap])
            number, start = place[gaps + gap if mirrored else gap].tolist()
            chosen.append((number, start, mirrored))
        return chosen

    def rotations(self, dance: Tensor, keys: Tensor) -> Tensor:
        """The found stretches through the key poses -> [N, 24, 3, 3]: what each differs by from SLERP between its own ends is put on
        SLERP between the keys, so that it passes them."""
        made = slerp_rotations(matrices_of(dance[keys]), keys, int(keys[-1]) + 1)
        for (number, start, mirrored), first, last in zip(self.find(dance, keys), keys[:-1].tolist(), keys[1:].tolist()):
            stretch = self.clips[number].motion[start : start + last - first + 1]
            own = matrices_of(mirror_motion(stretch) if mirrored else stretch)
            ends = torch.tensor([0, last - first])
            base = slerp_rotations(own[ends], ends, last - first + 1)
            made[first : last + 1] = made[first : last + 1] @ base.transpose(-1, -2) @ own
        return made

