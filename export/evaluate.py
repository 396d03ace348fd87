"""Measures a model on the validation clips: paper A's tables and figures, what those cannot tell, paper B's measures, the bars.

    python export/evaluate.py --data DATA --features FEATURES --onnx public/models/light.onnx --out export/results/light

Writes OUT.json, OUT.md and pictures in OUT/ (these need requirements-evaluate.txt). --checkpoint FILE measures a training run
instead of a shipped file; a checkpoint of train_inbetween.py is measured without a transformer.

Key poses are the real poses at frames 0, s, 2s ... after the first 2 s of a clip, which are the seed. Errors are taken on the frames
between keys, root-aligned. All measures are taken on the same pieces of at most 8 s, and are means weighted by frames.
Dances (rows): `real`; `slerp`, `cubic`, `nearest neighbour` through the same keys, put on the real path over the floor (they have none of
their own); `model`: each window seeded by real dance; `rollout`: each seeded by the output before it;
`shipped at strength 0 / 1`: the page's own code (export/finish.ts, needs Node) at the two ends of its key-strength dial, without
filler poses. The bars are told for strength 1 unless they say otherwise. Dances of 3 minutes without keys come with fillers
(as the page makes them) and without (the network alone).
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import torch
from torch import Tensor

from baselines import NearestNeighbour
from data import Clip, load_clips
from evaluation import bars, diversity, tables
from evaluation.dances import Task, make_task, rollout
from evaluation.endurance import endurance
from evaluation.runners import Run, onnx_runner, torch_runner
from evaluation.shipped import make_dances, order_of
from evaluation.table import core_table
from spec import FPS


def choose_clips(clips: list[Clip], split: str, limit: int) -> list[Clip]:
    """The clips of a split; with a limit that many, spread evenly over them."""
    chosen = [clip for clip in clips if clip.split == split]
    return chosen if limit <= 0 or limit >= len(chosen) else [chosen[i * len(chosen) // limit] for i in range(limit)]


def command(args: argparse.Namespace) -> str:
    """The command as anyone could give it: folders of this machine are named by what is in them."""
    private = {args.data: "DATA", args.features: "FEATURES", args.cache: "CACHE"}
    return " ".join(["python export/evaluate.py", *(private.get(word, word) for word in sys.argv[1:])])


def page_dances(model: Path, clips: list[Clip], spacings: tuple[float, ...]) -> Callable[[Task], dict[str, Tensor]]:
    """The page's dances of all tasks at these spacings, made at once because Node takes seconds to start."""
    tasks = [task for seconds in spacings for clip in clips if (task := make_task(clip, round(seconds * FPS)))]
    runs = {bars.LOOSE: {"keyStrength": 0.0}, bars.SHIPPED: {"keyStrength": 1.0}}
    made = make_dances(model, [order_of(task, runs) for task in tasks])
    known = {(task.clip.name, task.spacing): dances for task, dances in zip(tasks, made)}
    return lambda task: known.get((task.clip.name, task.spacing), {})


def draw(folder: Path, result: dict, clips: list[Clip], run: Run, extra: Callable[[Task], dict[str, Tensor]] | None) -> list[str]:
    """Writes the pictures -> their names; none, and a word about it, where matplotlib is missing."""
    try:
        import plots
    except ImportError:
        print("no pictures: pip install -r export/requirements-evaluate.txt")
        return []
    # The longest clip that has music.
    dancing = [task for clip in clips if len(clip.beats) and (task := make_task(clip, FPS))]
    task = max(dancing, key=lambda task: task.frames, default=None)
    dances = {}
    if task:
        dances = {"real": task.real, "rollout": rollout(task, run)}
        dances |= {name: dance for name, dance in (extra(task) if extra else {}).items() if name == bars.SHIPPED}
    return [path.name for path in plots.for_evaluation(folder, result["table"], task, dances)]


def markdown(result: dict) -> str:
    """All of the result that is text."""
    about = result["about"]
    parts = [
        f"# {about['model']}: {about['clips']} clips of `{about['split']}`, {about['minutes']} min",
        f"    {about['command']}",
        "## Bars\n\n" + bars.markdown(result["bars"]),
        "## Every dance\n\n" + tables.core(result["table"]),
        "## Error against the distance to the nearest key pose (frames): position, cm (rotation, degrees)\n\n"
        + tables.by_distance(result["table"]),
    ]
    if "1" in result["table"]:
        parts.append("## Beat hit rate, % (paper A, Table 5), keys every 1 s\n\n" + tables.paper_a(result["table"]))
    if "endurance" in result:
        parts.append("## Windows chained without keys\n\n" + tables.endurance(result["endurance"]))
    if "diversity" in result:
        title = "## Diversity: mean joint distance between dances to the same music and keys, cm"
        parts.append(f"{title}\n\n{tables.diversity(result['diversity'])}")
    if result["pictures"]:
        parts.append("## Pictures\n\n" + "\n\n".join(f"![{Path(path).stem}]({path})" for path in result["pictures"]))
    return "\n\n".join(parts) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", required=True, help="prepared data folder, or AIST++ as downloaded")
    parser.add_argument("--features", help="folder with what export/features.ts wrote for the songs")
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"))
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--checkpoint", type=Path)
    which.add_argument("--onnx", type=Path)
    parser.add_argument("--spacings", type=float, nargs="+", default=(0.5, 1.0, 2.0), help="seconds between key poses")
    parser.add_argument("--split", choices=("val", "train"), default="val")
    parser.add_argument("--limit", type=int, default=0, help="at most this many clips (0: all)")
    parser.add_argument("--page-spacings", type=float, nargs="*", default=(1.0, 2.0), help="those that the page's dances are made for")
    parser.add_argument("--no-page", action="store_true", help="leave out what needs Node")
    parser.add_argument("--no-long", action="store_true", help="leave out the long dances and the diversity")
    parser.add_argument("--threads", type=int, default=1, help="CPU threads")
    parser.add_argument("--out", type=Path, required=True, help="path without extension; .json and .md are written")
    args = parser.parse_args()

    started = time.monotonic()
    torch.set_num_threads(args.threads)
    everything = load_clips(args.data, args.features, args.cache)
    clips = choose_clips(everything, args.split, args.limit)
    run = torch_runner(args.checkpoint) if args.checkpoint else onnx_runner(args.onnx, args.threads)
    # A training clip would find itself.
    training = [clip for clip in everything if clip.split == "train"]
    nearest = NearestNeighbour(training) if args.split == "val" else None
    model = args.checkpoint or args.onnx
    page = None if args.no_page else model
    extra = page_dances(page, clips, tuple(args.page_spacings)) if page else None
    result: dict = {
        "about": {
            "model": model.name,
            "command": command(args),
            "split": args.split,
            "clips": len(clips),
            "minutes": round(sum(clip.frames for clip in clips) / 1800, 2),
        },
        "table": core_table(clips, run, tuple(args.spacings), nearest, extra),
    }
    if not args.no_long:
        result["endurance"] = endurance(clips, training, run, page)
        result["diversity"] = diversity.diversity(clips, run, page)
    result["bars"] = bars.bars(result["table"], result.get("endurance"))
    result["pictures"] = [f"{args.out.name}/{name}" for name in draw(args.out, result, clips, run, extra)]
    used = os.times()
    result["about"]["seconds"] = round(time.monotonic() - started)
    result["about"]["cpu_seconds"] = round(used.user + used.system + used.children_user + used.children_system)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    text = markdown(result)
    args.out.with_suffix(".md").write_text(text, encoding="utf-8")
    print(text)
    print(f"{result['about']['seconds']} s, {result['about']['cpu_seconds']} s of CPU")


if __name__ == "__main__":
    main()
