"""The full AIST++ release as its site delivers it: motions/*.pkl (60 frames a second, SMPL), music features beside it.

Layout of the folder: `motions/`, optionally `ignore_list.txt` and `splits/crossmodal_val.txt`, `splits/crossmodal_test.txt`
(one clip name a line). Music comes from what export/features.ts made of the tracks' wav files (`<track>.f32`, `.json`).
"""

from __future__ import annotations

import io
import pickle
from pathlib import Path

import numpy as np
import torch

from data import Clip, motion_from_axis_angle, reground, song_music, track_of
from spec import FEATURE_COUNT, FPS, JOINT_COUNT

SOURCE_FPS = 60
# Used when the release's split files are not there: the same tracks as in the prepared data.
VALIDATION_TRACKS = {"mPO3", "mLO1", "mKR4", "mHO3", "mHO4", "mJS4"}


class _ArraysOnly(pickle.Unpickler):
    """A pickle can run any code; these files need numpy arrays only, so nothing else is let in."""

    ALLOWED = {"_reconstruct", "ndarray", "dtype", "scalar", "_frombuffer"}

    def find_class(self, module: str, name: str):
        if module.split(".")[0] == "numpy" and name in self.ALLOWED:
            return super().find_class(module.replace("numpy.core", "numpy._core"), name)
        raise pickle.UnpicklingError(f"unexpected {module}.{name} in an AIST++ motion file")


def read_motion(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """(N, 24, 3) axis-angle and (N, 3) metres at 30 frames a second from one 60 fps pickle."""
    raw = _ArraysOnly(io.BytesIO(path.read_bytes()), encoding="latin1").load()
    step = SOURCE_FPS // FPS
    poses = np.asarray(raw["smpl_poses"], dtype=np.float64).reshape(-1, JOINT_COUNT, 3)[::step]
    # Translations are stored in the units of the scaled body (centimetres); the scale brings them to metres.
    scale = float(np.asarray(raw.get("smpl_scaling", 1.0)).reshape(-1)[0])
    trans = np.asarray(raw["smpl_trans"], dtype=np.float64)[::step] / scale
    trans[:, [0, 2]] -= trans[0, [0, 2]]
    return poses, trans


def _names(path: Path) -> set[str]:
    return set(path.read_text(encoding="utf-8").split()) if path.exists() else set()


def load_aistpp(folder: Path, features: Path | None) -> list[Clip]:
    """Every clip of the release but those on its ignore list; without features of a track its music is zero."""
    ignored = _names(folder / "ignore_list.txt")
    held_out = _names(folder / "splits" / "crossmodal_val.txt") | _names(folder / "splits" / "crossmodal_test.txt")
    clips = []
    for path in sorted((folder / "motions").glob("*.pkl")):
        if path.stem in ignored:
            continue
        poses, trans = read_motion(path)
        frames, track = len(poses), track_of(path.stem)
        all_valid = torch.ones(frames, dtype=torch.bool)
        found = song_music(features, track, frames, 0.0)
        music, beats, downbeats = found or (torch.zeros(frames, FEATURE_COUNT), torch.zeros(0), torch.zeros(0))
        is_val = path.stem in held_out if held_out else track in VALIDATION_TRACKS
        clips.append(
            Clip(
                name=path.stem,
                source="aist",
                split="val" if is_val else "train",
                motion=reground(motion_from_axis_angle(poses, trans), all_valid),
                valid=all_valid[:, None].expand(-1, JOINT_COUNT).clone(),
                root_valid=all_valid,
                music=music,
                beats=beats,
                downbeats=downbeats,
            )
        )
    if not clips:
        raise FileNotFoundError(f"{folder / 'motions'}: no usable *.pkl")
    return clips
