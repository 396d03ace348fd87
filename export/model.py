"""The key-pose dance transformer in one file (paper: "Music-driven Dance Regeneration with Controllable Key Pose Constraints").

Letters in shape comments: B batch, S seed frames (T' of the paper), T music frames, D width, H heads, J = 24 joints.

What is added to the paper, and why:
- The output is a residual over SLERP between the neighbouring key poses (the "base"), with a zero-initialised head, so an
  untrained model already equals that baseline. Between keys the base is what a transformer otherwise spends its training on.
- Each frame also sees its base pose and the steps between the two anchors on either side, in the body's own frame (E^B
  below). Eq. 6 alone puts a pose at the key's frame only, and attention takes long to find out how to carry it over.
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
from dataclasses import asdict, dataclass

import torch
from torch import Tensor, nn

from rotation import gram_schmidt, matrix_to_quaternion, quaternion_to_matrix, slerp, unit
from spec import FEATURE_COUNT, FPS, JOINT_COUNT, MAX_FRAMES, MOTION_SIZE, ROTATION_SIZE

INPUT_NAMES = ("music", "seed", "key_poses", "key_mask", "to_previous", "to_next")
OUTPUT_NAME = "motion"
_LIMBS = ROTATION_SIZE - 6  # 6D numbers of the joints other than the pelvis
_STEP = _LIMBS + 6  # one anchor to the next
_BASE_SIZE = _LIMBS + 3 + 3 * _STEP + 6
SHORTEST_SEED = 16  # frames; the course of the last half second tells where the first stretch comes from


@dataclass
class ModelConfig:
    """Sizes. `light` is what the browser runs, `large` is the paper's large model."""

    width: int = 256
    heads: int = 4
    feedforward: int = 1024
    encoder_layers: int = 4
    cross_layers: int = 8
    dropout: float = 0.05
    max_frames: int = MAX_FRAMES

    @staticmethod
    def named(name: str) -> "ModelConfig":
        """`light`, `large` or `tiny` (for tests only)."""
        if name == "light":
            return ModelConfig()
        if name == "large":
            return ModelConfig(width=800, heads=10, feedforward=3200, cross_layers=12, dropout=0.1)
        if name == "tiny":
            return ModelConfig(width=32, heads=2, feedforward=64, encoder_layers=1, cross_layers=1, dropout=0.0)
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


@dataclass
class Base:
    """What is known of each frame before the network: SLERP between its anchors."""

    columns: tuple[Tensor, Tensor, Tensor]  # columns of the base rotations, each [B, T, J, 3]
    features: Tensor  # [B, T, _BASE_SIZE], free of the window's heading
    root: Tensor  # [B, T, 3]: the last seed frame's


def interpolation_base(seed: Tensor, key_poses: Tensor, to_previous: Tensor, to_next: Tensor) -> Base:
    """SLERP from the key before (or the last seed frame, t + 1 frames back) to the key after (none: the pose holds)."""
    batch, frames = to_previous.shape
    t = torch.arange(frames, device=seed.device)
    first_row = (torch.arange(batch, device=seed.device) * frames)[:, None]

    def look_up(table: Tensor, index: Tensor) -> Tensor:  # [B, T, n] at [B, T] -> [B, T, n]
        # Embedding look-up on the flattened table exports to one Gather, which every backend has.
        return nn.functional.embedding(first_row + index.clamp(0, frames - 1), table.reshape(batch * frames, -1))

    last = seed[:, -1:, :ROTATION_SIZE]
    earlier = seed[:, -SHORTEST_SEED:][:, :1, :ROTATION_SIZE]
    has_previous, has_next = to_previous >= 0, to_next >= 0
    at_previous, at_next = t - to_previous.long(), t + to_next.long()
    before = torch.where(has_previous[..., None], look_up(key_poses, at_previous), last)
    after = torch.where(has_next[..., None], look_up(key_poses, at_next), before)
    back = torch.where(has_previous, to_previous, (t + 1).to(to_previous))
    ahead = to_next.clamp(min=0)
    # At a key both distances are 0 (and both anchors are that key), hence the floor of 1.
    fraction = back / (back + ahead).clamp(min=1)
    fraction = torch.where(has_next, fraction, torch.zeros_like(fraction))

    # One anchor further on each side: where the motion comes from and where it will go.
    more_back = look_up(to_previous[..., None], at_previous - 1)[..., 0]
    has_earlier = has_previous & (at_previous > 0) & (more_back >= 0)
    from_seed = torch.where(has_previous[..., None], last.expand(-1, frames, -1), earlier)
    earlier_pose = torch.where(has_earlier[..., None], look_up(key_poses, at_previous - 1 - more_back.long()), from_seed)
    gap_from_seed = torch.where(has_previous, (at_previous + 1).to(to_previous), torch.full_like(back, SHORTEST_SEED - 1))
    gap_back = torch.where(has_earlier, more_back + 1, gap_from_seed)
    more_ahead = look_up(to_next[..., None], at_next + 1)[..., 0]
    has_later = has_next & (at_next < frames - 1) & (more_ahead >= 0)
    later_pose = torch.where(has_later[..., None], look_up(key_poses, at_next + 1 + more_ahead.long()), after)
    gap_ahead = torch.where(has_later, more_ahead + 1, torch.zeros_like(more_ahead))

    poses = [_orthonormal(pose) for pose in (earlier_pose, before, after, later_pose)]
    mixed = slerp(matrix_to_quaternion(poses[1]), matrix_to_quaternion(poses[2]), fraction[..., None, None])
    base = quaternion_to_matrix(mixed)  # [B, T, J, 3, 3]
    column0, column1, column2 = base.unbind(-1)
    limbs = torch.cat([column0[:, :, 1:], column1[:, :, 1:]], -1).flatten(-2)
    up = base[:, :, 0, 1, :]  # the world's up axis in the body's frame
    steps = [_step(a, b) for a, b in zip(poses, poses[1:])]
    times = torch.stack([fraction, has_previous.to(back), has_next.to(back)], -1)
    gaps = torch.stack([gap_back, back + ahead, gap_ahead], -1) / FPS
    features = torch.cat([limbs, up, *steps, times, gaps], -1)
    root = seed[:, -1:, ROTATION_SIZE:].expand(-1, frames, -1)
    return Base((column0, column1, column2), features, root)


def _orthonormal(rotations: Tensor) -> Tensor:  # [B, T, 144] -> [B, T, J, 3, 3]
    six_d = rotations.unflatten(-1, (JOINT_COUNT, 6))
    return torch.stack(gram_schmidt(six_d[..., :3], six_d[..., 3:]), -1)


def _step(a: Tensor, b: Tensor) -> Tensor:  # two [B, T, J, 3, 3] -> [B, T, _STEP]
    """Change of the limbs' rotations, and the pelvis's turn in its own frame."""
    limbs = (b - a)[:, :, 1:, :, :2].transpose(-1, -2).flatten(-3)
    turn = a[:, :, 0].transpose(-1, -2) @ b[:, :, 0]
    return torch.cat([limbs, turn[..., 0], turn[..., 1]], -1)


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


class KeyPoseDancer(nn.Module):
    """Music, seed motion and key poses -> motion (eq. 3-12). See the module's docstring for what is added to the paper."""

    def __init__(self, config: ModelConfig) -> None:
        super().__init__()
        self.config = config
        width = config.width
        self.embed_music = nn.Linear(FEATURE_COUNT, width)  # phi_a
        self.embed_motion = nn.Linear(MOTION_SIZE, width)  # phi_p
        self.embed_key = nn.Linear(ROTATION_SIZE, width)  # phi of eq. 6
        self.embed_base = nn.Linear(_BASE_SIZE, width)
        # The base must be heard beside the unit-sized music code and the two positional encodings it is added to.
        nn.init.normal_(self.embed_base.weight, std=2 * _BASE_SIZE**-0.5)
        self.motion_scale, self.base_scale = Standardise(MOTION_SIZE), Standardise(_BASE_SIZE)
        self.music_encoder = Encoder(config, config.encoder_layers)
        self.motion_encoder = Encoder(config, config.encoder_layers)
        self.cross_encoder = Encoder(config, config.cross_layers)
        self.local = LocalPositionalEmbedding(config)
        self.register_buffer("positions", positional_encoding(config.max_frames, width), persistent=False)
        self.head = nn.Linear(width, MOTION_SIZE)  # phi_o
        nn.init.zeros_(self.head.weight)
        nn.init.zeros_(self.head.bias)

    def forward(
        self, music: Tensor, seed: Tensor, key_poses: Tensor, key_mask: Tensor, to_previous: Tensor, to_next: Tensor
    ) -> Tensor:
        """[B, T, 15], [B, S, 147], [B, T, 144], [B, T], [B, T], [B, T] -> motion [B, T, 147], its 6D orthonormal."""
        seed_frames, frames = seed.shape[1], music.shape[1]
        music_code = self.music_encoder(self.embed_music(music) + self.positions[:frames])  # E^A, eq. 3
        seed_code = self.motion_encoder(self.embed_motion(self.motion_scale(seed)) + self.positions[:seed_frames])  # E^M, eq. 4
        base = interpolation_base(seed, key_poses, to_previous, to_next)
        keys = self._embed_keys(key_poses) * key_mask[..., None]  # E^P, eq. 5-6
        # Eq. 11: E^P and PE^L exist for the T music frames; the seed gets zero and the sentinel.
        frames_code = music_code + keys + self.local(to_previous, to_next) + self.embed_base(self.base_scale(base.features))
        joint = torch.cat([seed_code + self.local.seed_rows(), frames_code], 1) + self.positions[: seed_frames + frames]
        output = self.cross_encoder(joint)[:, seed_frames:]  # only the T music frames are supervised and emitted
        return self._compose(smooth(self.head(output)), base)

    def set_depth(self, encoders: int, cross: int) -> None:
        """Runs only the first layers of each stack. Exact as long as the layers left out have not been trained."""
        self.music_encoder.depth = self.motion_encoder.depth = encoders
        self.cross_encoder.depth = cross

    @torch.no_grad()
    def fit_inputs(self, batches: list[dict[str, Tensor]]) -> None:
        """Takes the constants of the input standardisation from training batches."""
        names = ("seed", "key_poses", "to_previous", "to_next")
        bases = [interpolation_base(*(batch[name] for name in names)).features for batch in batches]
        self.base_scale.fit(torch.cat([base.flatten(0, 1) for base in bases]))
        self.motion_scale.fit(torch.cat([batch["seed"].flatten(0, 1) for batch in batches]))

    def _embed_keys(self, key_poses: Tensor) -> Tensor:  # [B, T, 144] -> [B, T, D]
        scale = self.motion_scale
        poses = (key_poses - scale.mean[:ROTATION_SIZE]) * scale.scale[:ROTATION_SIZE]
        return self.embed_key(poses.clamp(-6, 6))

    def _compose(self, residual: Tensor, base: Base) -> Tensor:
        """Residual numbers [B, T, 147] on the base -> motion [B, T, 147]: R = R_base GramSchmidt(I + residual)."""
        six_d = residual[..., :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 6))
        identity = residual.new_tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
        delta0, delta1, _ = gram_schmidt(*(six_d + identity).split(3, -1))
        column0, column1, column2 = base.columns
        turned = [
            column0 * delta[..., :1] + column1 * delta[..., 1:2] + column2 * delta[..., 2:] for delta in (delta0, delta1)
        ]
        rotations = torch.cat(turned, -1).flatten(-2)
        return torch.cat([rotations, self._root(residual[..., ROTATION_SIZE:], base)], -1)

    def _root(self, residual: Tensor, base: Base) -> Tensor:
        """Height as an offset from the last seed frame; x and z as the sum of velocities in the base's heading."""
        side, up, forward = residual.split(1, -1)  # metres per second, metres, metres per second
        facing = base.columns[2][:, :, 0]  # [B, T, 3] forward axis of the base pelvis
        flat = unit(torch.cat([facing[..., :1], facing[..., 2:]], -1))
        sine, cosine = flat.split(1, -1)
        velocity = torch.cat([cosine * side + sine * forward, cosine * forward - sine * side], -1) / FPS
        path = torch.cumsum(velocity, 1)
        return base.root + torch.cat([path[..., :1], up, path[..., 1:]], -1)


def count_weights(model: nn.Module) -> int:
    """Number of trained numbers."""
    return sum(parameter.numel() for parameter in model.parameters())
