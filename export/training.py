"""What both trainers share: flags from dataclasses, the warm-up and cosine rate, averaged weights, whole checkpoints."""

from __future__ import annotations

import argparse
import math
from dataclasses import asdict
from pathlib import Path

import torch
from torch import nn


def parse_flags(description: str | None, *defaults) -> tuple[argparse.Namespace, list]:
    """Reads the command line: data, cache, output and threads, and a flag for every field of the dataclasses `defaults`.

    Returns the arguments and the dataclasses filled with them.
    """
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", required=True, help="prepared data folder, or AIST++ as downloaded")
    parser.add_argument("--features", help="folder with what export/features.ts wrote for the songs")
    parser.add_argument("--cache", default=str(Path(__file__).parent / "cache"), help="where preprocessed clips are kept")
    parser.add_argument("--out", required=True, help="folder for checkpoint and log")
    parser.add_argument("--threads", type=int, default=0, help="CPU threads (0: torch decides)")
    for default in defaults:
        for name, value in asdict(default).items():
            flag = "--" + name.replace("_", "-")
            if isinstance(value, bool):
                parser.add_argument(flag, action="store_true", default=value)
            elif isinstance(value, tuple):
                parser.add_argument(flag, type=type(value[0]) if value else float, nargs="+", default=value)
            else:
                parser.add_argument(flag, type=type(value), default=value)
    args = parser.parse_args()
    return args, [type(default)(**{name: _plain(getattr(args, name)) for name in asdict(default)}) for default in defaults]


def _plain(value):
    return tuple(value) if isinstance(value, list) else value


def cosine_rate(rate: float, step: int, warmup: int, progress: float) -> float:
    """Learning rate after `step` steps: linear warm-up, then half a cosine down to 1 % at progress 1."""
    return rate * min(1.0, (step + 1) / warmup) * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * progress)))


@torch.no_grad()
def follow(averaged: nn.Module, model: nn.Module, ema: float, step: int) -> None:
    """Moves averaged weights towards the model's after its `step`-th step."""
    # A young average must forget the initial weights quickly.
    decay = min(ema, (1 + step) / (10 + step))
    torch._foreach_lerp_(list(averaged.parameters()), list(model.parameters()), 1 - decay)


def save_whole(state: dict, path: Path) -> None:
    """Writes a checkpoint; the old file stays until the new one is whole."""
    torch.save(state, path.with_suffix(".tmp"))
    path.with_suffix(".tmp").replace(path)
