"""Sums of measures over pieces of dance, and the table row that comes of them."""

from __future__ import annotations

import math
import statistics
from functools import cached_property

import torch
from torch import Tensor

import dance_metrics
import metrics
from evaluation.dances import Task
from spec import FPS, MUSIC_FRAMES, ROTATION_SIZE

DELTAS = (1, 2, 3, 4, 5)
COLUMNS = (
    ("position_cm", "position error, cm"),
    ("rotation_deg", "rotation error, deg"),
    ("E_c", "E_c"),
    ("S_cv", "S_cv"),
    ("speed_ratio", "speed / real"),
    ("jerk_ratio", "jerk / real"),
    ("foot_skate", "foot skate, m/s"),
    ("skate_ratio", "skate / real"),
    ("freeze_s", "longest freeze, s"),
    *((f"hit{delta}", f"beat hit {delta}" if delta == 1 else str(delta)) for delta in DELTAS),
    ("BC", "BC"),
    ("NPSS", "NPSS"),
    ("PFD", "PFD, cm2"),
    ("VFD", "VFD, m2/s2"),
    ("PVar", "PVar, cm2"),
)
RATIOS = {"speed_ratio": "speed", "jerk_ratio": "jerk", "skate_ratio": "foot_skate"}


class Tally:
    """Means weighted by frames, beats or keys; ratios are taken of the means."""

    def __init__(self) -> None:
        self.sums: dict[str, float] = {}
        self.weights: dict[str, float] = {}
        self.largest: dict[str, float] = {}
        self.smoothness: list[float] = []
        self.distances = torch.zeros(3, 0, dtype=torch.float64)  # sums of cm, degrees and frames by distance to the nearest key
        self.poses: list[Tensor] = []
        self.velocities: list[Tensor] = []
        self.dances: list[Tensor] = []  # full-length pieces, for the variance over dances

    def add(self, name: str, value: float, weight: float) -> None:
        """A value that counts `weight` times; NaN does not count."""
        if math.isfinite(value) and weight > 0:
            self.sums[name] = self.sums.get(name, 0.0) + value * weight
            self.weights[name] = self.weights.get(name, 0.0) + weight

    def mean(self, name: str) -> float:
        return self.sums[name] / self.weights[name] if name in self.sums else float("nan")

    def add_errors(self, centimetres: Tensor, degrees: Tensor, distance: Tensor) -> None:
        """Errors of frames [n] whose nearest key is `distance` [n] frames away."""
        if len(distance) == 0:
            return
        size = max(int(distance.max()) + 1, self.distances.shape[1])
        grown = torch.zeros(3, size, dtype=torch.float64)
        grown[:, : self.distances.shape[1]] = self.distances
        for row, values in enumerate((centimetres, degrees, torch.ones_like(centimetres))):
            grown[row].index_add_(0, distance, values.double())
        self.distances = grown

    def by_distance(self) -> dict[str, list[float]]:
        """{frames, position_cm, rotation_deg}: mean errors by the distance to the nearest key."""
        filled = torch.nonzero(self.distances[2])[:, 0]
        mean = self.distances[:2, filled] / self.distances[2, filled]
        return {
            "frames": filled.tolist(),
            "position_cm": [round(v, 3) for v in mean[0].tolist()],
            "rotation_deg": [round(v, 3) for v in mean[1].tolist()],
        }


class Piece:
    """A stretch of motion [N, 147] with what many measures need of it."""

    def __init__(self, motion: Tensor) -> None:
        self.motion = motion
        self.positions = metrics.joints(motion)
        self.speed = metrics.mean_joint_speed(self.positions)

    @cached_property
    def power(self) -> Tensor:
        """What NPSS is taken over."""
        return dance_metrics.power_values(self.motion, self.positions)


def measure(tallies: list[Tally], task: Task, pieces: list[Tensor], real: list[Piece]) -> None:
    """Adds one dance, cut as task.pieces, to all tallies. `real` is the real dance, cut likewise."""
    cut = [Piece(motion) for motion in pieces]
    for (start, frames), piece, truth in zip(task.pieces, cut, real, strict=True):
        keys = task.keys[(task.keys >= start) & (task.keys < start + frames)] - start
        _measure_piece(tallies, piece, truth, keys, task.between[start : start + frames], task.beats - start)
    # A freeze may run on over the border of two pieces.
    freeze = metrics.longest_freeze(torch.cat([piece.speed for piece in cut]))
    for tally in tallies:
        tally.largest["freeze_s"] = max(tally.largest.get("freeze_s", 0.0), freeze)


def _measure_piece(tallies: list[Tally], piece: Piece, real: Piece, keys: Tensor, between: Tensor, beats: Tensor) -> None:
    motion, positions = piece.motion, piece.positions
    frames, count = motion.shape[0], int(between.sum())
    centimetres = (positions - real.positions)[between].norm(dim=-1).mean(-1) * 100
    degrees = metrics.rotation_error(motion[between], real.motion[between])
    smoothness = metrics.smoothness(motion)
    values = [
        ("position_cm", float(centimetres.mean()) if count else math.nan, count),
        ("rotation_deg", float(degrees.mean()) if count else math.nan, count),
        ("E_c", metrics.consistency_error(motion, keys, real.motion[keys, :ROTATION_SIZE]), len(keys)),
        ("S_cv", smoothness, frames),
        ("speed", float(piece.speed.mean()), frames),
        ("jerk", metrics.jerk_of(positions), frames),
        ("foot_skate", metrics.skate_speed(positions + motion[:, None, ROTATION_SIZE:]), frames),
        ("NPSS", dance_metrics.npss_of(real.power, piece.power), frames),
    ]
    inside = beats[(beats >= 0) & (beats < frames)]
    for extrema in (False, True):
        found = metrics.kinetic_beats(piece.speed, extrema)
        values += [(f"hit{d}{'_extrema' if extrema else ''}", metrics.hit_rate(found, inside, d), len(inside)) for d in DELTAS]
    values.append(("BC", dance_metrics.beat_consistency(metrics.kinetic_beats(piece.speed), inside), len(inside)))
    poses = dance_metrics.pose_vectors(motion, positions)
    velocities = dance_metrics.velocity_vectors(motion, positions)
    distance = metrics.distance_to_key(frames, keys)[between]
    whole = frames > MUSIC_FRAMES - 2 * FPS - 1
    for tally in tallies:
        for value in values:
            tally.add(*value)
        tally.smoothness.append(smoothness)
        tally.add_errors(centimetres, degrees, distance)
        tally.poses.append(poses)
        tally.velocities.append(velocities)
        if whole:
            tally.dances.append(positions)


def row(tally: Tally, real: Tally) -> dict:
    """A table row; `real` is the tally of the real dance over the same pieces."""
    values = {name: tally.mean(name) for name, _ in COLUMNS if name in tally.sums}
    values |= {ratio: tally.mean(name) / real.mean(name) for ratio, name in RATIOS.items()}
    values["freeze_s"] = tally.largest.get("freeze_s", 0.0)
    # In centimetres, as distances between joints are read; velocities stay in metres per second.
    values["PFD"] = dance_metrics.frechet_distance(torch.cat(real.poses), torch.cat(tally.poses)) * 1e4
    values["VFD"] = dance_metrics.frechet_distance(torch.cat(real.velocities), torch.cat(tally.velocities))
    values["PVar"] = _variance(tally.dances) * 1e4
    row = {name: round(values.get(name, math.nan), 10 if name == "E_c" else 4) for name, _ in COLUMNS}
    row["S_cv_median"] = round(statistics.median(tally.smoothness), 1)
    row["speed"], row["jerk"] = round(tally.mean("speed"), 4), round(tally.mean("jerk"), 2)
    row["hit_extrema"] = [round(tally.mean(f"hit{delta}_extrema"), 4) for delta in DELTAS]
    row["by_distance"] = tally.by_distance()
    return row


def _variance(dances: list[Tensor]) -> float:
    if len(dances) < 2:
        return math.nan
    shortest = min(len(dance) for dance in dances)
    return dance_metrics.position_variance([dance[:shortest] for dance in dances])
