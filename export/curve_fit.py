"""Fits Kochanek-Bartels curves to real dance (paper B, section 4.2) and says how well they hold it:

    python export/curve_fit.py --data DATA --features FEATURES --out export/results/danceformer-fit

Key poses are the real poses on beats (every beat, every second beat). Between two keys one curve for each of the 99 channels, with
K inner knots; fitted by Adam to the channels of all frames at once, T, C, B held in -1..1 by tanh. Forms:
  `knots`    inner knots only, T = C = B = 0: K + 1 numbers an interval and channel, its first key included
  `sparse`   T, C, B only where they earn it (a small price on each; those under 0.05 are set to 0 and not counted)
  `5 values` two inner knots at thirds and T, C, B for each channel: 6 numbers
  `7 values` the times of the inner knots as well: 8 numbers
Numbers are counted against 99 a frame at 30 frames a second. Errors are means over frames and joints, hands and toes included: world joint
positions in cm, local rotations in degrees.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import torch
from torch import Tensor

from curves import CHANNELS, INNER_FRACTIONS, Curves, motion_channels, sample
from danceformer_data import at_times, motion_to_channels
from data import Clip, load_clips
from evaluation.tables import grid
from rotation import angle_between, quaternion_to_matrix
from skeleton import forward_kinematics
from spec import FPS

FORMS = ("knots", "sparse", "5 values", "7 values")
SMALLEST_SHAPE = 0.05  # of tension, continuity, bias: less is stored as nothing
PRICE = 2e-5  # of one unit of T, C or B in the sparse form, beside the square error of a frame


def fit(channels: Tensor, keys: Tensor, form: str, rounds: int = 220) -> tuple[Curves, float]:
    """Curves through the motion [N, 99] at key frames [M] (fractional) -> (curves with times in seconds, numbers a channel and interval)."""
    frames = torch.arange(int(keys[0].ceil()), int(keys[-1].floor()) + 1)
    wanted, times = channels[frames], keys / FPS
    length = keys[1:] - keys[:-1]
    inner = torch.stack([at_times(channels, keys[:-1] + share * length) for share in INNER_FRACTIONS], 1)
    inner.requires_grad_()
    raw = torch.zeros(len(length), 3, CHANNELS, requires_grad=form != "knots")
    places = torch.zeros(len(length), 2, CHANNELS, requires_grad=form == "7 values")
    groups = [{"params": [inner], "lr": 0.004}]
    if form != "knots":
        groups.append({"params": [raw], "lr": 0.03})
    if form == "7 values":
        groups.append({"params": [places], "lr": 0.02})
    optimiser = torch.optim.Adam(groups)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, rounds, eta_min=1e-5)
    base = torch.tensor(INNER_FRACTIONS)[None, :, None]

    def curves(shape: Tensor) -> Curves:
        return Curves(times, at_times(channels, keys), inner, shape, base + 0.15 * torch.tanh(places) if form == "7 values" else None)

    kept = torch.ones_like(raw)
    for number in range(rounds):
        if form == "sparse" and number == rounds * 2 // 3:  # the rest of the rounds settles what is left
            kept = (torch.tanh(raw.detach()).abs() >= SMALLEST_SHAPE).float()
        shape = torch.tanh(raw) * kept
        loss = (sample(curves(shape), frames / FPS) - wanted).square().sum(1).mean()
        if form == "sparse":
            loss = loss + PRICE * shape.abs().sum() / len(length) * 10
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        optimiser.step()
        schedule.step()
    with torch.no_grad():
        made = curves(torch.tanh(raw) * kept)
    numbers = {"knots": 3.0, "5 values": 6.0, "7 values": 8.0, "sparse": 3.0 + float(kept.sum()) / len(length) / CHANNELS}[form]
    return made, numbers


@torch.no_grad()
def errors(channels: Tensor, curves: Curves) -> tuple[Tensor, Tensor, Tensor]:
    """(cm, degrees [F, 24], root cm [F]) of the frames between the first and the last key."""
    frames = torch.arange(int((curves.times[0] * FPS).ceil()), int((curves.times[-1] * FPS).floor()) + 1)
    root, quaternions = motion_channels(sample(curves, frames / FPS))
    real_root, real = motion_channels(channels[frames])
    ours, truth = quaternion_to_matrix(quaternions), quaternion_to_matrix(real)
    apart = forward_kinematics(ours, root) - forward_kinematics(truth, real_root)
    return apart.norm(dim=-1) * 100, torch.rad2deg(angle_between(ours, truth)), (root - real_root).norm(dim=-1) * 100


def keys_of(clip: Clip, step: int) -> Tensor:
    """Every `step`-th beat inside a clip, frames."""
    beats = clip.beats[(clip.beats >= 0) & (clip.beats <= clip.frames - 1)]
    return beats[::step]


def measure(clips: list[Clip], steps: tuple[int, ...] = (1, 2), forms: tuple[str, ...] = FORMS, longest: int = 900) -> list[dict]:
    """Rows of the table: source, beats between keys, form -> errors and numbers. At most `longest` frames of a clip."""
    rows = []
    for step in steps:
        for form in forms:
            sums: dict[str, list[float]] = {}
            for clip in clips:
                keys = keys_of(clip, step)
                keys = keys[keys <= longest]
                if len(keys) < 3 or not clip.valid[: int(keys[-1]) + 1].all():
                    continue
                channels = motion_to_channels(clip.motion)
                made, numbers = fit(channels, keys, form)
                centimetres, degrees, root = errors(channels, made)
                count = len(centimetres)
                for group in (clip.source, "all"):
                    total = sums.setdefault(group, [0.0] * 6)
                    values = (centimetres.mean() * count, degrees.mean() * count, root.mean() * count, centimetres.max(-1).values.mean() * count)
                    for place, value in enumerate((*map(float, values), count, numbers * (len(keys) - 1))):
                        total[place] += value
            for group, (centimetres, degrees, root, worst, frames, numbers) in sums.items():
                rows.append(
                    {
                        "group": group,
                        "beats": step,
                        "form": form,
                        "joints_cm": round(centimetres / frames, 3),
                        "worst_joint_cm": round(worst / frames, 3),
                        "rotation_deg": round(degrees / frames, 3),
                        "root_cm": round(root / frames, 3),
                        "numbers": round(numbers, 1),
                        "times_fewer": round(frames / numbers, 2),
                        "frames": int(frames),
                    }
                )
                print(json.dumps(rows[-1]), flush=True)
    return rows


def markdown(result: dict) -> str:
    """The table."""
    head = ["clips", "beats between keys", "form", "mean joint error, cm", "worst joint, cm", "rotation, deg", "root, cm", "numbers against 30 fps frames"]
    rows = [
        [row["group"], str(row["beats"]), row["form"], f"{row['joints_cm']:.2f}", f"{row['worst_joint_cm']:.2f}", f"{row['rotation_deg']:.2f}",
         f"{row['root_cm']:.2f}", f"{row['times_fewer']:.1f} times fewer"]
        for row in result["rows"]
    ]  # fmt: skip
    return f"# TCB curves fitted to real dance: {result['clips']} clips of `{result['split']}`\n\n    {result['command']}\n\n{__doc__.split('Forms:')[1].join(['Forms:', ''])}\n{grid(head, rows)}\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", required=True)
    parser.add_argument("--features")
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"))
    parser.add_argument("--split", choices=("val", "train"), default="val")
    parser.add_argument("--longest", type=int, default=900, help="at most this many frames of a clip")
    parser.add_argument("--out", type=Path, required=True, help="path without extension")
    args = parser.parse_args()
    torch.set_num_threads(1)
    began = time.monotonic()
    clips = [clip for clip in load_clips(args.data, args.features, args.cache) if clip.split == args.split and len(clip.beats)]
    rows = measure(clips, longest=args.longest)
    result = {
        "command": f"python export/curve_fit.py --data DATA --features FEATURES --split {args.split} --longest {args.longest} --out {args.out}",
        "split": args.split,
        "clips": len(clips),
        "seconds": round(time.monotonic() - began),
        "rows": rows,
    }
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    args.out.with_suffix(".md").write_text(markdown(result), encoding="utf-8")


if __name__ == "__main__":
    main()
