"""Shared helpers: made-up clips on disk and in memory. No test needs the data folder."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch

from data import Clip
from samples import synthetic_motion
from spec import FEATURE_COUNT, JOINT_COUNT

torch.set_num_threads(2)


def make_clip(frames: int = 200, seed: int = 0, split: str = "train") -> Clip:
    rng = torch.Generator().manual_seed(seed)
    return Clip(
        name=f"made_{seed}",
        source="aist",
        split=split,
        motion=synthetic_motion(frames, rng),
        valid=torch.ones(frames, JOINT_COUNT, dtype=torch.bool),
        root_valid=torch.ones(frames, dtype=torch.bool),
        music=torch.rand(frames, FEATURE_COUNT, generator=rng),
        beats=torch.arange(0, frames, 15).float(),
        downbeats=torch.arange(0, frames, 60).float(),
    )


@pytest.fixture
def clip() -> Clip:
    return make_clip()


@pytest.fixture
def prepared_folder(tmp_path: Path) -> Path:
    """A prepared data folder with one clip of each source, written as the data's README describes it."""
    rng = np.random.default_rng(0)
    frames = 120

    def motion(scale: float) -> dict:
        poses = (rng.standard_normal((1, JOINT_COUNT, 3)) * scale * np.linspace(0, 1, frames)[:, None, None]).astype(np.float32)
        trans = np.zeros((frames, 3), np.float32)
        trans[:, 1] = 0.9
        return {"poses": poses, "trans": trans, "fps": np.int32(30), "valid": np.ones((frames, JOINT_COUNT), bool)}

    chroma = np.abs(rng.standard_normal((frames, 12))) + 0.1
    grid = np.zeros(frames, np.float32)
    grid[[1, 16, 31]] = 1
    phase = np.zeros(frames, np.float32)
    phase[1] = 1
    onset = np.zeros(frames, np.float32)
    onset[11] = 20
    aist = motion(0.2) | {
        "chroma": chroma.astype(np.float16),
        "onset": onset,
        "bpm": np.float32(120),
        "music": "mHO2",
        "beat_grid": grid,
        "beat_phase_downbeat": phase,
    }
    partial = motion(0.2) | {"trans_valid": np.arange(frames) > 10}
    partial["valid"][:20, 18] = False
    tang = motion(0.3) | {"audio_start_s": np.float32(1.0), "beat_times_s": np.array([0.5, 1.0], np.float32)}
    files = {"aist/a.npz": aist, "aist_partial/p.npz": partial, "cmu/c.npz": motion(0.1), "tang/t.npz": tang}
    for name, arrays in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        np.savez(tmp_path / name, **arrays)
    manifest = [{"file": name, "split": "val" if name.startswith("tang") else "train"} for name in files]
    (tmp_path / "manifest.json").write_text(json.dumps(manifest))
    return tmp_path
