"""How different are dances to the same music and keys? Mean distance of the joints between any two of them, cm."""

from __future__ import annotations

from pathlib import Path


import metrics
from dance_metrics import pairwise_distance
from data import Clip
from evaluation.dances import Task, make_task, rollout
from evaluation.runners import Run
from evaluation.shipped import Order, Song, make_dances
from spec import FPS, SEED_FRAMES
from windows import to_local_frame

SECONDS = 16


def _shortened(task: Task, seconds: int) -> Task:
    """The beginning of a task."""
    frames = min(task.frames, seconds * FPS + 1)
    pieces = [(start, min(length, frames - start)) for start, length in task.pieces if start < frames - 1]
    keys = task.keys[task.keys < frames]
    return Task(
        task.clip, task.spacing, task.seed, task.real[:frames], task.music[:frames], keys, task.between[:frames], task.beats, pieces
    )


def diversity(clips: list[Clip], run: Run, model: Path | None, seeds: int = 4) -> dict:
    """{keys every s: {network | shipped: cm}} on the longest clip's first 16 s, and the distance between real dances.

    network: seed motions from other clips (paper A, section 4.2.4). shipped: the page's `seed` at variation 1, fillers on.
    """
    ordered = sorted(clips, key=lambda clip: -clip.frames)
    others = [to_local_frame(clip.motion[:SEED_FRAMES], SEED_FRAMES) for clip in ordered[1:seeds]]
    result: dict = {"clip": ordered[0].name, "seeds": seeds}
    orders: list[tuple[str, Order]] = []
    for seconds in (1, 2, 4):
        task = make_task(ordered[0], seconds * FPS)
        if task is None:
            continue
        task = _shortened(task, SECONDS)
        if len(others) > 0:
            made = [metrics.joints(rollout(task, run, seed)) for seed in (task.seed, *others)]
            result[f"{seconds}"] = {"network": round(pairwise_distance(made) * 100, 2)}
        song = Song(task.music, task.beats, task.clip.downbeats - SEED_FRAMES)
        runs = {str(seed): {"seed": seed, "variation": 1.0, "fillers": True} for seed in range(1, seeds + 1)}
        orders.append((f"{seconds}", Order(song, runs, None, 0, task.keys, task.real[task.keys])))
    if model:
        for (seconds, _), dances in zip(orders, make_dances(model, [order for _, order in orders])):
            made = [metrics.joints(dance) for dance in dances.values()]
            result.setdefault(seconds, {})["shipped"] = round(pairwise_distance(made) * 100, 2)
    shortest = 4 * FPS
    real = [metrics.joints(to_local_frame(clip.motion[: shortest + 1], 1)) for clip in ordered if clip.frames > shortest]
    result["real, different dances"] = round(pairwise_distance(real) * 100, 2) if len(real) > 1 else None
    return result
