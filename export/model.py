"""The key-pose dance transformer in one file (paper: "Music-driven Dance Regeneration with Controllable Key Pose Constraints").

Letters in shape comments: B batch, S seed frames (T' of the paper), T music frames, D width, H heads, J = 24 joints, P frames in
a patch, N tokens.

What is added to the paper, and why:
- The output is a residual over a base motion through the key poses, with a zero-initialised head: SLERP, bent by a learned
  in-betweener (inbetween.py), or SLERP alone. Between keys the base is what a transformer otherwise spends its training on.
- Each frame also sees its base pose and the steps between the two anchors on either side, in the body's own frame (E^B
  below). Eq. 6 alone puts a pose at the key's frame only, and attention takes long to find out how to carry it over.
- A token may stand for a patch of neighbouring frames: poses 33 ms apart differ little, and a third of the tokens is a third
  of the work in training and in the browser. `patch=1` is the paper's one token a frame.
- Inputs are standardised by means and deviations of the training data, kept in the model.
- The pelvis path is integrated from a velocity in the body's heading, so it does not depend on where the window faces.
- Layers start as the identity (their output projections are zero), so a short run may train the first ones alone and
  let the others join later at no loss (`set_depth`): on a CPU most of the learning then costs a third.
- The residual is low-passed over time (`smooth`): bodies do not tremble at 10 Hz, half-trained networks do.
- Pre-norm layers. Eq. 1 divides by sqrt(D); here D is the width of one head, as in the transformer it cites.
Attention is written as plain products: fused attention gives wrong answers on some WebGPU adapters.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field

import torch
from torch import Tensor, nn

from anchors import GAP_FEATURES, POSE_FEATURES, Base, find_base, turn_columns
from inbetween import Inbetweener, InbetweenConfig, level_heading
from spec import FEATURE_COUNT, FPS, MAX_FRAMES, MOTION_SIZE, ROTATION_SIZE

INPUT_NAMES = ("music", "seed", "key_poses", "key_mask", "to_previous", "to_next")
OUTPUT_NAME = "motion"


@dataclass
class ModelConfig:
    """Sizes. `light` is what the browser runs, `large` is the paper's large model."""

    width: int = 256
    heads: int = 4
    feedforward: int = 1024
    encoder_layers: int = 4
    cross_layers: int = 8
    dropout: float = 0.05
    patch: int = 3
    max_frames: int = MAX_FRAMES
    inbetween: InbetweenConfig | None = field(default_factory=InbetweenConfig)

    def __post_init__(self) -> None:
        if isinstance(self.inbetween, dict):
            self.inbetween = InbetweenConfig(**self.inbetween)

    @staticmethod
    def named(name: str) -> "ModelConfig":
        """`light`, `large` or `tiny` (for tests only)."""
        if name == "light":
            return ModelConfig()
        if name == "large":
            return ModelConfig(width=800, heads=10, feedforward=3200, cross_layers=12, dropout=0.1)
        if name == "tiny":
            small = InbetweenConfig(width=16, hidden=16, blocks=1, knots=4)
            return ModelConfig(32, 2, 64, encoder_layers=1, cross_layers=1, dropout=0.0, inbetween=small)
        raise ValueError(f"no model config named {name!r}: choose light, large or tiny")

    def as_dict(self) -> dict:
        return asdict(self)


def positional_encoding(rows: int, width: int) -> Tensor:
    """Eq. 7: PE [rows, width], sine in even and cosine in odd columns. Computed in float64, then rounded once."""
    position = torch.arange(rows, dtype=torch.float64)[:, None]
    rate = torch.exp(torch.arange(0, width, 2, dtype=torch.float64) * (-math.log(10000.0) / width))
    table = torch.zeros(rows, width, dtype=torch.float64)
    table[:, 0::2] = torch.sin(position * rate)
    table[:, 1::2] = torch.cos(position * rate)
    return table.float()


class Attention(nn.Module):
    """Eq. 1-2 with several heads: softmax(Q K^T / sqrt(D / H)) V."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        self.heads, self.head_width = config.heads, config.width // config.heads
        self.query_key_value = nn.Linear(config.width, 3 * config.width)
        self.out = nn.Linear(config.width, config.width)

    def forward(self, x: Tensor) -> Tensor:  # [B, N, D] -> [B, N, D]
        qkv = self.query_key_value(x).unflatten(-1, (3, self.heads, self.head_width))  # [B, N, 3, H, D/H]
        query, key, value = qkv.permute(2, 0, 3, 1, 4).unbind(0)  # each [B, H, N, D/H]
        weights = torch.softmax((query * self.head_width**-0.5) @ key.transpose(-1, -2), -1)  # [B, H, N, N]
        return self.out((weights @ value).transpose(1, 2).flatten(2))


class Layer(nn.Module):
    """A pre-norm transformer layer: full attention among all frames, then the feed-forward network."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        self.norm1, self.norm2 = nn.LayerNorm(config.width), nn.LayerNorm(config.width)
        self.attention = Attention(config)
        self.feedforward = nn.Sequential(
            nn.Linear(config.width, config.feedforward), nn.ReLU(), nn.Linear(config.feedforward, config.width)
        )
        self.dropout = nn.Dropout(config.dropout)
        for last in (self.attention.out, self.feedforward[2]):
            nn.init.zeros_(last.weight)
            nn.init.zeros_(last.bias)

    def forward(self, x: Tensor) -> Tensor:  # [B, N, D] -> [B, N, D]
        x = x + self.dropout(self.attention(self.norm1(x)))
        return x + self.dropout(self.feedforward(self.norm2(x)))


class Encoder(nn.Module):
    """A stack of layers with a last normalisation: F_Tr of eq. 3, 4 and 12."""

    def __init__(self, config: ModelConfig, layers: int) -> None:
        super().__init__()
        self.layers = nn.ModuleList(Layer(config) for _ in range(layers))
        self.norm = nn.LayerNorm(config.width)
        self.depth = layers  # how many layers run; the others must still be the identity

    def forward(self, x: Tensor) -> Tensor:  # [B, N, D] -> [B, N, D]
        for layer in self.layers[: self.depth]:
            x = layer(x)
        return self.norm(x)


class LocalPositionalEmbedding(nn.Module):
    """Eq. 8-10: [PE(|t - t_i|), PE(|t - t_j|)] of the key poses on either side, half the width each; a learned row where none is."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        half = config.width // 2
        self.register_buffer("table", positional_encoding(config.max_frames, half), persistent=False)
        self.no_previous = nn.Parameter(torch.randn(half) * 0.5)
        self.no_next = nn.Parameter(torch.randn(half) * 0.5)

    def forward(self, to_previous: Tensor, to_next: Tensor) -> Tensor:  # [B, T], [B, T] -> [B, T, D]
        left = torch.where(to_previous[..., None] < 0, self.no_previous, self._rows(to_previous))
        right = torch.where(to_next[..., None] < 0, self.no_next, self._rows(to_next))
        return torch.cat([left, right], -1)

    def _rows(self, distance: Tensor) -> Tensor:
        index = distance.clamp(0, self.table.shape[0] - 1).round().long()
        return nn.functional.embedding(index, self.table)

    def seed_rows(self) -> Tensor:  # [D]: the seed has no key pose on either side
        return torch.cat([self.no_previous, self.no_next])


class Standardise(nn.Module):
    """(x - mean) / deviation with constants of the training data, limited to +-6 so that a strange pose stays bearable."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(size))
        self.register_buffer("scale", torch.ones(size))

    def fit(self, samples: Tensor) -> None:
        """Sets the constants from samples [N, size]; numbers that hardly vary (hands, toes) are only centred."""
        deviation = samples.std(0)
        self.mean.copy_(samples.mean(0))
        self.scale.copy_(torch.where(deviation < 0.03, torch.ones_like(deviation), 1 / deviation.clamp_min(1e-6)))

    def forward(self, x: Tensor) -> Tensor:
        return ((x - self.mean) * self.scale).clamp(-6, 6)


# Gaussian of one frame's deviation: halves at 5.6 Hz, a tenth is left at 10 Hz.
_KERNEL = (0.0545, 0.2442, 0.4026, 0.2442, 0.0545)


def smooth(x: Tensor) -> Tensor:
    """[B, T, n] low-passed over T; the first and last frame are repeated past the ends."""
    reach, frames = len(_KERNEL) // 2, x.shape[1]
    padded = torch.cat([x[:, :1]] * reach + [x] + [x[:, -1:]] * reach, 1)
    return sum(weight * padded[:, k : k + frames] for k, weight in enumerate(_KERNEL))


def patches(x: Tensor, size: int, frames: int, from_end: bool = False) -> Tensor:
    """[B, T, n] -> [B, N, size * n] with N = T / size rounded up. What is missing is the last frame (`from_end`: the first).

    `frames` is T, taken of an input of the model: the ONNX exporter loses track of the lengths of computed tensors.
    """
    if size == 1:
        return x
    width = x.shape[2]
    count = (frames + size - 1) // size
    index = torch.arange(count * size, device=x.device)
    index = (index + frames - count * size).clamp(min=0) if from_end else index.clamp(max=frames - 1)
    return x[:, index].reshape(-1, count, size * width)


class KeyPoseDancer(nn.Module):
    """Music, seed motion and key poses -> motion (eq. 3-12). See the module's docstring for what is added to the paper."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        self.config = config
        width, size = config.width, config.patch
        self.inbetweener = Inbetweener(config.inbetween) if config.inbetween else None
        self.embed_music = nn.Linear(size * FEATURE_COUNT, width)  # phi_a
        self.embed_motion = nn.Linear(size * MOTION_SIZE, width)  # phi_p
        self.embed_key = nn.Linear(size * (ROTATION_SIZE + 1), width)  # phi of eq. 6
        base_size = size * POSE_FEATURES + GAP_FEATURES
        self.embed_base = nn.Linear(base_size, width)
        # The base must be heard beside the unit-sized music code and the two positional encodings it is added to.
        nn.init.normal_(self.embed_base.weight, std=2 * base_size**-0.5)
        self.motion_scale = Standardise(MOTION_SIZE)
        self.pose_scale, self.steps_scale = Standardise(POSE_FEATURES), Standardise(GAP_FEATURES)
        self.music_encoder = Encoder(config, config.encoder_layers)
        self.motion_encoder = Encoder(config, config.encoder_layers)
        self.cross_encoder = Encoder(config, config.cross_layers)
        self.local = LocalPositionalEmbedding(config)
        tokens = config.max_frames // size + 2  # seed and music each round up
        self.register_buffer("positions", positional_encoding(tokens, width), persistent=False)
        self.head = nn.Linear(width, size * MOTION_SIZE)  # phi_o
        nn.init.zeros_(self.head.weight)
        nn.init.zeros_(self.head.bias)

    def forward(
        self, music: Tensor, seed: Tensor, key_poses: Tensor, key_mask: Tensor, to_previous: Tensor, to_next: Tensor
    ) -> Tensor:
        """[B, T, 15], [B, S, 147], [B, T, 144], [B, T], [B, T], [B, T] -> motion [B, T, 147], its 6D orthonormal."""
        frames, size = music.shape[1], self.config.patch
        music_tokens = self.embed_music(patches(music, size, frames))
        seed_tokens = self.embed_motion(patches(self.motion_scale(seed), size, seed.shape[1], from_end=True))
        count, seed_count = music_tokens.shape[1], seed_tokens.shape[1]
        music_code = self.music_encoder(music_tokens + self.positions[:count])  # E^A, eq. 3
        seed_code = self.motion_encoder(seed_tokens + self.positions[:seed_count])  # E^M, eq. 4
        base = find_base(seed, key_poses, to_previous, to_next, self.inbetweener)
        # Eq. 11: E^P and PE^L exist for the T music frames; the seed gets zero and the sentinel.
        tokens = music_code + self._embed_keys(key_poses, key_mask) + self._embed_local(to_previous, to_next)
        tokens = tokens + self._embed_base(base, frames)
        joint = torch.cat([seed_code + self.local.seed_rows(), tokens], 1) + self.positions[: seed_count + count]
        output = self.cross_encoder(joint)[:, seed_count:]  # only the T music frames are supervised and emitted
        residual = self.head(output).reshape(-1, count * size, MOTION_SIZE)[:, :frames]
        return self._compose(smooth(residual), base)

    def set_depth(self, encoders: int, cross: int) -> None:
        """Runs only the first layers of each stack. Exact as long as the layers left out have not been trained."""
        self.music_encoder.depth = self.motion_encoder.depth = encoders
        self.cross_encoder.depth = cross

    @torch.no_grad()
    def fit_inputs(self, batches: list[dict[str, Tensor]]) -> None:
        """Takes the constants of the input standardisation from training batches."""
        names = ("seed", "key_poses", "to_previous", "to_next")
        bases = [find_base(*(batch[name] for name in names), self.inbetweener) for batch in batches]
        self.pose_scale.fit(torch.cat([base.pose.flatten(0, 1) for base in bases]))
        self.steps_scale.fit(torch.cat([base.steps.flatten(0, 1) for base in bases]))
        self.motion_scale.fit(torch.cat([batch["seed"].flatten(0, 1) for batch in batches]))

    def _embed_keys(self, key_poses: Tensor, key_mask: Tensor) -> Tensor:  # [B, T, 144], [B, T] -> E^P [B, N, D], eq. 5-6
        scale = self.motion_scale
        poses = ((key_poses - scale.mean[:ROTATION_SIZE]) * scale.scale[:ROTATION_SIZE]).clamp(-6, 6)
        # The mask stands beside the pose, so that a patch tells which of its frames is the key.
        marked = torch.cat([poses, torch.ones_like(poses[..., :1])], -1) * key_mask[..., None]
        return self.embed_key(patches(marked, self.config.patch, key_mask.shape[1]))

    def _embed_local(self, to_previous: Tensor, to_next: Tensor) -> Tensor:  # [B, T] x 2 -> PE^L [B, N, D], eq. 8-10
        size, width = self.config.patch, self.config.width
        rows = patches(self.local(to_previous, to_next), size, to_next.shape[1])
        return rows.unflatten(-1, (size, width)).mean(-2) if size > 1 else rows

    def _embed_base(self, base: Base, frames: int) -> Tensor:  # E^B [B, N, D]
        size = self.config.patch
        poses, steps = (patches(scale(x), size, frames) for scale, x in ((self.pose_scale, base.pose), (self.steps_scale, base.steps)))
        middle = size // 2 * GAP_FEATURES
        return self.embed_base(torch.cat([poses, steps[..., middle : middle + GAP_FEATURES]], -1))

    def _compose(self, residual: Tensor, base: Base) -> Tensor:
        """Residual numbers [B, T, 147] on the base -> motion [B, T, 147]: R = R_base GramSchmidt(I + residual)."""
        first, second, _ = turn_columns(base.columns, residual[..., :ROTATION_SIZE])
        rotations = torch.cat([first, second], -1).flatten(-2)
        return torch.cat([rotations, self._root(residual[..., ROTATION_SIZE:], base)], -1)

    def _root(self, residual: Tensor, base: Base) -> Tensor:
        """Height as an offset from the base's; x and z as the sum of velocities in the base's heading."""
        side, up, forward = residual.split(1, -1)  # metres per second, metres, metres per second
        base_side, base_forward = base.velocity.split(1, -1)
        side, forward = side + base_side, forward + base_forward
        facing = base.columns[2][:, :, 0]  # [B, T, 3] forward axis of the base pelvis
        sine, cosine = level_heading(facing)
        velocity = torch.cat([cosine * side + sine * forward, cosine * forward - sine * side], -1) / FPS
        path = torch.cumsum(velocity, 1)
        return base.root + torch.cat([path[..., :1], up, path[..., 1:]], -1)


def count_weights(model: nn.Module) -> int:
    """Number of trained numbers."""
    return sum(parameter.numel() for parameter in model.parameters())
