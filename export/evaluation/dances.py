"""The dances that are measured: a clip with key poses taken from it, and what different methods make of them.

A clip's first 2 s are the seed; frame 0 of a dance is the frame after it. Key poses are the real poses at frames 0, s, 2s ...
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

import metrics
from baselines import NearestNeighbour, cubic_rotations, slerp_rotations, with_path
from data import Clip
from evaluation.runners import Run
from model import INPUT_NAMES
from rotation import heading, matrix_to_six_d, yaw_matrix
from spec import FPS, MUSIC_FRAMES, ROTATION_SIZE, SEED_FRAMES
from windows import cut_window, key_distances, to_local_frame


@dataclass
class Task:
    """A clip with a key pose every `spacing` frames. N = frames from the first key to the last."""

    clip: Clip
    spacing: int
    seed: Tensor  # [60, 147]
    real: Tensor  # [N, 147], in the frame of the seed's last pose, as the seed is
    music: Tensor  # [N, 15]
    keys: Tensor  # [M] frames
    between: Tensor  # [N] bool: frames that errors are taken on
    beats: Tensor  # frames, fractional
    pieces: list[tuple[int, int]]  # (start, frames): windows of at most 8 s from key to key, side by side

    @property
    def frames(self) -> int:
        return self.real.shape[0]


def make_task(clip: Clip, spacing: int) -> Task | None:
    """None for a clip that is too short for a second of dance after its seed."""
    frames = (clip.frames - SEED_FRAMES - 1) // spacing * spacing + 1
    if frames <= max(spacing, FPS):
        return None
    motion = to_local_frame(clip.motion[: SEED_FRAMES + frames], SEED_FRAMES)
    none = torch.zeros(0, dtype=torch.long)
    music = cut_window(clip, 0, frames, torch.Generator().manual_seed(0), keys=none).music
    keys = torch.arange(0, frames, spacing)
    between = clip.valid[SEED_FRAMES : SEED_FRAMES + frames].all(-1).clone()
    between[keys] = False
    pieces, start = [], 0
    while start < frames - 1:
        length = min((MUSIC_FRAMES - 1) // spacing * spacing, frames - 1 - start)
        pieces.append((start, length + 1))
        start += length
    beats = clip.beats - SEED_FRAMES
    return Task(clip, spacing, motion[:SEED_FRAMES], motion[SEED_FRAMES:], music, keys, between, beats, pieces)


def window_inputs(music: Tensor, seed: Tensor, ahead: Tensor, keys: Tensor) -> dict[str, Tensor]:
    """A batch of one, in the window's own frame: seed [60, 147] and the poses ahead [T, 147] that are shown at `keys` only."""
    local = to_local_frame(torch.cat([seed, ahead]), SEED_FRAMES)
    mask = torch.zeros(len(ahead))
    mask[keys] = 1
    to_previous, to_next = key_distances(mask)
    poses = local[SEED_FRAMES:, :ROTATION_SIZE] * mask[:, None]
    values = (music, local[:SEED_FRAMES], poses, mask, to_previous, to_next)
    return {name: value[None] for name, value in zip(INPUT_NAMES, values)}


def back_to_world(motion: Tensor, anchor: Tensor) -> Tensor:
    """Undoes `to_local_frame` for a window whose last seed frame was `anchor` [147]."""
    turn = yaw_matrix(heading(metrics.matrices_of(anchor)[0]))
    pelvis = matrix_to_six_d(turn @ metrics.matrices_of(motion)[:, 0])
    offset = anchor[ROTATION_SIZE:] * torch.tensor([1.0, 0.0, 1.0])
    return torch.cat([pelvis, motion[:, 6:ROTATION_SIZE], motion[:, ROTATION_SIZE:] @ turn.T + offset], -1)


def real_seeded(task: Task, run: Run) -> list[Tensor]:
    """The network on each piece, seeded by the real 2 s before it -> motions of the pieces."""
    whole = torch.cat([task.seed, task.real])
    made = []
    for start, frames in task.pieces:
        seed, ahead = whole[start : start + SEED_FRAMES], task.real[start : start + frames]
        inputs = window_inputs(task.music[start : start + frames], seed, ahead, torch.arange(0, frames, task.spacing))
        made.append(back_to_world(run(inputs)[0], seed[-1]))
    return made


def rollout(task: Task, run: Run, seed: Tensor | None = None) -> Tensor:
    """The network through the whole dance [N, 147], each window seeded by the output before it; the first by `seed`."""
    dance = task.seed if seed is None else seed
    for start, frames in task.pieces:
        ahead = task.real[start : start + frames]
        inputs = window_inputs(task.music[start : start + frames], dance[-SEED_FRAMES:], ahead, torch.arange(0, frames, task.spacing))
        made = back_to_world(run(inputs)[0], dance[-1])
        # The last frame is a key that the next window makes again.
        last = start + frames == task.frames
        dance = torch.cat([dance, made if last else made[:-1]])
    return dance[SEED_FRAMES:]


def free_rollout(music: Tensor, seed: Tensor, run: Run, overlap: int) -> Tensor:
    """The network without any key poses [N, 147] over music [N, 15]: windows of 8 s, `overlap` frames of each are made again by the
    next, as the page does (without its cross-fade)."""
    dance, start, frames = seed, 0, music.shape[0]
    none = torch.zeros(0, dtype=torch.long)
    while True:
        length = min(MUSIC_FRAMES, frames - start)
        dance = dance[: SEED_FRAMES + start]
        before = dance[-SEED_FRAMES:]
        inputs = window_inputs(music[start : start + length], before, before[-1:].expand(length, -1), none)
        dance = torch.cat([dance, back_to_world(run(inputs)[0], dance[-1])])
        if start + length == frames:
            return dance[SEED_FRAMES:]
        start += length - overlap


def baselines(task: Task, nearest: NearestNeighbour | None) -> dict[str, Tensor]:
    """Methods that need no training, on the real path -> {name: [N, 147]}."""
    path, poses = task.real[:, ROTATION_SIZE:], metrics.matrices_of(task.real[task.keys])
    made = {
        "slerp": slerp_rotations(poses, task.keys, task.frames),
        "cubic": cubic_rotations(poses, task.keys, task.frames),
    }
    if nearest:
        made["nearest neighbour"] = nearest.rotations(task.real, task.keys)
    return {name: with_path(rotations, path) for name, rotations in made.items()}


def cut(dance: Tensor, task: Task) -> list[Tensor]:
    """A whole dance as its pieces."""
    return [dance[start : start + frames] for start, frames in task.pieces]
