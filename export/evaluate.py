"""Measures a model on the validation clips: paper A's tables and figures, what those cannot tell, paper B's measures, the bars.

    python export/evaluate.py --data DATA --features FEATURES --onnx public/models/light.onnx --out export/results/light

Writes OUT.json and OUT.md. --checkpoint FILE measures a training run instead of a shipped file.

Key poses are the real poses at frames 0, s, 2s ... after the first 2 s of a clip, which are the seed. Errors are taken on the frames
between keys, root-aligned. All measures are taken on the same pieces of at most 8 s, and are means weighted by frames.
Dances: `real`; `slerp`, `cubic`, `nearest neighbour` through the same keys, put on the real path over the floor (they have none of
their own); `model`: each window seeded by real dance; `rollout`: each seeded by the output before it.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import torch

from baselines import NearestNeighbour
from data import Clip, load_clips
from evaluation import tables
from evaluation.runners import onnx_runner, torch_runner
from evaluation.table import core_table


def choose_clips(clips: list[Clip], split: str, limit: int) -> list[Clip]:
    """The clips of a split; with a limit that many, spread evenly over them."""
    chosen = [clip for clip in clips if clip.split == split]
    return chosen if limit <= 0 or limit >= len(chosen) else [chosen[i * len(chosen) // limit] for i in range(limit)]


def markdown(result: dict) -> str:
    """All of the result that is text."""
    about = result["about"]
    parts = [
        f"# {about['model']}: {about['clips']} clips of `{about['split']}`, {about['minutes']} min",
        "## Every dance\n\n" + tables.core(result["table"]),
        "## Error against the distance to the nearest key pose (frames): position, cm (rotation, degrees)\n\n"
        + tables.by_distance(result["table"]),
        "## Beat hit rate, % (paper A, Table 5), keys every 1 s\n\n" + tables.paper_a(result["table"]),
    ]
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
    parser.add_argument("--threads", type=int, default=1, help="CPU threads")
    parser.add_argument("--out", type=Path, required=True, help="path without extension; .json and .md are written")
    args = parser.parse_args()

    started = time.monotonic()
    torch.set_num_threads(args.threads)
    everything = load_clips(args.data, args.features, args.cache)
    clips = choose_clips(everything, args.split, args.limit)
    run = torch_runner(args.checkpoint) if args.checkpoint else onnx_runner(args.onnx, args.threads)
    # A training clip would find itself.
    nearest = NearestNeighbour([clip for clip in everything if clip.split == "train"]) if args.split == "val" else None
    result = {
        "about": {
            "model": (args.checkpoint or args.onnx).name,
            "split": args.split,
            "clips": len(clips),
            "minutes": round(sum(clip.frames for clip in clips) / 1800, 2),
        },
        "table": core_table(clips, run, tuple(args.spacings), nearest),
    }
    result["about"]["seconds"] = round(time.monotonic() - started)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.with_suffix(".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    text = markdown(result)
    args.out.with_suffix(".md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
