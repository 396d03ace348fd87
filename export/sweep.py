"""Trains and measures many small runs with one budget each: paper A's lambda x sigma sweep, and ablations.

    python export/sweep.py sweep --data DATA --features FEATURES --runs export/runs/sweep --out export/results/sweep \\
        --minutes 6 -- TRAIN FLAGS
    python export/sweep.py ablate --data DATA --features FEATURES --runs export/runs/ablate --out export/results/ablations \\
        --minutes 6 -- TRAIN FLAGS

`ablate --trainer train_inbetween.py` does it for the in-betweener, which is then measured alone.
Flags after `--` go to every run (sizes, schedule, threads ...). Stopped half-way it goes on where it was: runs that are done
are skipped, and the tables are written again after each run. Runs live in --runs; --out gets .json, .md and, of the sweep, .png.
The measures are those of evaluate.py for the network alone (no page), on the validation clips.
"""

from __future__ import annotations

import argparse
import json
import shlex
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import torch

from data import Clip, load_clips
from evaluation.runners import torch_runner
from evaluation.table import core_table
from evaluation.tables import grid, number
from evaluation.tally import COLUMNS

HERE = Path(__file__).parent
LAMBDAS = (0.0, 1.0, 3.0, 5.0)
SIGMAS = (0.05, 0.1, 0.2)
# What each variation changes against the flags that all runs share, by trainer.
DANCER = {
    "all of it": [],
    "SLERP as the base": ["--inbetweener", ""],
    "a token a frame": ["--patch", "1"],
    "the large model": ["--model", "large"],
    "no mirror": ["--mirror", "0"],
    "no change of tempo": ["--tempo", "1", "1"],
    "no music dropout": ["--music-dropout", "0"],
    "no noise on the seed": ["--seed-noise", "0"],
    "keys evenly spaced only": ["--random-keys", "0", "--few-keys", "0", "--no-keys", "0", "--beat-keys", "0"],
    "no velocity loss": ["--velocity", "0"],
    "no amount-of-motion loss": ["--speed", "0"],
    "no contact loss": ["--foot", "0"],
    "no position loss": ["--position", "0"],
    "eq. 14 alone": ["--position", "0", "--velocity", "0", "--speed", "0", "--foot", "0"],
    "eq. 15 as printed": ["--literal-sum"],
}
INBETWEENER = {
    "all of it": [],
    "no mirror": ["--mirror", "0"],
    "no change of tempo": ["--tempo", "1", "1"],
    "no noise on the inputs": ["--noise", "0"],
    "no velocity loss": ["--velocity", "0"],
    "no amount-of-motion loss": ["--speed", "0"],
    "no position loss": ["--position", "0"],
    "no rotation loss": ["--rotation", "0"],
    "every frame equally often": ["--aist", "1"],
    "no weight decay": ["--weight-decay", "0"],
}
ABLATIONS: dict[str, dict[str, list[str]]] = {"train.py": DANCER, "train_inbetween.py": INBETWEENER}
# Columns of the evaluation's table that the ablations show.
SHOWN = {"position_cm", "rotation_deg", "E_c", "S_cv", "speed_ratio", "jerk_ratio", "skate_ratio", "hit3", "NPSS", "PFD"}
MEASURES = tuple((name, f"beat hit {title}" if name == "hit3" else title) for name, title in COLUMNS if name in SHOWN)


@dataclass
class Run:
    """One training: a name that is a folder too, and its own flags."""

    name: str
    flags: list[str]


def sweep_runs() -> list[Run]:
    """Paper A's twelve."""
    return [Run(f"lambda-{lam:g}-sigma-{sigma:g}", ["--lam", f"{lam:g}", "--sigma", f"{sigma:g}"]) for sigma in SIGMAS for lam in LAMBDAS]


def known_flags(trainer: str) -> set[str]:
    """Flags that a trainer accepts."""
    done = subprocess.run([sys.executable, str(HERE / trainer), "--help"], capture_output=True, text=True, check=True)
    return {word.strip("[],") for word in done.stdout.split() if word.lstrip("[").startswith("--")}


def ablation_runs(trainer: str, names: list[str], flags: set[str]) -> list[Run]:
    """The named variations (all without names). Those that need a flag the trainer has not are left out with a word."""
    variations = ABLATIONS[trainer]
    unknown = [name for name in names if name not in variations]
    if unknown:
        raise ValueError(f"no ablation named {', '.join(unknown)}: choose from {', '.join(variations)}")
    runs = []
    for name in names or variations:
        missing = [flag for flag in variations[name] if flag.startswith("--") and flag not in flags]
        if missing:
            print(f"left out: {name!r}, {trainer} has no {', '.join(missing)}")
        else:
            runs.append(Run(name, variations[name]))
    return runs


def train_and_measure(
    trainer: str, run: Run, folder: Path, arguments: list[str], shared: list[str], measure: Callable[[Path], dict]
) -> dict:
    """Trains one run unless it is done -> {trainer, flags, shared, steps, seconds, rows}.

    Raises ValueError when the folder holds a run of other flags.
    """
    done = folder / "measured.json"
    asked = {"trainer": trainer, "flags": run.flags, "shared": shared}
    if (folder / "asked.json").exists():
        before = json.loads((folder / "asked.json").read_text(encoding="utf-8"))
        if before != asked:
            raise ValueError(f"{folder} holds a run with {before}, not {asked}: choose another --runs or remove it")
    if done.exists():
        return json.loads(done.read_text(encoding="utf-8"))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "asked.json").write_text(json.dumps(asked), encoding="utf-8")
    subprocess.run([sys.executable, str(HERE / trainer), *arguments, "--out", str(folder), *shared, *run.flags], check=True)
    log = [json.loads(line) for line in (folder / "log.jsonl").read_text(encoding="utf-8").splitlines()]
    entry = asked | {"steps": log[-1]["step"], "seconds": log[-1]["seconds"], "rows": measure(folder / "checkpoint.pt")}
    done.write_text(json.dumps(entry), encoding="utf-8")
    return entry


def measurer(clips: list[Clip], spacings: tuple[float, ...]) -> Callable[[Path], dict]:
    """Measures a checkpoint -> {spacing: {dance: row}} over all clips."""

    def measure(checkpoint: Path) -> dict:
        table = core_table(clips, torch_runner(checkpoint), spacings)
        return {seconds: groups["all"] for seconds, groups in table.items()}

    return measure


def paper_table(entries: dict[str, dict], measure: str, seconds: str, dance: str = "model") -> tuple[str, dict]:
    """Tables 1-4's form: sigma down, lambda across, means at the ends -> (Markdown, {line: {lambda: value}})."""

    def value(lam: float, sigma: float) -> float | None:
        entry = entries.get(f"lambda-{lam:g}-sigma-{sigma:g}")
        return entry["rows"][seconds][dance][measure] if entry else None

    def mean(values: list) -> float:
        known = [v for v in values if v is not None]
        return sum(known) / len(known) if known else float("nan")

    lines = {f"sigma {sigma:g}": {lam: value(lam, sigma) for lam in LAMBDAS} for sigma in SIGMAS}
    means = {lam: mean([line[lam] for line in lines.values()]) for lam in LAMBDAS}
    rows = [[name, *(number(v) for v in line.values()), number(mean(list(line.values())))] for name, line in lines.items()]
    rows.append(["mean", *(number(v) for v in means.values()), "-"])
    curves = {name: {lam: v for lam, v in line.items() if v is not None} for name, line in lines.items()}
    curves["mean"] = {lam: v for lam, v in means.items() if v == v}
    return grid(["", *(f"lambda {lam:g}" for lam in LAMBDAS), "mean"], rows), {name: line for name, line in curves.items() if line}


def budget(entries: dict[str, dict]) -> str:
    """What every run had."""
    steps = [entry["steps"] for entry in entries.values()]
    seconds = [entry["seconds"] for entry in entries.values()]
    first = next(iter(entries.values()))
    shared = first["shared"]
    return (
        f"{len(entries)} runs, each `{first['trainer']} {shlex.join(shared)}`: {min(steps)}-{max(steps)} steps, "
        f"{min(seconds) / 60:.1f}-{max(seconds) / 60:.1f} min of training. The network alone, each window seeded by real dance."
    )


def write_sweep(out: Path, entries: dict[str, dict], seconds: str) -> None:
    """Tables 1 and 2 (3 and 4 of a large model), what else moves with lambda, figures 5 and 6."""
    titles = {
        "E_c": "Consistency error E_c (Tables 1, 3)",
        "S_cv": "Smoothness S_cv (Tables 2, 4)",
        "S_cv_median": "S_cv, median over windows (its mean swings)",
        "jerk_ratio": "Jerk / real",
        "position_cm": "Position error, cm",
        "speed_ratio": "Speed / real",
    }
    made = {measure: paper_table(entries, measure, seconds) for measure in titles}
    parts = [f"# lambda x sigma, keys every {seconds} s", budget(entries)]
    parts += [f"## {titles[measure]}\n\n{table}" for measure, (table, _) in made.items()]
    out.with_suffix(".json").write_text(json.dumps({"keys every": seconds, "runs": entries}, indent=1) + "\n", encoding="utf-8")
    try:
        import plots

        shown = {"E_c": "E_c (Figure 5)", "S_cv": "S_cv (Figure 6)", "jerk_ratio": "jerk / real"}
        plots.over_lambda(out.with_suffix(".png"), {title: made[measure][1] for measure, title in shown.items()})
        parts.append(f"## Figures 5 and 6\n\n![E_c, S_cv and jerk over lambda]({out.stem}.png)")
    except ImportError:
        print("no picture: pip install -r export/requirements-evaluate.txt")
    out.with_suffix(".md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def write_ablations(out: Path, entries: dict[str, dict], _seconds: str) -> None:
    """One row a variation and spacing, baselines first."""
    rows = []
    for seconds, first in next(iter(entries.values()))["rows"].items():
        rows += [[f"{seconds} s", kind, "", *(number(first[kind][name]) for name, _ in MEASURES)] for kind in ("real", "slerp")]
        for variation, entry in entries.items():
            values = entry["rows"][seconds]["model"]
            rows.append([f"{seconds} s", variation, shlex.join(entry["flags"]), *(number(values[name]) for name, _ in MEASURES)])
    table = grid(["keys every", "run", "flags", *(title for _, title in MEASURES)], rows)
    out.with_suffix(".json").write_text(json.dumps({"runs": entries}, indent=1) + "\n", encoding="utf-8")
    out.with_suffix(".md").write_text(f"# Ablations\n\n{budget(entries)}\n\n{table}\n", encoding="utf-8")


def main(words: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("sweep", "ablate"))
    parser.add_argument("--data", required=True)
    parser.add_argument("--features")
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"))
    parser.add_argument("--runs", type=Path, required=True, help="folder of the training runs")
    parser.add_argument("--out", type=Path, required=True, help="path without extension")
    much = parser.add_mutually_exclusive_group(required=True)
    much.add_argument("--minutes", type=float, help="of training for each run")
    much.add_argument("--steps", type=int, help="of each run")
    parser.add_argument("--spacings", type=float, nargs="+", default=(1.0, 2.0))
    parser.add_argument("--only", nargs="+", default=[], help="names of ablations")
    parser.add_argument("--trainer", choices=tuple(ABLATIONS), default="train.py", help="of the ablations")
    parser.add_argument("--threads", type=int, default=1, help="CPU threads of the measuring")
    words = sys.argv[1:] if words is None else words
    at = words.index("--") if "--" in words else len(words)
    args, train_flags = parser.parse_args(words[:at]), words[at + 1 :]

    torch.set_num_threads(args.threads)
    trainer = "train.py" if args.what == "sweep" else args.trainer
    runs = sweep_runs() if args.what == "sweep" else ablation_runs(trainer, args.only, known_flags(trainer))
    write = write_sweep if args.what == "sweep" else write_ablations
    arguments = ["--data", args.data, "--cache", args.cache, *(["--features", args.features] if args.features else [])]
    shared = ["--minutes", f"{args.minutes:g}"] if args.minutes else ["--steps", str(args.steps)]
    clips = [clip for clip in load_clips(args.data, args.features, args.cache) if clip.split == "val"]
    measure = measurer(clips, tuple(args.spacings))
    args.out.parent.mkdir(parents=True, exist_ok=True)
    entries: dict[str, dict] = {}
    for run in runs:
        folder = args.runs / run.name.replace(" ", "-")
        entries[run.name] = train_and_measure(trainer, run, folder, arguments, [*shared, *train_flags], measure)
        write(args.out, entries, f"{args.spacings[0]:g}")
        print(f"{run.name}: done")


if __name__ == "__main__":
    main()
