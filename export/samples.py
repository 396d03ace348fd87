"""Made-up inputs of the model: smooth motion, beats and key poses from a seeded generator. No recorded data is in them."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from data import CHROMA, beat_columns
from rotation import axis_angle_to_matrix, matrix_to_six_d
from spec import BEAT, DOWNBEAT, FEATURE_COUNT, FPS, JOINT_COUNT, ROTATION_SIZE, TOE_HEIGHT
from windows import key_distances, to_local_frame

STANDING_PELVIS = 0.93 + TOE_HEIGHT  # metres: about the height at which straight legs touch the floor


def synthetic_motion(frames: int, rng: torch.Generator, size: float = 0.35) -> Tensor:
    """Smooth made-up motion [frames, 147]: each joint swings on sines of random rate and phase, `size` radians wide."""
    t = torch.arange(frames)[:, None, None] / FPS
    rate = 0.4 + 1.2 * torch.rand(1, JOINT_COUNT, 3, generator=rng)
    phase = 6.28 * torch.rand(1, JOINT_COUNT, 3, generator=rng)
    reach = size * torch.rand(1, JOINT_COUNT, 3, generator=rng)
    axis_angle = reach * torch.sin(6.28 * rate * t + phase)
    axis_angle[:, 0, 1] += 0.5 * torch.sin(0.7 * t[:, 0, 0])
    root = torch.stack([0.2 * torch.sin(t[:, 0, 0]), STANDING_PELVIS + 0.03 * torch.cos(2 * t[:, 0, 0]), 0.1 * t[:, 0, 0]], -1)
    return torch.cat([matrix_to_six_d(axis_angle_to_matrix(axis_angle)).flatten(-2), root], -1)


def synthetic_inputs(batch: int, seed_frames: int, frames: int, seed: int) -> dict[str, Tensor]:
    """Model inputs with keys about every 20 frames; the last window of a batch has none."""
    rng = torch.Generator().manual_seed(seed)
    inputs: dict[str, list[Tensor]] = {n: [] for n in ("music", "seed", "key_poses", "key_mask", "to_previous", "to_next")}
    for item in range(batch):
        motion = to_local_frame(synthetic_motion(seed_frames + frames, rng), seed_frames)
        mask = torch.zeros(frames)
        if batch == 1 or item < batch - 1:
            mask[7 + item : frames - 5 : 20] = 1
        music = torch.rand(frames, FEATURE_COUNT, generator=rng)
        music[:, :CHROMA] /= music[:, :CHROMA].norm(dim=-1, keepdim=True)
        beats = torch.arange(3, frames, 15).float()
        music[:, [BEAT, DOWNBEAT]] = beat_columns(frames, beats, beats[::4])
        to_previous, to_next = key_distances(mask)
        target = motion[seed_frames:, :ROTATION_SIZE]
        values = (music, motion[:seed_frames], target * mask[:, None], mask, to_previous, to_next)
        for name, value in zip(inputs, values):
            inputs[name].append(value)
    return {name: torch.stack(values) for name, values in inputs.items()}


def randomise(model: nn.Module, seed: int, size: float = 0.05) -> nn.Module:
    """Fills the zero-initialised matrices (head, ends of layers) with noise, so that every input and layer matters."""
    rng = torch.Generator().manual_seed(seed)
    with torch.no_grad():
        for parameter in model.parameters():
            if parameter.ndim == 2 and not parameter.any():
                parameter.normal_(0, size, generator=rng)
    return model
