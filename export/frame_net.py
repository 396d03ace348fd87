"""Stage 2 without curves, for the ablation "curve to frame" (paper B, Table 2): the same DanTrans gives the poses between two key poses.

Moments are those at which curves are compared in training (curves.py `sample_evenly`). Such a dance has no handles to edit, and nothing
keeps it smooth.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from curve_net import GAIN, LARGEST_TURN, CurveConfig, CurveNet, product, slerp_at, small_turn
from dantrans import FROM_TREE, JointLinear
from spec import JOINT_COUNT

MOMENTS = 9


class FrameNet(CurveNet):
    """keys [B, 4, 24, 4], key_mask [B, 2], seconds [B, 3], music [B, 8, 53] -> quaternions [B, 9, 24, 4], roots off the straight line
    between the key roots [B, 9, 3] and the way between those over the floor [B, 2], metres."""

    def __init__(self, config: CurveConfig) -> None:
        if config.trunk:
            raise ValueError("frames are compared without the in-betweener, which gives curves of its own")
        super().__init__(config)
        self.turns = JointLinear(JOINT_COUNT, config.net.width, 3 * MOMENTS)
        self.path = nn.Linear(JOINT_COUNT * config.net.width, 2 + 3 * MOMENTS)
        for last in (self.turns, self.path):
            nn.init.zeros_(last.weight)
            nn.init.zeros_(last.bias)

    def forward(self, keys: Tensor, key_mask: Tensor, seconds: Tensor, music: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        _, sine, cosine, columns = self._level(keys)
        x = self._decode(columns, key_mask, seconds, music)
        turns = self.turns(x)[FROM_TREE].transpose(0, 1).unflatten(-1, (MOMENTS, 3))  # [B, J, 9, 3]
        start, end = keys[:, 1], keys[:, 2]
        end = end * torch.where((start * end).sum(-1, keepdim=True) < 0, -1.0, 1.0)
        turns = small_turn(torch.tanh(turns * GAIN) * (LARGEST_TURN / 2))
        poses = [product(slerp_at(start, end, (m + 0.5) / MOMENTS), turns[:, :, m]) for m in range(MOMENTS)]
        length = seconds[:, 1:2]
        path, offsets = (self.path(x.transpose(0, 1).flatten(1)) * GAIN).split((2, 3 * MOMENTS), -1)
        moved = self._to_world(torch.stack([path[:, :1] * length, length * 0, path[:, 1:] * length], -1), sine, cosine)[:, 0]
        offsets = self._to_world(offsets.unflatten(-1, (MOMENTS, 3)) * length[..., None], sine, cosine)
        return torch.stack(poses, 1), offsets, moved[:, [0, 2]]
