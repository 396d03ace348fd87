"""Pictures of the evaluation. Numbered figures are paper A's. Needs requirements-evaluate.txt; nothing else here does."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import torch  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from torch import Tensor  # noqa: E402

import metrics  # noqa: E402
from evaluation.dances import Task  # noqa: E402
from evaluation.tally import DELTAS  # noqa: E402
from loss import key_weight  # noqa: E402
from spec import FPS, ONSET  # noqa: E402

COLOURS = {
    "real": "#d9822b",
    "slerp": "#9aa5b1",
    "cubic": "#c3b1e1",
    "nearest neighbour": "#6b8e23",
    "model": "#2b6cb0",
    "rollout": "#63b3ed",
    "shipped at strength 0": "#b83280",
    "shipped at strength 1": "#c53030",
}
plt.rcParams.update({"font.size": 8, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})


def _save(figure: plt.Figure, path: Path) -> Path:
    figure.tight_layout()
    # No date or version in the file: the same numbers give the same bytes.
    figure.savefig(path, dpi=90, metadata={"Software": None})
    plt.close(figure)
    return path


def weight_curves(path: Path, pairs: tuple[tuple[float, float], ...] = ((1, 0.05), (3, 0.05), (3, 0.1), (5, 0.2))) -> Path:
    """Figure 4: omega_t of eq. 15 over a window of 4 s with three key poses, for pairs of lambda and sigma (seconds)."""
    frames = 4 * FPS
    mask = torch.zeros(1, frames)
    mask[0, [int(0.6 * FPS), int(1.8 * FPS), int(3.2 * FPS)]] = 1
    figure, axes = plt.subplots(figsize=(5.2, 2.2))
    for lam, sigma in pairs:
        axes.plot(torch.arange(frames) / FPS, key_weight(mask, lam, sigma)[0], label=f"$\\lambda$ = {lam:g}, $\\sigma$ = {sigma:g} s")
    axes.set(xlabel="time, s", ylabel="$\\omega_t$")
    axes.legend()
    return _save(figure, path)


def hit_rates(path: Path, rows: dict[str, dict]) -> Path:
    """Figure 7: beat hit rate over delta, real and synthesised."""
    figure, axes = plt.subplots(figsize=(4.2, 2.8))
    for kind, values in rows.items():
        rates = [100 * values[f"hit{delta}"] for delta in DELTAS]
        axes.plot(DELTAS, rates, marker="o", markersize=3, label=kind, color=COLOURS.get(kind), lw=2 if kind == "real" else 1.2)
    axes.set(xlabel="$\\delta$, frames", ylabel="beat hit rate, %", xticks=DELTAS, ylim=(0, 100))
    axes.legend(fontsize=6)
    return _save(figure, path)


def errors(path: Path, table: dict, group: str = "all") -> Path:
    """Position error against the distance to the nearest key, one panel for each spacing."""
    figure, panels = plt.subplots(1, len(table), figsize=(2.9 * len(table), 2.6), squeeze=False, sharey=True)
    for axes, (seconds, groups) in zip(panels[0], table.items()):
        for kind, values in groups[group].items():
            if kind != "real":
                curve = values["by_distance"]
                axes.plot([f / FPS for f in curve["frames"]], curve["position_cm"], label=kind, color=COLOURS.get(kind), lw=1.2)
        axes.set(title=f"keys every {seconds} s", xlabel="to the nearest key, s")
    panels[0][0].set_ylabel("position error, cm")
    panels[0][-1].legend(fontsize=6)
    return _save(figure, path)


def _velocity(axes: Axes, motion: Tensor, name: str, start: int, beats: Tensor) -> None:
    speed = metrics.mean_joint_speed(metrics.joints(motion))
    times = (start + torch.arange(len(speed)) + 0.5) / FPS
    found = metrics.kinetic_beats(speed)
    axes.plot(times, speed, color=COLOURS.get(name, "#2b6cb0"), lw=1)
    # A beat at t + 0.5 is the t-th value of the curve.
    axes.plot((start + found) / FPS, speed[(found - 0.5).long()], "o", mfc="none", color="#c53030", markersize=4)
    axes.set_ylabel(f"{name}\nm/s")
    for beat in beats.tolist():
        axes.axvline((start + beat) / FPS, color="#c53030", lw=0.5, ls=":")


def beats_aligned(path: Path, task: Task, dances: dict[str, Tensor], first: int = 0, seconds: float = 8) -> Path:
    """Figure 9: kinetic velocity of real and synthesised dance with motion beats as circles, the onset curve, the music's beats dotted."""
    last = min(task.frames, first + round(seconds * FPS))
    beats = task.beats[(task.beats >= first) & (task.beats < last)] - first
    figure, panels = plt.subplots(len(dances) + 1, 1, figsize=(7, 1.1 * (len(dances) + 1)), sharex=True)
    for axes, (name, motion) in zip(panels, dances.items()):
        _velocity(axes, motion[first:last], name, first, beats)
    axes = panels[-1]
    axes.plot(torch.arange(first, last) / FPS, task.music[first:last, ONSET], color="#2f855a", lw=1)
    axes.vlines((first + beats) / FPS, 0, 1, color="#c53030", lw=0.5, ls=":")
    axes.set(ylabel="onset", xlabel="time, s")
    return _save(figure, path)


def over_lambda(path: Path, curves: dict[str, dict[str, dict[float, float]]]) -> Path:
    """Figures 5 and 6: E_c, S_cv and jerk over lambda. `curves`: {measure: {line: {lambda: value}}}."""
    figure, panels = plt.subplots(1, len(curves), figsize=(2.8 * len(curves), 2.5), squeeze=False)
    for axes, (measure, lines) in zip(panels[0], curves.items()):
        for name, values in lines.items():
            mean = name.endswith("mean")
            axes.plot(list(values), list(values.values()), marker="o", markersize=3, label=name, lw=2 if mean else 1)
        axes.set(xlabel="$\\lambda$", title=measure, xticks=list(next(iter(lines.values()))))
    panels[0][-1].legend(fontsize=6)
    return _save(figure, path)


def for_evaluation(folder: Path, table: dict, task: Task | None, dances: dict[str, Tensor]) -> list[Path]:
    """All pictures of one evaluation."""
    folder.mkdir(parents=True, exist_ok=True)
    made = [weight_curves(folder / "figure-4-weights.png"), errors(folder / "error-by-distance.png", table)]
    if "1" in table:
        made.append(hit_rates(folder / "figure-7-beat-hit-rate.png", table["1"]["all"]))
    if task:
        made.append(beats_aligned(folder / "figure-9-beats.png", task, dances))
    return made
