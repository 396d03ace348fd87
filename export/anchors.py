"""What is known of each frame of a window before the network looks at it: the poses around it and the curve between them."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from inbetween import Gap, Inbetweener, body_joints
from rotation import gram_schmidt, six_d_to_matrix, slerp_matrices
from spec import FPS, JOINT_COUNT, ROTATION_SIZE

SHORTEST_SEED = 16  # frames; the course of the last half second tells where the first stretch comes from
# Beyond this many seconds without a key the in-betweener has nothing to go by; over the next FADE its say goes to zero.
LONGEST_GAP, FADE = 2.6, 1.4
# The longer the gap, the less the curve can know and the smaller it is: from 0.5 s to 2 s it is enlarged by up to this much, so that
# joints of the training dances move as fast as the real ones.
LIFT = 0.35
# The pelvis's height leaves that of the seed within this many frames.
SETTLE = 10

_LIMBS = ROTATION_SIZE - 6  # 6D numbers of the joints other than the pelvis
_STEP = _LIMBS + 6  # one anchor to the next
POSE_FEATURES = _LIMBS + 3 + 3
GAP_FEATURES = 3 * _STEP + 3


@dataclass
class Base:
    """The motion that the network's residual is added to; all of it free of the window's heading but for `columns`."""

    columns: tuple[Tensor, Tensor, Tensor]  # columns of the base rotations, each [B, T, J, 3]
    pose: Tensor  # [B, T, POSE_FEATURES]: the base pose and where in its gap the frame is
    steps: Tensor  # [B, T, GAP_FEATURES]: from anchor to anchor
    root: Tensor  # [B, T, 3]: x and z of the last seed frame, height of the base
    velocity: Tensor  # [B, T, 2]: to the side and forward, m/s


@dataclass
class Anchors:
    """The poses around every frame, [B, T, ...]."""

    gap: Gap
    fraction: Tensor  # [B, T] of the way from before to after
    has_previous: Tensor  # [B, T] bool
    has_next: Tensor  # [B, T] bool
    at_key: Tensor  # [B, T] bool
    at_previous: Tensor  # [B, T] frame of the key before (meaningless where there is none)


def look_up(table: Tensor, index: Tensor) -> Tensor:
    """Rows [B, T, n] of a table [B, T, n] at index [B, T], limited to the table."""
    # Sizes are taken of the index, which comes straight from an input: the exporter loses track of computed tables.
    batch, rows = index.shape[0], index.shape[1]
    first_row = (torch.arange(batch, device=table.device) * rows)[:, None]
    # Embedding look-up on the flattened table exports to one Gather, which every backend has.
    flat = table.reshape(batch * rows, table.shape[2])
    return nn.functional.embedding(first_row + index.clamp(0, rows - 1), flat)


def _pose_table(rotations: Tensor) -> Tensor:
    """6D rows [B, N, 144] -> orthonormal matrices and joint positions [B, N, 9 * 24 + 72]."""
    matrices = six_d_to_matrix(rotations.unflatten(-1, (JOINT_COUNT, 6)))
    return torch.cat([matrices.flatten(-3), body_joints(matrices)], -1)


def _split(rows: Tensor) -> tuple[Tensor, Tensor]:
    matrices, places = rows.split([9 * JOINT_COUNT, 3 * JOINT_COUNT], -1)
    return matrices.unflatten(-1, (JOINT_COUNT, 3, 3)), places


def find_anchors(seed: Tensor, key_poses: Tensor, to_previous: Tensor, to_next: Tensor) -> Anchors:
    """From the key before (or the last seed frame, t + 1 frames back) to the key after (none: the pose holds)."""
    frames = to_previous.shape[1]
    t = torch.arange(frames, device=seed.device)
    keys = _pose_table(key_poses)
    ends = _pose_table(torch.stack([seed[:, -SHORTEST_SEED:][:, 0], seed[:, -1]], 1)[..., :ROTATION_SIZE])
    start, last = (ends[:, k : k + 1].expand(-1, frames, -1) for k in (0, 1))
    has_previous, has_next = to_previous >= 0, to_next >= 0
    at_previous, at_next = t - to_previous.long(), t + to_next.long()
    before = torch.where(has_previous[..., None], look_up(keys, at_previous), last)
    after = torch.where(has_next[..., None], look_up(keys, at_next), before)
    back = torch.where(has_previous, to_previous, (t + 1).to(to_previous))
    ahead = to_next.clamp(min=0)
    # At a key both distances are 0 (and both anchors are that key), hence the floor of 1.
    fraction = back / (back + ahead).clamp(min=1)
    fraction = torch.where(has_next, fraction, torch.zeros_like(fraction))

    # One anchor further on each side: where the motion comes from and where it will go.
    more_back = look_up(to_previous[..., None], at_previous - 1)[..., 0]
    has_earlier = has_previous & (at_previous > 0) & (more_back >= 0)
    from_seed = torch.where(has_previous[..., None], last, start)
    earlier = torch.where(has_earlier[..., None], look_up(keys, at_previous - 1 - more_back.long()), from_seed)
    gap_from_seed = torch.where(has_previous, (at_previous + 1).to(to_previous), torch.full_like(back, SHORTEST_SEED - 1))
    gap_back = torch.where(has_earlier, more_back + 1, gap_from_seed)
    more_ahead = look_up(to_next[..., None], at_next + 1)[..., 0]
    has_later = has_next & (at_next < frames - 1) & (more_ahead >= 0)
    later = torch.where(has_later[..., None], look_up(keys, at_next + 1 + more_ahead.long()), after)
    gap_ahead = torch.where(has_later, more_ahead + 1, torch.zeros_like(more_ahead))

    poses, joints = zip(*(_split(rows) for rows in (earlier, before, after, later)))
    seconds = torch.stack([gap_back, back + ahead, gap_ahead], -1) / FPS
    gap = Gap(poses, joints, seconds, has_previous.to(back))
    at_key = has_previous & (to_previous < 0.5)
    return Anchors(gap, fraction, has_previous, has_next, at_key, at_previous)


def slerp_columns(anchors: Anchors) -> tuple[Tensor, Tensor, Tensor]:
    """SLERP between the anchors: three columns [B, T, J, 3] of each rotation."""
    _, before, after, _ = anchors.gap.poses
    return slerp_matrices(before, after, anchors.fraction[..., None, None]).unbind(-1)


def turn_columns(columns: tuple[Tensor, Tensor, Tensor], residual: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """R GramSchmidt(I + residual): columns [B, T, J, 3] of R, residual [B, T, 144]."""
    six_d = residual.unflatten(-1, (JOINT_COUNT, 6)) + residual.new_tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    first, second, third = columns
    return tuple(
        first * delta[..., :1] + second * delta[..., 1:2] + third * delta[..., 2:]
        for delta in gram_schmidt(six_d[..., :3], six_d[..., 3:])
    )


def find_base(
    seed: Tensor, key_poses: Tensor, to_previous: Tensor, to_next: Tensor, inbetweener: Inbetweener | None = None
) -> Base:
    """SLERP between the anchors of each frame and, if there is an in-betweener, its curve on top."""
    anchors = find_anchors(seed, key_poses, to_previous, to_next)
    columns = slerp_columns(anchors)
    last_root = seed[:, -1:, ROTATION_SIZE:].expand(-1, to_previous.shape[1], -1)
    height, velocity = last_root[..., 1:2], torch.zeros_like(last_root[..., :2])
    if inbetweener is not None:
        residual, path = inbetweener(anchors.gap, anchors.fraction)
        say = ((LONGEST_GAP + FADE - anchors.gap.seconds[..., 1:2]) / FADE).clamp(0, 1) * anchors.has_next[..., None].to(residual)
        lift = 1 + LIFT * ((anchors.gap.seconds[..., 1:2] - 0.5) / 1.5).clamp(0, 1)
        columns = _round_corners(turn_columns(columns, residual * say * lift))
        # A gap has no length at a key itself: the pelvis goes on there as in the frame before.
        path = torch.cat([path, say], -1)
        path = torch.where(anchors.at_key[..., None], torch.cat([path[:, 1:2], path[:, :-1]], 1), path)
        side, up, forward, say = path.split(1, -1)
        velocity = torch.cat([side, forward], -1) * say
        height = _height(up, say, anchors, last_root[..., 1:2])
    poses = anchors.gap.poses
    limbs = torch.cat([columns[0][:, :, 1:], columns[1][:, :, 1:]], -1).flatten(-2)
    up = torch.stack([column[:, :, 0, 1] for column in columns], -1)  # the world's up axis in the body's frame
    flags = (anchors.fraction, anchors.has_previous.to(up), anchors.has_next.to(up))
    steps = torch.cat([*(_step(a, b) for a, b in zip(poses, poses[1:])), anchors.gap.seconds], -1)
    root = torch.cat([last_root[..., :1], height, last_root[..., 2:]], -1)
    return Base(columns, torch.cat([limbs, up, torch.stack(flags, -1)], -1), steps, root, velocity)


# Curves of neighbouring gaps meet in a corner at the key; this much of both neighbours rounds it by a frame.
ROUNDING = 1 / 6


def _round_corners(columns: tuple[Tensor, Tensor, Tensor]) -> tuple[Tensor, Tensor, Tensor]:
    """Columns [B, T, J, 3] averaged with those of the frames before and after, made orthonormal again."""
    rounded = []
    for column in columns[:2]:
        before, after = torch.cat([column[:, :1], column[:, :-1]], 1), torch.cat([column[:, 1:], column[:, -1:]], 1)
        rounded.append(column + ROUNDING * (before + after - 2 * column))
    return gram_schmidt(*rounded)


def _height(path: Tensor, say: Tensor, anchors: Anchors, last: Tensor) -> Tensor:
    """Height of the pelvis [B, T, 1]: the curve's, held after the last key, and growing out of the seed's."""
    frames = path.shape[1]
    curve = path * say + last * (1 - say)
    held = look_up(curve, anchors.at_previous)
    stays = (anchors.has_previous & ~anchors.has_next)[..., None]
    curve = torch.where(stays, held, curve)
    ramp = ((torch.arange(frames, device=path.device) + 1) / SETTLE).clamp(max=1).to(path)[:, None]
    return last + (curve - last) * ramp


def _step(a: Tensor, b: Tensor) -> Tensor:  # two [B, T, J, 3, 3] -> [B, T, _STEP]
    """Change of the limbs' rotations, and the pelvis's turn in its own frame."""
    limbs = (b - a)[:, :, 1:, :, :2].transpose(-1, -2).flatten(-3)
    turn = a[:, :, 0].transpose(-1, -2) @ b[:, :, 0]
    return torch.cat([limbs, turn[..., 0], turn[..., 1]], -1)
