"""The core table: every method on every validation clip."""

from __future__ import annotations

from collections.abc import Callable

from torch import Tensor

from baselines import NearestNeighbour
from data import Clip
from evaluation.dances import Task, baselines, cut, make_task, real_seeded, rollout
from evaluation.runners import Run
from evaluation.tally import Piece, Tally, measure, row
from spec import FPS

Extra = Callable[[Task], dict[str, Tensor]]
"""More whole dances [N, 147] of a task by name (the page's)."""


def core_table(
    clips: list[Clip],
    run: Run,
    spacings: tuple[float, ...] = (0.5, 1.0, 2.0),
    nearest: NearestNeighbour | None = None,
    extra: Extra | None = None,
) -> dict:
    """{spacing in seconds: {group: {dance: row}}}; groups are the sources and `all`."""
    groups = sorted({clip.source for clip in clips})
    result: dict = {}
    for seconds in spacings:
        tallies: dict[tuple[str, str], Tally] = {}
        for task in filter(None, (make_task(clip, round(seconds * FPS)) for clip in clips)):
            dances = {"real": cut(task.real, task)}
            dances |= {name: cut(dance, task) for name, dance in baselines(task, nearest).items()}
            dances["model"] = real_seeded(task, run)
            dances["rollout"] = cut(rollout(task, run), task)
            dances |= {name: cut(dance, task) for name, dance in (extra(task) if extra else {}).items()}
            real = [Piece(motion) for motion in dances["real"]]
            for name, pieces in dances.items():
                into = [tallies.setdefault((group, name), Tally()) for group in (task.clip.source, "all")]
                measure(into, task, pieces, real)
        result[f"{seconds:g}"] = {
            group: {name: row(tally, tallies[group, "real"]) for (of, name), tally in tallies.items() if of == group}
            for group in (*groups, "all")
        }
    return result
