"""Dance clips as tensors: the prepared folder (data/README.md there) or full AIST++ as downloaded.

A clip holds 30 frames a second of 147 motion numbers (24 x 6D, root in metres), masks, and the 15 music features. Beats are
kept as fractional frames so that a clip can be played at another tempo without blurring the one-hot columns.
"""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from rotation import axis_angle_to_matrix, matrix_to_six_d, six_d_to_matrix
from skeleton import forward_kinematics
from spec import BEAT, DOWNBEAT, FEATURE_COUNT, FPS, JOINT_COUNT, ONSET, ROTATION_SIZE, TOE_HEIGHT, TOES, spec_hash

CHROMA = BEAT  # number of chroma columns: they come first
# AIST++ stores beats and onsets about 0.05 s after the sound (README of the data): their peaks move 1 to 2 frames earlier.
AIST_LAG_FRAMES = (1, 2)


@dataclass
class Clip:
    """One dance. N = frames."""

    name: str
    source: str  # aist | cmu | tang
    split: str  # train | val
    motion: Tensor  # [N, 147]
    valid: Tensor  # [N, 24] bool: rotation is real
    root_valid: Tensor  # [N] bool: root is real
    music: Tensor  # [N, 15]; the beat columns are filled again from the lists below when a window is cut
    beats: Tensor  # frames, fractional
    downbeats: Tensor  # frames, fractional

    @property
    def frames(self) -> int:
        return self.motion.shape[0]


def motion_from_axis_angle(poses: np.ndarray, trans: np.ndarray) -> Tensor:
    """(N, 24, 3) axis-angle and (N, 3) metres -> [N, 147]."""
    matrices = axis_angle_to_matrix(torch.from_numpy(np.asarray(poses, dtype=np.float64)))
    six_d = matrix_to_six_d(matrices).flatten(-2)
    return torch.cat([six_d, torch.from_numpy(np.asarray(trans, dtype=np.float64))], -1).float()


def reground(motion: Tensor, root_valid: Tensor) -> Tensor:
    """Shifts the root so that the 5th percentile of OUR skeleton's toe heights is spec.skeleton.toeHeight.

    The data stands on the floor with SMPL's legs; ours differ by centimetres.
    """
    matrices = six_d_to_matrix(motion[:, :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6)))
    toes = forward_kinematics(matrices, motion[:, ROTATION_SIZE:])[:, TOES, 1]
    toes = toes[root_valid] if root_valid.any() else toes
    shift = TOE_HEIGHT - torch.quantile(toes.flatten(), 0.05)
    motion = motion.clone()
    motion[:, ROTATION_SIZE + 1] += shift
    return motion


def beat_columns(frames: int, beats: Tensor, downbeats: Tensor) -> Tensor:
    """One-hot [frames, 2] (beat, downbeat) at the nearest frames; a downbeat is a beat too."""
    columns = torch.zeros(frames, 2)
    for times, filled in ((beats, (0,)), (downbeats, (0, 1))):
        index = times.round().long()
        index = index[(index >= 0) & (index < frames)]
        for column in filled:
            columns[index, column] = 1
    return columns


def normalise_onset(onset: np.ndarray) -> np.ndarray:
    """Divided by the 98th percentile of the track and clipped to 0..1, as the app's own extractor does."""
    return np.clip(onset / max(float(np.percentile(onset, 98)), 1e-6), 0, 1)


def _aist_music(z: np.lib.npyio.NpzFile, frames: int, start: int) -> tuple[Tensor, Tensor, Tensor]:
    music = torch.zeros(frames, FEATURE_COUNT)
    chroma = np.asarray(z["chroma"], dtype=np.float32)
    music[:, :CHROMA] = torch.from_numpy(chroma / np.maximum(np.linalg.norm(chroma, axis=1, keepdims=True), 1e-6))
    onset = normalise_onset(np.asarray(z["onset"], dtype=np.float32))
    padded = np.concatenate([onset, np.zeros(max(AIST_LAG_FRAMES), np.float32)])
    music[:, ONSET] = torch.from_numpy(np.max([padded[lag : lag + frames] for lag in AIST_LAG_FRAMES], axis=0))
    # Without the lag the k-th beat of the track sounds at 60 k / bpm.
    period = 60 * FPS / float(z["bpm"])
    numbers = np.arange(np.ceil(start / period), np.floor((start + frames - 1) / period) + 1)
    beats = torch.from_numpy(numbers * period - start).float()
    downbeats = torch.zeros(0)
    if "beat_phase_downbeat" in z.files:
        marked = torch.from_numpy(np.flatnonzero(np.asarray(z["beat_phase_downbeat"]) > 0)).float()
        lag = sum(AIST_LAG_FRAMES) / len(AIST_LAG_FRAMES)
        near = (beats[:, None] + lag - marked[None, :]).abs().min(1).values if len(marked) else torch.full_like(beats, 99)
        downbeats = beats[near < 2]
    return music, beats, downbeats


def load_features(folder: Path, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """What export/features.ts wrote for a song: (frames, 15) features, beats and downbeats in seconds; None if it did not."""
    header, data = folder / f"{name}.json", folder / f"{name}.f32"
    if not (header.exists() and data.exists()):
        return None
    info = json.loads(header.read_text(encoding="utf-8"))
    features = np.fromfile(data, dtype="<f4").reshape(-1, FEATURE_COUNT)
    if info["fps"] != FPS or len(features) != info["frames"]:
        raise ValueError(f"{header}: {info['frames']} frames at {info['fps']} fps do not match {len(features)} rows at {FPS} fps")
    return features, np.asarray(info["beats"], dtype=np.float64), np.asarray(info["downbeats"], dtype=np.float64)


def song_music(features: Path | None, name: str, frames: int, start_seconds: float) -> tuple[Tensor, Tensor, Tensor] | None:
    """Music under a clip whose frame 0 sounds `start_seconds` into the song; silence past the song's ends."""
    loaded = load_features(features, name) if features else None
    if loaded is None:
        return None
    table, beats, downbeats = loaded
    start = round(start_seconds * FPS)
    music = torch.zeros(frames, FEATURE_COUNT)
    first, last = max(start, 0), min(start + frames, len(table))
    if last > first:
        music[first - start : last - start] = torch.from_numpy(table[first:last].astype(np.float32))
    music[:, [BEAT, DOWNBEAT]] = 0
    to_frames = [torch.from_numpy((times - start_seconds) * FPS).float() for times in (beats, downbeats)]
    return music, to_frames[0], to_frames[1]


def _load_npz(path: Path, entry: dict, features: Path | None) -> Clip:
    z = np.load(path, allow_pickle=False)
    if int(z["fps"]) != FPS:
        raise ValueError(f"{path}: {int(z['fps'])} frames per second, expected {FPS}")
    frames = z["poses"].shape[0]
    valid = torch.from_numpy(z["valid"])
    root_valid = torch.from_numpy(z["trans_valid"]) if "trans_valid" in z.files else torch.ones(frames, dtype=torch.bool)
    music, beats, downbeats = torch.zeros(frames, FEATURE_COUNT), torch.zeros(0), torch.zeros(0)
    if "chroma" in z.files:
        music, beats, downbeats = _aist_music(z, frames, int(entry.get("start_frame") or 0))
    elif "audio_start_s" in z.files:
        found = song_music(features, path.stem, frames, float(z["audio_start_s"]))
        if found:
            music, beats, downbeats = found
        else:  # the dataset's own estimate of the beats is better than no music at all
            beats = torch.from_numpy(np.asarray(z["beat_times_s"], dtype=np.float32)) * FPS
    motion = reground(motion_from_axis_angle(z["poses"], z["trans"]), root_valid)
    source = {"aist_partial": "aist"}.get(path.parent.name, path.parent.name)
    return Clip(path.stem, source, entry["split"], motion, valid, root_valid, music, beats, downbeats)


def load_prepared(folder: Path, features: Path | None) -> list[Clip]:
    """All clips of the prepared folder. A partial clip of a validation track counts as validation only if the manifest says so."""
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    return [_load_npz(folder / entry["file"], entry, features) for entry in manifest]


def data_hash(folder: Path, features: Path | None) -> str:
    """SHA-256 over names and bytes of every file that feeds the training, so that a run can be told from another."""
    digest = hashlib.sha256(spec_hash().encode())
    paths = sorted(p for p in folder.rglob("*") if p.suffix in {".npz", ".pkl", ".json"})
    paths += sorted(features.glob("*")) if features and features.exists() else []
    for path in paths:
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def load_clips(folder: str | Path, features: str | Path | None = None, cache: str | Path | None = None) -> list[Clip]:
    """Loads a data folder of either kind; `cache` keeps the result so that a restart takes a second.

    Raises FileNotFoundError when the folder is neither the prepared form (manifest.json) nor AIST++ (motions/*.pkl).
    """
    folder, features = Path(folder), Path(features) if features else None
    kept = None
    if cache:
        kept = Path(cache) / f"clips-{data_hash(folder, features)[:16]}.pt"
        if kept.exists():
            return [Clip(**fields) for fields in torch.load(kept, weights_only=True)]
    if (folder / "manifest.json").exists():
        clips = load_prepared(folder, features)
    elif (folder / "motions").is_dir():
        from aistpp import load_aistpp

        clips = load_aistpp(folder, features)
    else:
        raise FileNotFoundError(f"{folder}: neither manifest.json (prepared data) nor motions/*.pkl (AIST++ as downloaded) is there")
    if kept:
        kept.parent.mkdir(parents=True, exist_ok=True)
        torch.save([vars(clip) for clip in clips], kept)
    return clips


def track_of(name: str) -> str:
    """AIST++ clip name -> its music track: gBR_sBM_cAll_d04_mBR0_ch01 -> mBR0."""
    found = re.search(r"_(m[A-Z]{2}\d)_", name)
    if not found:
        raise ValueError(f"{name}: no music track in this AIST++ clip name")
    return found.group(1)
