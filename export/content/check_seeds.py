"""Measures the starting clips as a player at a given tempo shows them: speed, jerk, foot sliding, floor, balance.

    python export/content/check_seeds.py [--tempo 116]
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import torch

from choreography import choreographies
from clips import ClipSolver, interpolate_loop
from rig import JOINTS, TOE_HEIGHT, spec
from rotation import axis_angle_to_quaternion, quaternion_to_matrix
from skeleton import forward_kinematics

SEEDS = Path(__file__).resolve().parents[2] / "public/library/seeds.json"


def quaternions(poses: list[list[float]]) -> np.ndarray:
    """Poses x 24 x 4 from poses of 72 axis-angle numbers, each joint with the sign of the pose before."""
    quats = axis_angle_to_quaternion(torch.tensor(poses, dtype=torch.float64).view(-1, spec.JOINT_COUNT, 3)).numpy()
    for i in range(1, len(quats)):
        quats[i] *= np.where((quats[i] * quats[i - 1]).sum(1, keepdims=True) < 0, -1, 1)
    return quats


def play(clip: dict, tempo: float, fps: int) -> tuple[np.ndarray, np.ndarray]:
    """World joint positions (frames x 24 x 3) and beats of one loop, joined as web/core/seed.ts joins them."""
    quats, root = quaternions(clip["poses"]), np.array(clip["root"])
    beats = np.arange(round(clip["beats"] * 60 / tempo * fps)) / fps * tempo / 60
    turns = np.array([interpolate_loop(quats, beat / clip["beats"]) for beat in beats])
    turns = torch.from_numpy(turns / np.linalg.norm(turns, axis=-1, keepdims=True))
    places = np.array([interpolate_loop(root, beat / clip["beats"]) for beat in beats])
    return forward_kinematics(quaternion_to_matrix(turns), torch.from_numpy(places)).numpy(), beats


def slides(track: np.ndarray, spans: list[tuple[float, float]], beats: np.ndarray, period: float) -> list[float]:
    """Largest horizontal distance of a planted toe from the middle of its stand, metres, per stand."""
    out = []
    for start, end in spans:
        inside = np.array([(start + 0.08 <= b + k <= end - 0.08) for b in beats for k in (0, period)]).reshape(len(beats), 2).any(1)
        if inside.sum() < 3:
            continue
        place = track[inside][:, [0, 2]]
        out.append(float(np.linalg.norm(place - np.median(place, 0), axis=1).max()))
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tempo", type=float, default=116)
    options = parser.parse_args()
    plans = {p.id: p for p in choreographies()}
    fps = spec.FPS
    print(f"{'clip':20} speed m/s  jerk m/s3  slide cm  low toe cm  max deg/frame")
    for clip in json.loads(SEEDS.read_text())["clips"]:
        points, beats = play(clip, options.tempo, fps)
        local = points - points[:, :1]
        velocity = (np.roll(local, -1, 0) - local) * fps
        third = np.diff(np.concatenate([local, local[:3]]), 3, axis=0) * fps**3
        solver = ClipSolver(plans[clip["id"]])
        sliding = []
        for side in (0, 1):
            spans = [(s.start, s.end) for s in solver.feet[side].stands]
            sliding += slides(points[:, 10 + side], spans, beats, clip["beats"])
        quats = quaternions(clip["poses"])
        step = 2 * np.degrees(np.arccos(np.clip(np.abs((quats * np.roll(quats, -1, 0)).sum(-1)), 0, 1)))
        where = np.unravel_index(step.argmax(), step.shape)
        print(
            f"{clip['id']:20} {np.linalg.norm(velocity, axis=-1).mean():9.2f} {np.linalg.norm(third, axis=-1).mean():10.0f}"
            f" {max(sliding) * 100:9.2f} {(points[:, 10:12, 1].min() - TOE_HEIGHT) * 100:11.2f}"
            f"  {step.max():.0f} at {where[0] / clip['rate']:g} {JOINTS[where[1]]}"
        )


if __name__ == "__main__":
    main()
