"""Kochanek-Bartels (TCB) curves between key poses: the formula that web/core/curves.ts mirrors (paper B, section 4.2).

A dance is M key times and, for each of 99 channels (root x y z, then 24 quaternions x y z w), M key values. Each interval between
two keys has two inner knots and its own tension T, continuity C and bias B, so that with the keys it is a curve of 4 knots.

All knots of a channel, keys and inner ones, are one row at times u_i (seconds) with values p_i. Velocities at knot i (Kochanek and
Bartels 1984, eq. 8-9 with their correction for uneven spacing, section 5), b = p_i - p_(i-1), a = p_(i+1) - p_i, w = u_(i+1) - u_(i-1):

    arriving = (1-T) ((1-C)(1+B) b + (1+C)(1-B) a) / w
    leaving  = (1-T) ((1+C)(1+B) b + (1-C)(1-B) a) / w

T, C, B of an inner knot are its interval's; of a key between two intervals the mean of both intervals', so with C = 0 the dance
has one velocity on both sides of a key. The first and the last key have (1-T) times the slope of the line to their only neighbour.
Between knots i and i+1 runs the cubic Hermite curve of p_i, p_(i+1) and the velocities leaving i and arriving at i+1. Quaternions are
interpolated number by number and scaled to length 1 after sampling; their signs must be continuous along the knots (`align_signs`).
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from spec import JOINT_COUNT, SPEC

ROOT_CHANNELS = 3
CHANNELS = ROOT_CHANNELS + 4 * JOINT_COUNT
INNER_FRACTIONS: tuple[float, float] = tuple(SPEC["danceformer"]["curve"]["innerFractions"])
INNER_KNOTS = len(INNER_FRACTIONS)
SEGMENTS = INNER_KNOTS + 1


@dataclass
class Curves:
    """M keys, N = M - 1 intervals, C channels; dances of a batch stand in leading axes."""

    times: Tensor  # [..., M] seconds, ascending
    keys: Tensor  # [..., M, C]
    inner: Tensor  # [..., N, 2, C] values of the inner knots
    tcb: Tensor  # [..., N, 3, C] tension, continuity, bias
    fractions: Tensor | None = None  # [..., N, 2, C] places of the inner knots in the interval; None: INNER_FRACTIONS


def align_signs(quaternions: Tensor) -> Tensor:
    """[N, J, 4] with the sign of each turned to its predecessor's side; the first has w >= 0."""
    first = torch.where(quaternions[:1, ..., 3:] < 0, -1.0, 1.0).to(quaternions)
    turned = torch.where((quaternions[1:] * quaternions[:-1]).sum(-1, keepdim=True) < 0, -1.0, 1.0).to(quaternions)
    return quaternions * torch.cat([first, turned]).cumprod(0)


def knot_rows(curves: Curves) -> tuple[Tensor, Tensor, Tensor]:
    """Times and values [..., K, C] and T, C, B [..., K, 3, C] of all knots in order, K = 3 (M - 1) + 1."""
    times, keys, tcb = curves.times[..., None], curves.keys, curves.tcb
    start, length = times[..., :-1, None, :], (times[..., 1:, :] - times[..., :-1, :])[..., None, :]
    fractions = curves.fractions
    if fractions is None:
        fractions = torch.tensor(INNER_FRACTIONS, dtype=keys.dtype, device=keys.device)[:, None]
    between = (start + fractions * length).expand_as(curves.inner)
    at = torch.cat([start.expand_as(between[..., :1, :]), between], -2).flatten(-3, -2)
    at = torch.cat([at, times[..., -1:, :].expand_as(keys[..., -1:, :])], -2)
    values = torch.cat([torch.cat([keys[..., :-1, None, :], curves.inner], -2).flatten(-3, -2), keys[..., -1:, :]], -2)
    shared = torch.cat([tcb[..., :1, :, :], (tcb[..., :-1, :, :] + tcb[..., 1:, :, :]) / 2], -3)
    handles = torch.stack([shared, tcb, tcb], -3).flatten(-4, -3)
    return at, values, torch.cat([handles, tcb[..., -1:, :, :]], -3)


def tangents(times: Tensor, values: Tensor, tcb: Tensor) -> tuple[Tensor, Tensor]:
    """Velocities arriving at and leaving each knot, [..., K, C] each, per second."""
    difference = values[..., 1:, :] - values[..., :-1, :]
    before, after = difference[..., :-1, :], difference[..., 1:, :]
    tension, continuity, bias = tcb[..., 1:-1, :, :].unbind(-2)
    loose = (1 - tension) / (times[..., 2:, :] - times[..., :-2, :])
    arriving = loose * ((1 - continuity) * (1 + bias) * before + (1 + continuity) * (1 - bias) * after)
    leaving = loose * ((1 + continuity) * (1 + bias) * before + (1 - continuity) * (1 - bias) * after)
    slope = difference / (times[..., 1:, :] - times[..., :-1, :])
    first, last = (1 - tcb[..., :1, 0, :]) * slope[..., :1, :], (1 - tcb[..., -1:, 0, :]) * slope[..., -1:, :]
    return torch.cat([first, arriving, last], -2), torch.cat([first, leaving, last], -2)


def hermite(u: Tensor, begin: Tensor, leaving: Tensor, end: Tensor, arriving: Tensor, length: Tensor) -> Tensor:
    """Cubic Hermite curve at share u of the way, `length` seconds long, with velocities per second."""
    u2, u3 = u * u, u * u * u
    return (
        (2 * u3 - 3 * u2 + 1) * begin
        + (u3 - 2 * u2 + u) * length * leaving
        + (3 * u2 - 2 * u3) * end
        + (u3 - u2) * length * arriving
    )


def sample(curves: Curves, at: Tensor) -> Tensor:
    """Channel values [F, C] of one dance at the times `at` [F] in seconds; before the first and after the last key that key holds.

    Quaternions come as they are interpolated: scale them to length 1 (`motion_channels`).
    """
    times, values, tcb = knot_rows(curves)
    arriving, leaving = tangents(times, values, tcb)
    at = at.clamp(curves.times[0], curves.times[-1])
    interval = (torch.searchsorted(curves.times, at, right=True) - 1).clamp(0, len(curves.times) - 2)
    low = interval[:, None] * SEGMENTS
    for step in range(1, SEGMENTS):  # which of the three pieces: the inner knots may stand at other times in each channel
        low = low + (at[:, None] >= times[interval * SEGMENTS + step]).long()
    pick = lambda rows, index: rows.gather(0, index)  # noqa: E731
    begin, end = pick(times, low), pick(times, low + 1)
    u = (at[:, None] - begin) / (end - begin)
    return hermite(u, pick(values, low), pick(leaving, low), pick(values, low + 1), pick(arriving, low + 1), end - begin)


# Where `sample_evenly` looks within each of the three pieces of an interval: nine moments, evenly spaced.
PIECE_SHARES = (1 / 6, 1 / 2, 5 / 6)


def sample_evenly(curves: Curves) -> Tensor:
    """Values [..., N, 9, C] at the shares 1/18, 3/18 .. 17/18 of every interval, for training: no search, any batch axes."""
    times, values, tcb = knot_rows(curves)
    arriving, leaving = tangents(times, values, tcb)
    u = torch.tensor(PIECE_SHARES, dtype=values.dtype, device=values.device)[:, None]
    rows = [x[..., None, :] for x in (values[..., :-1, :], leaving[..., :-1, :], values[..., 1:, :], arriving[..., 1:, :])]
    length = (times[..., 1:, :] - times[..., :-1, :])[..., None, :]
    pieces = hermite(u, *rows, length)  # [..., 3 N, 3, C]
    return pieces.unflatten(-3, (-1, SEGMENTS)).flatten(-3, -2)


def motion_channels(values: Tensor) -> tuple[Tensor, Tensor]:
    """Channels [..., 99] -> root [..., 3] and unit quaternions [..., 24, 4]."""
    quaternions = values[..., ROOT_CHANNELS:].unflatten(-1, (JOINT_COUNT, 4))
    return values[..., :ROOT_CHANNELS], quaternions / quaternions.norm(dim=-1, keepdim=True).clamp_min(1e-9)
