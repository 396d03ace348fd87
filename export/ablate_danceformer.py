"""Ablations after paper B's Tables 2 and 3, each variant with the same few steps:

    python export/ablate_danceformer.py --data DATA --features FEATURES15 --song-features FEATURES53 --steps 60 --out export/results/danceformer-ablations

Stage 1 is trained anew for every variant (rows of 16 beats, 8 rows a step) and then dances the development songs (training songs that are
held out; the validation tracks are not touched) from nothing; its key poses are joined by the same cubic for all, so that only stage 1
differs. `codes` is the cross-entropy of the pose codes on those songs, `position` the error of the pose regressed from the right code.
Stage 2 is compared on the real key poses of the development songs; the in-betweener has seen these songs in its own training. With so few
steps the order of near neighbours is chance.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from baselines import cubic_rotations, with_path
from dance_metrics import beat_consistency, frechet_distance, npss, pose_vectors, position_variance, velocity_vectors
from danceformer_data import Dance, load_dances, split_dances
from danceformer_loss import LossConfig
from dantrans import JointFc
from data import load_clips
from evaluation.tables import grid
from metrics import joints, matrices_of, motion_beats
from spec import MOTION_SIZE, ROTATION_SIZE
from suggest import BEAT_SIZE, CODES, FUTURE_BEATS, PAST_BEATS, PAST_POSES, STYLES, Suggester
from train_danceformer import Settings, Trainer

STAGE1 = {
    "DanTrans (KPM, learned local mask, pose codes)": {},
    "KPM to linear": {"body": "linear"},
    "KPM to GNN": {"body": "gnn"},
    "global attention": {"attention": "global"},
    "local attention": {"attention": "local"},
    "Gaussian local attention": {"attention": "gaussian"},
    "regression with noise, no codes": {"head": "regress"},
    "regression with noise + adversarial": {"head": "regress", "adversarial": 0.1},
}
BEATS = 16


@torch.no_grad()
def roll_out(model: Suggester, dances: list[Dance], starts: list[Tensor], seed: int = 0) -> Tensor:
    """Suggested poses [B, 16, 147] for the first beats of each dance, all dances side by side."""
    rng = torch.Generator().manual_seed(seed)
    count = len(dances)
    poses, known = torch.zeros(count, PAST_POSES + BEATS, MOTION_SIZE), torch.zeros(count, PAST_POSES + BEATS)
    for beat in range(BEATS):
        music, heard = torch.zeros(count, PAST_BEATS + FUTURE_BEATS + 1, BEAT_SIZE), torch.zeros(count, PAST_BEATS + FUTURE_BEATS + 1)
        for number, (dance, start) in enumerate(zip(dances, starts)):
            around = int(start[beat]) + torch.arange(-PAST_BEATS, FUTURE_BEATS + 1)
            there = (around >= 0) & (around < len(dance.music))
            music[number, there], heard[number, there] = dance.music[around[there]], 1.0
        if model.config.head == "codes":
            noise = -torch.log(-torch.log(torch.rand(count, CODES, generator=rng).clamp(1e-9, 1 - 1e-7)))
        else:
            noise = torch.randn(count, CODES, generator=rng)
        window = slice(beat, beat + PAST_POSES)
        pose = model(
            poses[:, window], known[:, window], music, heard, torch.zeros(count, ROTATION_SIZE), -torch.ones(count),
            torch.zeros(count, len(STYLES)), torch.ones(count), noise,
        )[0]  # fmt: skip
        poses[:, PAST_POSES + beat], known[:, PAST_POSES + beat] = pose, 1
    return poses[:, PAST_POSES:]


def join(poses: Tensor, frames: Tensor) -> Tensor:
    """Key poses [M, 147] at frames [M] from 0 on -> motion [N, 147] by the cubic."""
    root = torch.stack([torch.from_numpy(_straight(frames, poses[:, ROTATION_SIZE + axis])) for axis in range(3)], 1)
    return with_path(cubic_rotations(matrices_of(poses), frames, int(frames[-1]) + 1), root)


def _straight(frames: Tensor, values: Tensor) -> np.ndarray:


    return np.interp(np.arange(int(frames[-1]) + 1), frames.numpy(), values.numpy()).astype("float32")


def compare(made: Tensor, dances: list[Dance], starts: list[Tensor]) -> dict[str, float]:
    """Measures of joined dances against the real ones."""
    ours, theirs, consistency = [], [], []
    for poses, dance, start in zip(made, dances, starts):
        frames = dance.beats[start].round().long()
        ours.append(join(poses, frames - frames[0]))
        theirs.append(dance.clip.motion[frames[0] : frames[-1] + 1])
        consistency.append([beat_consistency(motion_beats(m), (dance.beats[start] - frames[0])) for m in (ours[-1], theirs[-1])])
    both = torch.tensor(consistency).mean(0)
    shortest = min(len(m) for m in ours)
    variance = [position_variance([joints(m[:shortest]) for m in motions]) * 1e4 for motions in (ours, theirs)]
    return {
        "NPSS": sum(npss(real, mine) for mine, real in zip(ours, theirs)) / len(ours),
        "PFD": frechet_distance(*(torch.cat([pose_vectors(m) for m in motions]) for motions in (theirs, ours))) * 1e4,
        "VFD": frechet_distance(*(torch.cat([velocity_vectors(m) for m in motions]) for motions in (theirs, ours))),
        "PVar": variance[0],
        "PVar_real": variance[1],
        "BC": float(both[0]),
        "BC_real": float(both[1]),
    }


def stage1(training: list[Dance], held: list[Dance], steps: int) -> Iterator[dict]:
    """A row for each variant."""
    dances, starts = [], []
    for dance in held:
        inside = torch.nonzero((dance.beats >= 0) & (dance.beats <= dance.clip.frames - 1))[:, 0]
        if len(inside) >= BEATS:
            dances.append(dance)
            starts.append(inside[:BEATS])
    codes = None
    JointFc.momentum = 0.2  # a short run's statistics must be its own
    for name, changes in STAGE1.items():
        settings = {key: value for key, value in changes.items() if key != "adversarial"}
        losses = LossConfig(adversarial=changes.get("adversarial", 0.0))
        trainer = Trainer(Settings(stage="suggest", steps=steps, rows=8, beats=BEATS, width=32, lr=2e-3, warmup=10, ema=0.9, **settings), losses, training, held, codes)
        codes = trainer.codes
        began, sums, critic = time.process_time(), {}, []
        while not trainer.done():
            terms = trainer.step()
            if "critic" in terms:
                critic.append(terms["critic"])
        sums = trainer.measure()
        row = {"variant": name, "codes": sums.get("codes"), "position_cm": sums["position"] * 100} | compare(roll_out(trainer.averaged.eval(), dances, starts), dances, starts)
        row |= {"critic": critic[-1] if critic else None, "critic_first": critic[0] if critic else None, "cpu_seconds": time.process_time() - began}
        yield {key: round(value, 4) if isinstance(value, float) else value for key, value in row.items()}


def stage2(training: list[Dance], held: list[Dance], trunk: str, shipped: Path | None) -> Iterator[dict]:
    """On the real key poses of the development songs: SLERP, the in-betweener alone, and a trained checkpoint."""
    variants = {"SLERP": "", "in-betweener alone": trunk} | ({"in-betweener + DanTrans (checkpoint)": trunk} if shipped else {})
    for name, base in variants.items():
        trainer = Trainer(Settings(stage="curves", steps=1, rows=4, width=32, dropout=0.0, trunk=base), LossConfig(), training, held)
        if "checkpoint" in name:
            trainer.averaged.load_state_dict(torch.load(shipped, weights_only=True, map_location="cpu")["averaged"])
        terms = trainer.measure()
        yield {"variant": name, "position_cm": round(terms["position"] * 100, 3), "velocity": round(terms["velocity"], 4), "speed": round(terms["speed"], 5), "path": round(terms["path"], 4)}


def markdown(result: dict) -> str:
    """Both tables."""
    show = lambda value: "-" if value is None else f"{value:.3g}"  # noqa: E731
    head = ["stage 1", "codes, nats", "position, cm", "NPSS", "PFD, cm2", "VFD, m2/s2", "PVar, cm2", "BC", "critic's loss, first to last"]
    lines = [
        [r["variant"], *(show(r[k]) for k in ("codes", "position_cm", "NPSS", "PFD", "VFD", "PVar", "BC")), f"{r['critic_first']:.2f} to {r['critic']:.2f}" if r["critic"] is not None else "-"]
        for r in result["stage1"]
    ]
    real = result["stage1"][0] if result["stage1"] else {"PVar_real": None, "BC_real": None}
    lines.append(["real dance", "-", "-", "0", "0", "0", show(real["PVar_real"]), show(real["BC_real"]), "-"])
    parts = [f"## Ablations, {result['steps']} steps each, development songs\n\n    {result['command']}", __doc__.split("\n\n")[2], grid(head, lines)]
    head = ["stage 2", "position, cm", "velocity, m/s", "amount of motion, (m/s)2", "path"]
    if result["stage2"]:
        parts.append(grid(head, [[r["variant"], *(show(r[k]) for k in ("position_cm", "velocity", "speed", "path"))] for r in result["stage2"]]))
    return "\n\n".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--features", required=True)
    parser.add_argument("--song-features", type=Path, required=True)
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"))
    parser.add_argument("--trunk", default="", help="checkpoint of train_inbetween.py")
    parser.add_argument("--steps", type=int, default=60)
    parser.add_argument("--curves", type=Path, help="checkpoint of stage 2 to compare")
    parser.add_argument("--out", type=Path, required=True, help="path without extension")
    args = parser.parse_args()
    torch.set_num_threads(1)
    training, held, _ = split_dances(load_dances(args.data, args.song_features, load_clips(args.data, args.features, args.cache)))
    private = {str(args.data): "DATA", args.features: "FEATURES15", str(args.song_features): "FEATURES53", args.cache: "CACHE"}
    command = " ".join(["python export/ablate_danceformer.py", *(private.get(word, word) for word in sys.argv[1:])])
    args.out.parent.mkdir(parents=True, exist_ok=True)
    result: dict = {"command": command, "steps": args.steps, "stage1": [], "stage2": []}
    for part, rows in (("stage2", stage2(training, held, args.trunk, args.curves)), ("stage1", stage1(training, held, args.steps))):
        for row in rows:  # written after every variant, so that a run cut short leaves what it found
            print(json.dumps(row), flush=True)
            result[part].append(row)
            result["markdown"] = markdown(result)
            args.out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
