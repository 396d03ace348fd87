"""Measures a model on the validation clips against SLERP between the key poses and against the real dance:

    python export/evaluate.py --data DATA_FOLDER --features export/cache/features --checkpoint export/runs/light/checkpoint.pt \\
        --out export/runs/light/evaluation

Writes OUT.json and OUT.md. --onnx FILE measures a shipped file instead of a checkpoint. Key poses are the real poses at frames
0, s, 2s ... of each window (8 s, seeded by the real 2 s before it); errors are taken on the frames between them, root-aligned.
"rollout" goes through a whole clip, each window seeded by the output before it, as the app does.
SLERP has no path of its own: for its foot skate it is put on the real path.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable
from pathlib import Path

import onnxruntime
import torch
from torch import Tensor

import metrics
from data import Clip, load_clips
from export_onnx import load_averaged
from model import INPUT_NAMES, OUTPUT_NAME, interpolation_base
from rotation import heading, matrix_to_six_d, yaw_matrix
from spec import FPS, MUSIC_FRAMES, ROTATION_SIZE, SEED_FRAMES
from windows import Window, cut_window, key_distances, to_local_frame

Run = Callable[[dict[str, Tensor]], Tensor]
COLUMNS = (
    ("position_cm", "position error, cm"),
    ("rotation_deg", "rotation error, deg"),
    ("E_c", "E_c"),
    ("S_cv", "S_cv"),
    ("speed_ratio", "speed / real"),
    ("jerk_ratio", "jerk / real"),
    ("foot_skate", "foot skate, m/s"),
    ("hit1", "beat hit 1"),
    ("hit2", "2"),
    ("hit3", "3"),
    ("hit4", "4"),
    ("hit5", "5"),
)


def torch_runner(checkpoint: Path) -> Run:
    """Runs the averaged weights of a checkpoint."""
    model = load_averaged(checkpoint)

    @torch.no_grad()
    def run(inputs: dict[str, Tensor]) -> Tensor:
        return model(*(inputs[name] for name in INPUT_NAMES))

    return run


def onnx_runner(path: Path) -> Run:
    """Runs an ONNX file on onnxruntime's CPU backend."""
    session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])

    def run(inputs: dict[str, Tensor]) -> Tensor:
        return torch.from_numpy(session.run([OUTPUT_NAME], {name: inputs[name].numpy() for name in INPUT_NAMES})[0])

    return run


def window_inputs(window: Window) -> dict[str, Tensor]:
    """A window as a batch of one."""
    return {name: getattr(window, name)[None] for name in INPUT_NAMES}


def slerp_motion(window: Window) -> Tensor:
    """The baseline [T, 147]: SLERP between the key poses, on the real path."""
    inputs = window_inputs(window)
    base = interpolation_base(inputs["seed"], inputs["key_poses"], inputs["to_previous"], inputs["to_next"])
    rotations = torch.cat(base.columns[:2], -1).flatten(-2)[0]
    return torch.cat([rotations, window.target[:, ROTATION_SIZE:]], -1)


def clip_windows(clip: Clip, spacing: int) -> list[Window]:
    """Windows side by side through a clip, with a key on the first and the last frame; a last short one keeps at least 1 s."""
    windows, start, rng = [], 0, torch.Generator().manual_seed(0)
    while True:
        room = min(MUSIC_FRAMES, clip.frames - start - SEED_FRAMES - 1)
        frames = room // spacing * spacing + 1
        if frames <= max(spacing, FPS):
            return windows
        windows.append(cut_window(clip, start, frames, rng, keys=torch.arange(0, frames, spacing)))
        start += frames - 1


def rollout(clip: Clip, spacing: int, run: Run) -> tuple[Tensor, Tensor] | None:
    """Generates a whole clip from its first seed only -> (generated, real) [N, 147], both in the frame of the first window."""
    total = (clip.frames - SEED_FRAMES - 1) // spacing * spacing + 1
    if total <= FPS:
        return None
    real = to_local_frame(clip.motion[: SEED_FRAMES + total], SEED_FRAMES)
    music = cut_window(clip, 0, total, torch.Generator().manual_seed(0), keys=torch.zeros(0, dtype=torch.long)).music
    dance = real[:SEED_FRAMES]
    step = MUSIC_FRAMES // spacing * spacing or spacing
    for start in range(0, total, step):
        frames = min(step + 1, total - start)
        ahead = real[SEED_FRAMES + start : SEED_FRAMES + start + frames]
        # The window's frame is that of its own seed; the keys come along.
        local = to_local_frame(torch.cat([dance[-SEED_FRAMES:], ahead]), SEED_FRAMES)
        mask = torch.zeros(frames)
        mask[::spacing] = 1
        to_previous, to_next = key_distances(mask)
        values = (
            music[start : start + frames],
            local[:SEED_FRAMES],
            local[SEED_FRAMES:, :ROTATION_SIZE] * mask[:, None],
            mask,
            to_previous,
            to_next,
        )
        made = run({name: value[None] for name, value in zip(INPUT_NAMES, values)})[0]
        dance = torch.cat([dance, _back_to_world(made, dance[-1])[: min(step, total - start)]])
    return dance[SEED_FRAMES:], real[SEED_FRAMES : dance.shape[0]]


def _back_to_world(motion: Tensor, anchor: Tensor) -> Tensor:
    """Undoes to_local_frame for a window whose last seed frame was `anchor` [147]."""
    turn = yaw_matrix(heading(metrics.matrices_of(anchor)[0]))
    pelvis = matrix_to_six_d(turn @ metrics.matrices_of(motion)[:, 0])
    offset = anchor[ROTATION_SIZE:] * torch.tensor([1.0, 0.0, 1.0])
    return torch.cat([pelvis, motion[:, 6:ROTATION_SIZE], motion[:, ROTATION_SIZE:] @ turn.T + offset], -1)


class Tally:
    """Means weighted by frames; ratios are taken of the means."""

    def __init__(self) -> None:
        self.sums: dict[str, float] = {}
        self.weights: dict[str, float] = {}

    def add(self, name: str, value: float, weight: float) -> None:
        if math.isfinite(value) and weight > 0:
            self.sums[name] = self.sums.get(name, 0.0) + value * weight
            self.weights[name] = self.weights.get(name, 0.0) + weight

    def mean(self, name: str) -> float:
        return self.sums[name] / self.weights[name] if name in self.sums else float("nan")


def measure(tally: Tally, motion: Tensor, real: Tensor, keys: Tensor, between: Tensor, beats: Tensor) -> None:
    """Adds one motion [T, 147]; `keys` are key frames, `between` [T] marks the frames that errors are taken on."""
    frames = motion.shape[0]
    tally.add("position_cm", float(metrics.position_error(motion, real)[between].mean()) * 100, int(between.sum()))
    tally.add("rotation_deg", float(metrics.rotation_error(motion, real)[between].mean()), int(between.sum()))
    tally.add("E_c", metrics.consistency_error(motion, keys, real[keys, :ROTATION_SIZE]), len(keys))
    tally.add("S_cv", metrics.smoothness(motion), frames)
    tally.add("speed", float(metrics.mean_joint_speed(metrics.joints(motion)).mean()), frames)
    tally.add("jerk", metrics.mean_jerk(motion), frames)
    tally.add("foot_skate", metrics.foot_skate(motion), frames)
    inside = beats[(beats >= 0) & (beats < frames)]
    for delta in range(1, 6):
        tally.add(f"hit{delta}", metrics.beat_hit_rate(motion, inside, delta), len(inside))


def row(tally: Tally, real: Tally) -> dict[str, float]:
    """A table row from sums."""
    values = {name: tally.mean(name) for name, _ in COLUMNS if not name.endswith("_ratio")}
    values["speed_ratio"] = tally.mean("speed") / real.mean("speed")
    values["jerk_ratio"] = tally.mean("jerk") / real.mean("jerk")
    return {name: round(values[name], 4) for name, _ in COLUMNS}


def evaluate(clips: list[Clip], run: Run, spacings: tuple[float, ...] = (0.5, 1.0, 2.0), roll: bool = True) -> dict:
    """{spacing: {group: {real | slerp | model | rollout: row}}}; groups are the sources and `all`."""
    groups = sorted({clip.source for clip in clips})
    result: dict = {}
    for seconds in spacings:
        spacing = round(seconds * FPS)
        tallies = {(g, k): Tally() for g in (*groups, "all") for k in ("real", "slerp", "model", "rollout", "rollout_real")}

        def add(clip: Clip, kind: str, *values) -> None:
            for group in (clip.source, "all"):
                measure(tallies[group, kind], *values)

        for clip in clips:
            for window in clip_windows(clip, spacing):
                keys = torch.nonzero(window.key_mask)[:, 0]
                between = (window.key_mask == 0) & window.valid.bool().all(-1)
                shared = (window.target, keys, between, window.beats)
                add(clip, "real", window.target, *shared)
                add(clip, "slerp", slerp_motion(window), *shared)
                add(clip, "model", run(window_inputs(window))[0], *shared)
            made = rollout(clip, spacing, run) if roll else None
            if made:
                frames = made[0].shape[0]
                keys = torch.arange(0, frames, spacing)
                between = torch.ones(frames, dtype=torch.bool)
                between[keys] = False
                shared = (made[1], keys, between, clip.beats - SEED_FRAMES)
                add(clip, "rollout", made[0], *shared)
                add(clip, "rollout_real", made[1], *shared)
        result[str(seconds)] = {
            group: {
                "real": row(tallies[group, "real"], tallies[group, "real"]),
                "slerp": row(tallies[group, "slerp"], tallies[group, "real"]),
                "model": row(tallies[group, "model"], tallies[group, "real"]),
                **({"rollout": row(tallies[group, "rollout"], tallies[group, "rollout_real"])} if roll else {}),
            }
            for group in (*groups, "all")
        }
    return result


def markdown(result: dict) -> str:
    """The result as one table a group."""
    lines = []
    for group in next(iter(result.values())):
        titles = [title for _, title in COLUMNS]
        lines += [f"**{group}**", "", "| keys every | dance | " + " | ".join(titles) + " |", "|---" * (len(titles) + 2) + "|"]
        for seconds, groups in result.items():
            for kind, values in groups[group].items():
                cells = " | ".join(f"{values[name]:.3g}" for name, _ in COLUMNS)
                lines.append(f"| {seconds} s | {kind} | {cells} |")
        lines.append("")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", required=True)
    parser.add_argument("--features")
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"))
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--checkpoint", type=Path)
    which.add_argument("--onnx", type=Path)
    parser.add_argument("--spacings", type=float, nargs="+", default=(0.5, 1.0, 2.0), help="seconds between key poses")
    parser.add_argument("--no-rollout", action="store_true")
    parser.add_argument("--out", required=True, help="path without extension; .json and .md are written")
    args = parser.parse_args()
    clips = [clip for clip in load_clips(args.data, args.features, args.cache) if clip.split == "val"]
    run = torch_runner(args.checkpoint) if args.checkpoint else onnx_runner(args.onnx)
    result = evaluate(clips, run, tuple(args.spacings), not args.no_rollout)
    out = Path(args.out)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    table = markdown(result)
    out.with_suffix(".md").write_text(table + "\n", encoding="utf-8")
    print(table)


if __name__ == "__main__":
    main()
