"""Sweep and ablations: which runs there are, that done ones are skipped, and the form of the tables."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import sweep


def entry(value: float, flags: list[str] | None = None) -> dict:
    row = {name: value for name, _ in sweep.MEASURES} | {"S_cv_median": value}
    return {"trainer": "train.py", "flags": flags or [], "shared": ["--steps", "9"], "steps": 9, "seconds": 60.0, "rows": {"1": {k: row for k in ("real", "slerp", "model")}}}


def test_the_sweep_is_the_papers():
    runs = sweep.sweep_runs()
    assert len(runs) == 12 and len({run.name for run in runs}) == 12
    assert runs[0].flags == ["--lam", "0", "--sigma", "0.05"] and runs[-1].flags == ["--lam", "5", "--sigma", "0.2"]


def test_tables_have_means_at_their_ends():
    entries = {f"lambda-{lam:g}-sigma-{sigma:g}": entry(lam + 10 * sigma) for lam in sweep.LAMBDAS for sigma in sweep.SIGMAS}
    table, curves = sweep.paper_table(entries, "E_c", "1")
    # sigma 0.1 is lambda + 1: 1, 2, 4, 6, mean 13 / 4; lambda 3 is 3.5, 4, 5, mean 12.5 / 3.
    assert "| sigma 0.1 | 1 | 2 | 4 | 6 | 3.25 |" in table
    assert curves["mean"][3.0] == pytest.approx(12.5 / 3) and list(curves) == ["sigma 0.05", "sigma 0.1", "sigma 0.2", "mean"]
    # Half-way through the sweep the rest is empty.
    table, curves = sweep.paper_table({"lambda-1-sigma-0.1": entry(2.0)}, "E_c", "1")
    assert "| sigma 0.1 | - | 2 | - | - | 2 |" in table and curves["sigma 0.1"] == {1.0: 2.0}


def test_files_of_a_sweep(tmp_path: Path):
    entries = {run.name: entry(1.5, run.flags) for run in sweep.sweep_runs()}
    sweep.write_sweep(tmp_path / "sweep", entries, "1")
    text = (tmp_path / "sweep.md").read_text()
    assert "12 runs" in text and "9-9 steps" in text and "Tables 1, 3" in text
    assert len(json.loads((tmp_path / "sweep.json").read_text())["runs"]) == 12


def test_unknown_ablations_and_flags(capsys: pytest.CaptureFixture):
    with pytest.raises(ValueError, match="no ablation named 'nonsense'|no ablation named nonsense"):
        sweep.ablation_runs("train.py", ["nonsense"], set())
    runs = sweep.ablation_runs("train.py", ["all of it", "no mirror", "no velocity loss"], {"--velocity"})
    assert [run.name for run in runs] == ["all of it", "no velocity loss"]
    assert "'no mirror'" in capsys.readouterr().out


def test_a_run_is_trained_measured_and_then_skipped(tmp_path: Path, prepared_folder: Path):
    # The trainer validates on whole windows: the validation clip has to be longer than one.
    clip = prepared_folder / "tang" / "t.npz"
    short = dict(np.load(clip))
    frames = {name: np.tile(short[name], (3, *[1] * (short[name].ndim - 1))) for name in ("poses", "trans", "valid")}
    np.savez(clip, **(short | frames))
    words = ["ablate", "--data", str(prepared_folder), "--cache", str(tmp_path / "cache"), "--runs", str(tmp_path / "runs")]
    words += ["--out", str(tmp_path / "out"), "--steps", "2", "--spacings", "1", "--only", "all of it", "no velocity loss"]
    train_flags = ["--model", "tiny", "--tokens", "200", "--lengths", "60", "--threads", "1"]
    sweep.main([*words, "--", *train_flags])
    text = (tmp_path / "out.md").read_text()
    assert "| 1 s | no velocity loss | --velocity 0 |" in text and "2-2 steps" in text
    checkpoint = tmp_path / "runs" / "all-of-it" / "checkpoint.pt"
    written = checkpoint.stat().st_mtime_ns
    sweep.main([*words, "--", *train_flags])
    assert checkpoint.stat().st_mtime_ns == written
    with pytest.raises(ValueError, match="choose another --runs"):
        sweep.main([*words, "--", *train_flags, "--lr", "0.1"])
