"""Runs DanceFormer's two shipped networks as the page does: key poses beat after beat, then curves, then frames."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import onnxruntime
import torch
from torch import Tensor

import curve_net
from curves import Curves, align_signs, knot_rows, motion_channels, sample, tangents
from danceformer_data import FEATURES, Dance, interval_music
from danceformer_loss import curves_of
from metrics import matrices_of
from rotation import matrix_to_quaternion, matrix_to_six_d, quaternion_to_matrix
from spec import FPS, MOTION_SIZE, ROTATION_SIZE
from suggest import BEAT_SIZE, CODES, FARTHEST, FUTURE_BEATS, PAST_BEATS, PAST_POSES, STYLES


def open_session(path: Path) -> onnxruntime.InferenceSession:
    """One thread, quiet."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.log_severity_level = 1, 3
    return onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])


@dataclass
class Networks:
    """The two sessions."""

    suggest: onnxruntime.InferenceSession
    curves: onnxruntime.InferenceSession

    @staticmethod
    def load(folder: Path) -> "Networks":
        return Networks(open_session(folder / "suggest.onnx"), open_session(folder / "curves.onnx"))


def suggest_poses(
    session: onnxruntime.InferenceSession,
    music: Tensor,
    beats: Tensor,
    fixed: dict[int, Tensor] | None = None,
    temperature: float = 1.0,
    seed: int = 0,
    style: Tensor | None = None,
    copies: int = 1,
) -> Tensor:
    """Key poses [copies, n, 147] at the song's beats number `beats` [n]; `music` [U, 57] of all its beats (empty: none is known).

    `fixed`: poses [144] that the user has placed, by their place in `beats`; they are kept and danced towards. Copies differ in their noise.
    """
    fixed = fixed or {}
    rng = torch.Generator().manual_seed(seed)
    made = torch.zeros(copies, 0, MOTION_SIZE)
    style = torch.zeros(len(STYLES)) if style is None else style
    for place, beat in enumerate(beats.tolist()):
        history = made[:, -PAST_POSES:]
        poses = torch.zeros(copies, PAST_POSES, MOTION_SIZE)
        known = torch.zeros(copies, PAST_POSES)
        if history.shape[1]:
            poses[:, -history.shape[1] :], known[:, -history.shape[1] :] = history, 1
        around = torch.arange(beat - PAST_BEATS, beat + FUTURE_BEATS + 1)
        heard = (around >= 0) & (around < len(music))
        sounds = torch.zeros(len(around), BEAT_SIZE)
        if heard.any():
            sounds[heard] = music[around[heard]]
        ahead = min((at for at in fixed if at > place), default=None)
        given = ahead is not None and ahead - place <= FARTHEST
        uniform = torch.rand(copies, CODES, generator=rng).clamp(1e-9, 1 - 1e-7)
        feed = {
            "poses": poses,
            "pose_mask": known,
            "music": sounds.expand(copies, -1, -1),
            "music_mask": heard.float().expand(copies, -1),
            "next_pose": (fixed[ahead] if given else torch.zeros(ROTATION_SIZE)).expand(copies, -1),
            "next_beats": torch.full((copies,), float(ahead - place) if given else -1.0),
            "style": style.expand(copies, -1),
            "temperature": torch.full((copies,), temperature),
            "noise": -torch.log(-torch.log(uniform)),
        }
        pose = torch.from_numpy(session.run(["pose"], {name: value.contiguous().numpy() for name, value in feed.items()})[0])
        if place in fixed:
            pose = torch.cat([fixed[place].expand(copies, -1), pose[:, ROTATION_SIZE:]], 1)
        made = torch.cat([made, pose[:, None]], 1)
    return made


def draw_curves(session: onnxruntime.InferenceSession, poses: Tensor, keys: Tensor, dance: Dance | None, roots: Tensor | None = None) -> Curves:
    """Curves through key poses [M, >= 144] at frames `keys` [M]; roots come from the network unless given [M, 3]."""
    quaternions = align_signs(matrix_to_quaternion(matrices_of(poses)))
    count = len(keys) - 1
    index = torch.arange(count)
    neighbours = torch.stack([(index - 1).clamp(min=0), index, index + 1, (index + 2).clamp(max=count)], 1)
    mask = torch.stack([index > 0, index < count - 1], 1).float()
    length = (keys[1:] - keys[:-1]).float() / FPS
    seconds = torch.stack([torch.cat([length[:1] * 0, length[:-1]]), length, torch.cat([length[1:], length[:1] * 0])], 1)
    if dance is not None and dance.has_music:
        music = interval_music(dance.frames, keys[:-1].float() + dance.start, keys[1:].float() + dance.start, curve_net.STEPS)
    else:
        music = torch.zeros(count, curve_net.STEPS, FEATURES)
    feed = {"keys": quaternions[neighbours], "key_mask": mask, "seconds": seconds, "music": music}
    output, root = (torch.from_numpy(x) for x in session.run(list(curve_net.OUTPUTS), {n: v.float().contiguous().numpy() for n, v in feed.items()}))
    if roots is None:
        heights = torch.cat([root[:, 0, 1], root[-1:, 1, 1]])
        path = torch.cat([torch.zeros(1, 2), root[:, 1, [0, 2]].cumsum(0)])
        roots = torch.stack([path[:, 0], heights, path[:, 1]], 1)
    curves = curves_of(output, torch.cat([roots, quaternions.flatten(1)], 1), length)
    curves.times = keys.float() / FPS
    return curves


def frames_of(curves: Curves) -> Tensor:
    """Motion [N, 147] at 30 frames a second, from the first key's frame to the last's."""
    first, last = (round(float(curves.times[end]) * FPS) for end in (0, -1))
    root, quaternions = motion_channels(sample(curves, torch.arange(first, last + 1) / FPS))
    return torch.cat([matrix_to_six_d(quaternion_to_matrix(quaternions)).flatten(1), root], 1)


def smoothness_at_keys(curves: Curves) -> float:
    """Largest jump of velocity at a key, as a share of the mean speed of its channels: 0 when every continuity is 0."""
    arriving, leaving = tangents(*knot_rows(curves))
    inside = slice(3, -1, 3)
    return float((arriving - leaving)[inside].abs().mean() / arriving[inside].abs().mean().clamp_min(1e-9))
