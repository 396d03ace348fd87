"""Ablations after paper B's Tables 2 and 3, each variant with the same few steps:

    python export/ablate_danceformer.py --data DATA --features FEATURES15 --song-features FEATURES53 --steps 60 --out export/results/danceformer-ablations

Stage 1 is trained anew for every variant (rows of 16 beats, 8 rows a step) and then dances the development songs (training songs that are
held out; the validation tracks are not touched) from nothing; its key poses are joined by the same cubic for all, so that only stage 1
differs. `codes` is the cross-entropy of the pose codes on those songs, `position` the error of the pose regressed from the right code.
"Curve to frame" has no second stage: a plain transformer (linear body) makes three poses a beat straight from the music, and is trained and
rolled out on that grid; the clips without music, which have no beats to divide, are left out of its training.
Stage 2 is trained anew without the in-betweener (40 intervals a step) and compared on the real key poses of the development songs, as are
SLERP, the in-betweener alone and a trained checkpoint; the in-betweener has seen these songs in its own training, the variants have not.
With so few steps the order of near neighbours is chance.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from baselines import cubic_rotations, with_path
from dance_metrics import beat_consistency, frechet_distance, npss, pose_vectors, position_variance, velocity_vectors
from danceformer_data import Dance, beat_music, load_dances, split_dances
from danceformer_loss import LossConfig
from dantrans import JointFc
from data import data_hash, load_clips
from evaluation.tables import grid
from metrics import joints, matrices_of, motion_beats
from record import git_commit
from spec import FPS, MOTION_SIZE, ROTATION_SIZE
from suggest import BEAT_SIZE, CODES, FUTURE_BEATS, PAST_BEATS, PAST_POSES, STYLES, Suggester
from train_danceformer import Settings, Trainer

STAGE1 = {
    "DanTrans (KPM, learned local mask, pose codes)": {},
    "curve to frame (three poses a beat, linear)": {"fine": 3, "body": "linear"},
    "KPM to linear": {"body": "linear"},
    "KPM to GNN": {"body": "gnn"},
    "global attention": {"attention": "global"},
    "local attention": {"attention": "local"},
    "Gaussian local attention": {"attention": "gaussian"},
    "pose codes + adversarial": {"adversarial": 0.1},
    "regression with noise, no codes": {"head": "regress"},
    "regression with noise + adversarial": {"head": "regress", "adversarial": 0.1},
}
STAGE2 = {
    "DanTrans, curves": {},
    "frames instead of curves": {"frames": True},
    "KPM to linear": {"body": "linear"},
    "KPM to GNN": {"body": "gnn"},
    "curves + adversarial": {"adversarial": 0.1},
}
BEATS = 16
AVERAGE = 0.96  # of the weights: a short run has no time for a long one


@torch.no_grad()
def roll_out(model: Suggester, dances: list[Dance], starts: list[Tensor], seed: int = 0) -> Tensor:
    """Suggested poses [B, beats, 147] on the beats `starts` of each dance, all dances side by side."""
    rng = torch.Generator().manual_seed(seed)
    count, beats = len(dances), len(starts[0])
    poses, known = torch.zeros(count, PAST_POSES + beats, MOTION_SIZE), torch.zeros(count, PAST_POSES + beats)
    for beat in range(beats):
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


def finer(dance: Dance, parts: int) -> Dance:
    """The dance with every beat cut into `parts`, and the music around each of the moments; places in the bar are left out."""
    whole = torch.arange((len(dance.beats) - 1) * parts + 1)
    low = (whole // parts).clamp(max=len(dance.beats) - 2)
    times = torch.lerp(dance.beats[low], dance.beats[low + 1], (whole - low * parts) / parts)
    music = beat_music(dance.frames.numpy(), (times + dance.start).double().numpy() / FPS, np.full(len(times), np.nan))
    return replace(dance, beats=times, music=torch.from_numpy(music))


def compare(made: Tensor, dances: list[Dance], starts: list[Tensor], at: list[Tensor]) -> dict[str, float]:
    """Measures of joined dances against the real ones. `at`: the frames of the poses of each; `starts`: the beats."""
    ours, theirs, consistency = [], [], []
    for poses, dance, start, frames in zip(made, dances, starts, at):
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
    coarse = None
    JointFc.momentum = 0.2  # a short run's statistics must be its own
    for name, changes in STAGE1.items():
        parts = changes.get("fine", 1)
        settings = {key: value for key, value in changes.items() if key not in ("adversarial", "fine")}
        losses = LossConfig(adversarial=changes.get("adversarial", 0.0))
        learn, judge, on = (training, held, dances) if parts == 1 else ([finer(d, parts) for d in some if d.has_music and len(d.beats) > 1] for some in (training, held, dances))
        grids = [start[0] * parts + torch.arange((BEATS - 1) * parts + 1) for start in starts]
        codes = coarse if parts == 1 else None  # poses a third of a beat apart take other steps
        settings = Settings(stage="suggest", steps=steps, rows=8, beats=BEATS, width=32, lr=2e-3, warmup=10, ema=AVERAGE, **settings)
        trainer = Trainer(settings, losses, learn, judge, codes)
        coarse = trainer.codes if parts == 1 else coarse
        began, critic = time.process_time(), run(trainer)
        spent = time.process_time() - began
        terms = trainer.measure()
        made = roll_out(trainer.averaged.eval(), on, grids)
        row = {"variant": name, "codes": terms.get("codes"), "position_cm": terms["position"] * 100}
        row |= compare(made, dances, starts, [dance.beats[some].round().long() for dance, some in zip(on, grids)])
        yield rounded(row | {"critic": critic, "cpu_seconds": spent})


def run(trainer: Trainer) -> list[float] | None:
    """Trains to the end -> the critic's first and last loss, if there is one."""
    critic = []
    while not trainer.done():
        terms = trainer.step()
        critic += [terms["critic"]] if "critic" in terms else []
    return [critic[0], sum(critic[-10:]) / len(critic[-10:])] if critic else None


def rounded(row: dict) -> dict:
    """Four digits after the point."""
    short = lambda value: round(value, 4) if isinstance(value, float) else value  # noqa: E731
    return {key: [short(v) for v in value] if isinstance(value, list) else short(value) for key, value in row.items()}


def stage2(training: list[Dance], held: list[Dance], steps: int, trunk: str, shipped: Path | None) -> Iterator[dict]:
    """On the real key poses of the development songs: SLERP, variants trained anew, the in-betweener alone, and a trained checkpoint."""
    fixed = {"SLERP": ""} | ({"in-betweener alone": trunk} if trunk else {}) | ({"in-betweener + DanTrans (checkpoint)": trunk} if shipped else {})
    for name in (*fixed, *STAGE2):
        changes = STAGE2.get(name, {"trunk": fixed.get(name, "")})
        settings = {key: value for key, value in changes.items() if key != "adversarial"}
        losses = LossConfig(adversarial=changes.get("adversarial", 0.0))
        trainer = Trainer(Settings(stage="curves", steps=steps, rows=10, width=32, lr=2e-3, warmup=10, ema=AVERAGE, dropout=0.0, **settings), losses, training, held)
        began, critic = time.process_time(), None
        if "checkpoint" in name:
            trainer.averaged.load_state_dict(torch.load(shipped, weights_only=True, map_location="cpu")["averaged"])
        elif name in STAGE2:
            critic = run(trainer)
        spent = time.process_time() - began
        terms = trainer.measure()
        yield rounded(
            {"variant": name, "position_cm": terms["position"] * 100, "velocity": terms["velocity"], "speed": terms["speed"], "path": terms["path"], "critic": critic, "cpu_seconds": spent}
        )


def markdown(result: dict) -> str:
    """Both tables."""
    show = lambda value: "-" if value is None else f"{value:.3g}"  # noqa: E731
    losses = lambda r: "{:.2f} to {:.2f}".format(*r["critic"]) if r["critic"] else "-"  # noqa: E731
    head = ["stage 1", "codes, nats", "position, cm", "NPSS", "PFD, cm2", "VFD, m2/s2", "PVar, cm2", "BC", "critic's loss, first to last ten"]
    lines = [
        [r["variant"], *(show(r[k]) for k in ("codes", "position_cm", "NPSS", "PFD", "VFD", "PVar", "BC")), losses(r)]
        for r in result["stage1"]
    ]
    real = result["stage1"][0] if result["stage1"] else {"PVar_real": None, "BC_real": None}
    lines.append(["real dance", "-", "-", "0", "0", "0", show(real["PVar_real"]), show(real["BC_real"]), "-"])
    parts = [f"## Ablations, {result['steps']} steps each, development songs\n\n    {result['command']}", __doc__.split("\n\n")[2], grid(head, lines)]
    head = ["stage 2", "position, cm", "velocity, m/s", "amount of motion, (m/s)2", "path", "critic's loss, first to last ten"]
    if result["stage2"]:
        parts.append(grid(head, [[r["variant"], *(show(r[k]) for k in ("position_cm", "velocity", "speed", "path")), losses(r)] for r in result["stage2"]]))
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
    result: dict = {"command": command, "steps": args.steps, "data_hash": data_hash(args.data, Path(args.features)), "git_commit": git_commit(), "stage1": [], "stage2": []}
    for part, rows in (("stage2", stage2(training, held, args.steps, args.trunk, args.curves)), ("stage1", stage1(training, held, args.steps))):
        for row in rows:  # written after every variant, so that a run cut short leaves what it found
            print(json.dumps(row), flush=True)
            result[part].append(row)
            result["markdown"] = markdown(result)
            args.out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
