"""Dances as the page makes them: jobs for export/finish.ts, and what came back.

Keys, music and beats are the clip's; the dance goes on from the clip's real first 2 s. Between keys more than
2.5 s apart the page would put filler poses of its starting clip; they are off wherever a dance is compared with a real one.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from evaluation.dances import Task
from evaluation.runners import load_network
from export_onnx import to_onnx
from metrics import matrices_of
from rotation import matrix_to_axis_angle, matrix_to_quaternion, matrix_to_six_d, quaternion_to_matrix
from spec import FPS, JOINT_COUNT, ROTATION_SIZE, SEED_FRAMES

TOP = Path(__file__).resolve().parents[2]
OPTIONS = {"keyStrength": 1.0, "variation": 0.3, "seed": 1, "cleanFeet": True, "fillers": False}


@dataclass
class Song:
    """Music to dance to. N = frames."""

    music: Tensor  # [N, 15]
    beats: Tensor  # frames, fractional
    downbeats: Tensor

    def grid(self) -> dict:
        """The page's beat grid of it."""
        beats, downbeats = (times[(times >= 0) & (times < len(self.music))].double() / FPS for times in (self.beats, self.downbeats))
        period = float(beats.diff().median()) if len(beats) > 1 else 0.5
        bar = float(downbeats.diff().median()) / period if len(downbeats) > 1 else 4
        return {
            "tempo": 60 / period,
            "beatsPerBar": 3 if round(bar) == 3 else 4,
            "beats": beats.tolist(),
            "downbeats": downbeats.tolist(),
        }


@dataclass
class Order:
    """A dance that is asked of the page, in one or several ways: {name: options that differ from OPTIONS}."""

    song: Song
    runs: dict[str, dict]
    opening: Tensor | None = None  # [60, 147]; None: the page's starting clip
    seed_clip: int = 0
    keys: Tensor = field(default_factory=lambda: torch.zeros(0, dtype=torch.long))  # [M] frames
    key_poses: Tensor = field(default_factory=lambda: torch.zeros(0, ROTATION_SIZE))  # [M, 144 or more]


def order_of(task: Task, runs: dict[str, dict]) -> Order:
    """The page's dance of a task."""
    song = Song(task.music, task.beats, task.clip.downbeats - SEED_FRAMES)
    return Order(song, runs, task.seed, 0, task.keys, task.real[task.keys])


def _poses(motion: Tensor) -> np.ndarray:
    """Motion [N, 147] -> pelvis and quaternions [N, 99]."""
    quaternions = matrix_to_quaternion(matrices_of(motion.double())).flatten(1)
    return torch.cat([motion[:, ROTATION_SIZE:].double(), quaternions], -1).numpy().astype("<f4")


def _motion(rows: np.ndarray) -> Tensor:
    """Pelvis and quaternions [N, 99] -> motion [N, 147]."""
    values = torch.from_numpy(rows.astype(np.float64))
    quaternions = values[:, 3:].unflatten(1, (JOINT_COUNT, 4))
    matrices = quaternion_to_matrix(quaternions / quaternions.norm(dim=-1, keepdim=True))
    return torch.cat([matrix_to_six_d(matrices).flatten(1), values[:, :3]], -1).float()


def as_onnx(checkpoint: Path, folder: Path) -> Path:
    """A checkpoint's averaged weights as an fp32 ONNX file in `folder`."""
    path = folder / "model.onnx"
    path.write_bytes(to_onnx(load_network(checkpoint), "evaluation").SerializeToString())
    return path


def make_dances(model: Path, orders: list[Order]) -> list[dict[str, Tensor]]:
    """Runs the page's code on all orders -> for each {name: motion [N, 147]}. Raises RuntimeError when Node fails.

    `model` is an ONNX file or a checkpoint.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        jobs = []
        for number, order in enumerate(orders):
            order.song.music.numpy().astype("<f4").tofile(folder / f"{number}.music")
            rotations = matrix_to_axis_angle(matrices_of(order.key_poses.double())).flatten(1)
            rotations.numpy().astype("<f4").tofile(folder / f"{number}.keys")
            job = {
                "frames": len(order.song.music),
                "features": f"{number}.music",
                **order.song.grid(),
                "seedClip": order.seed_clip,
                "keyFrames": order.keys.tolist(),
                "keyPoses": f"{number}.keys",
                "runs": [{**OPTIONS, **options, "out": f"{number}.{at}.dance"} for at, options in enumerate(order.runs.values())],
            }
            if order.opening is not None:
                _poses(order.opening).tofile(folder / f"{number}.opening")
                job["opening"] = f"{number}.opening"
            jobs.append(job)
        onnx = model.resolve() if model.suffix == ".onnx" else as_onnx(model, folder)
        listing = {"model": str(onnx), "seedClips": str(TOP / "public/library/seeds.json"), "jobs": jobs}
        (folder / "jobs.json").write_text(json.dumps(listing), encoding="utf-8")
        command = ["npx", "tsx", "export/finish.ts", str(folder / "jobs.json")]
        done = subprocess.run(command, cwd=TOP, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{' '.join(command)} failed:\n{done.stderr[-2000:]}")
        read = lambda file: _motion(np.fromfile(file, dtype="<f4").reshape(-1, 3 + JOINT_COUNT * 4))  # noqa: E731
        return [
            {name: read(folder / f"{number}.{at}.dance") for at, name in enumerate(order.runs)} for number, order in enumerate(orders)
        ]
