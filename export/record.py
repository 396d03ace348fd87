"""What is kept of every training run, so that it can be repeated."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import torch

from data import data_hash
from spec import spec_hash


def git_commit() -> str:
    """The commit that the code is at."""
    done = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, cwd=Path(__file__).parent, check=False)
    return done.stdout.strip() or "unknown"


def record_run(out: Path, data: str, features: str | None, weights: int, settings: dict) -> None:
    """Appends command, settings, data hash and commit to OUT/runs.jsonl."""
    entry = {
        "command": "python " + " ".join(sys.argv),
        **settings,
        "weights": weights,
        "spec_hash": spec_hash(),
        "data_hash": data_hash(Path(data), Path(features) if features else None),
        "git_commit": git_commit(),
        "torch": torch.__version__,
        "threads": torch.get_num_threads(),
        "started": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
    }
    with (out / "runs.jsonl").open("a", encoding="utf-8") as file:
        file.write(json.dumps(entry) + "\n")
