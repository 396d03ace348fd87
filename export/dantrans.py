"""DanTrans: the blocks that both stages of DanceFormer are made of (paper B, section 4.3).

Letters in shape comments: J = 24 joints in the order of the tree's levels (`TREE_ORDER`), B batch, N tokens, D width of a joint's
features, M music tokens, W width of the wave encoder.

Open points of the paper and how they are read here:
- A Kinematic Propagation Module is a stack of FK-IK blocks. FC (BatchNorm, Linear, ReLU) has weights of its own for each joint; what a
  joint gets from several children is added.
- Structured multi-head attention: a joint is a head with its own query, key and value layers; nothing is concatenated or mixed.
- The learned local mask is a learned number for each joint and distance, added before the softmax; beyond the reach nothing is seen.
- Layers add to their input (residual), attention reads it through a LayerNorm as transformers of today do.
BatchNorm has no scale and shift of its own (the Linear behind it has) and is folded into that Linear for export.
Attention is written as plain products: fused attention gives wrong answers on some WebGPU adapters.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import torch
from torch import Tensor, nn

from skeleton import LEVELS
from spec import JOINT_COUNT, PARENTS

TREE_ORDER = [joint for level in LEVELS for joint in level]
FROM_TREE = [TREE_ORDER.index(joint) for joint in range(JOINT_COUNT)]  # gathers tree order back into spec order
EPSILON = 1e-3
FAR = -3e4  # added before a softmax where nothing may be seen; it must fit into half precision


@dataclass
class DanTransConfig:
    """Sizes and the variants of the paper's Tables 2 and 3."""

    width: int = 48
    music_width: int = 96
    music_heads: int = 4
    music_layers: int = 2
    layers: int = 2
    body: str = "kpm"  # kpm | gnn | linear (Table 2)
    attention: str = "learned"  # learned | gaussian | local | global (Table 3)
    dropout: float = 0.1

    def as_dict(self) -> dict:
        return asdict(self)


class JointLinear(nn.Module):
    """A Linear for each joint (weights [J, in, out]): [J, R, in] -> [J, R, out]."""

    def __init__(self, joints: int, inputs: int, outputs: int) -> None:
        super().__init__()
        self.weight = nn.Parameter(torch.randn(joints, inputs, outputs) * inputs**-0.5)
        self.bias = nn.Parameter(torch.zeros(joints, 1, outputs))

    def forward(self, x: Tensor) -> Tensor:
        return torch.matmul(x, self.weight) + self.bias


class JointFc(nn.Module):
    """The paper's FC: BatchNorm, Linear, ReLU, with weights for each joint. [J, R, D] -> [J, R, D]."""

    momentum = 0.03

    def __init__(self, joints: int, width: int) -> None:
        super().__init__()
        self.linear = JointLinear(joints, width, width)
        nn.init.normal_(self.linear.weight, std=(2 / width) ** 0.5)
        self.register_buffer("mean", torch.zeros(joints, 1, width))
        self.register_buffer("variance", torch.ones(joints, 1, width))
        self.folded = False

    def forward(self, x: Tensor) -> Tensor:
        if self.folded:
            return torch.relu(self.linear(x))
        if self.training:
            variance, mean = torch.var_mean(x, 1, keepdim=True, correction=0)
            with torch.no_grad():
                self.mean.lerp_(mean, self.momentum)
                self.variance.lerp_(variance, self.momentum)
        else:
            mean, variance = self.mean, self.variance
        return torch.relu(self.linear((x - mean) * (variance + EPSILON).rsqrt()))

    @torch.no_grad()
    def fold(self) -> None:
        """Moves the normalisation into the Linear; for inference only."""
        if not self.folded:
            scale = (self.variance + EPSILON).rsqrt()
            self.linear.bias.sub_(torch.matmul(self.mean * scale, self.linear.weight))
            self.linear.weight.mul_(scale.transpose(1, 2))
            self.folded = True


def _kind(parents: list[int], count: int) -> str:
    """How a level's joints take from the `count` joints above: each from its own, all from one, or anyhow."""
    if parents == list(range(count)):
        return "own"
    return "one" if count == 1 else "any"


class FkIkBlock(nn.Module):
    """Forward pass of messages from the pelvis to the ends, then back (Figure 3). [J, R, D] -> [J, R, D]."""

    def __init__(self, width: int) -> None:
        super().__init__()
        self.down = nn.ModuleList(JointFc(len(level), width) for level in LEVELS)
        self.up = nn.ModuleList(JointFc(len(level), width) for level in LEVELS)
        self.sizes = [len(level) for level in LEVELS]
        self.parents = [[LEVELS[depth - 1].index(PARENTS[joint]) for joint in level] if depth else [] for depth, level in enumerate(LEVELS)]
        self.kinds = [_kind(parents, self.sizes[depth - 1]) for depth, parents in enumerate(self.parents)]
        for depth in range(1, len(LEVELS)):
            gather = torch.zeros(self.sizes[depth - 1], self.sizes[depth])
            gather[self.parents[depth], range(self.sizes[depth])] = 1
            self.register_buffer(f"children{depth}", gather, persistent=False)

    def forward(self, x: Tensor) -> Tensor:
        rows = x.split(self.sizes)
        passed = [self.down[0](rows[0])]
        for depth in range(1, len(LEVELS)):
            above = passed[-1]
            taken = above if self.kinds[depth] != "any" else self._mix(getattr(self, f"children{depth}").T, above)
            passed.append(self.down[depth](rows[depth] + taken))
        back = [self.up[-1](passed[-1])]
        for depth in range(len(LEVELS) - 2, -1, -1):
            below = back[0]
            if self.kinds[depth + 1] == "any":
                below = self._mix(getattr(self, f"children{depth + 1}"), below)
            elif self.kinds[depth + 1] == "one":
                below = below.sum(0, keepdim=True)
            back.insert(0, self.up[depth](passed[depth] + below))
        return torch.cat(back)

    @staticmethod
    def _mix(weights: Tensor, x: Tensor) -> Tensor:
        return torch.matmul(weights, x.flatten(1)).unflatten(1, (-1, x.shape[2]))


class GnnBlock(nn.Module):
    """Two graph layers over the undirected tree, for the ablation "KPM to GNN". [J, R, D] -> [J, R, D]."""

    def __init__(self, width: int) -> None:
        super().__init__()
        adjacency = torch.eye(JOINT_COUNT)
        for joint, parent in enumerate(PARENTS):
            if parent >= 0:
                a, b = FROM_TREE[joint], FROM_TREE[parent]
                adjacency[a, b] = adjacency[b, a] = 1
        self.register_buffer("adjacency", adjacency / adjacency.sum(1, keepdim=True), persistent=False)
        self.layers = nn.ModuleList(JointFc(JOINT_COUNT, width) for _ in range(2))

    def forward(self, x: Tensor) -> Tensor:
        for layer in self.layers:
            x = layer(torch.matmul(self.adjacency, x.flatten(1)).unflatten(1, (-1, x.shape[2])))
        return x


class LinearBlock(nn.Module):
    """The feed-forward network of a vanilla transformer over the whole body, for the ablation "KPM to linear"."""

    def __init__(self, width: int) -> None:
        super().__init__()
        hidden = 8 * width
        self.norm = nn.BatchNorm1d(JOINT_COUNT * width)
        self.net = nn.Sequential(nn.Linear(JOINT_COUNT * width, hidden), nn.ReLU(), nn.Linear(hidden, JOINT_COUNT * width))

    def forward(self, x: Tensor) -> Tensor:
        flat = x.permute(1, 0, 2).flatten(1)
        return self.net(self.norm(flat)).unflatten(1, (JOINT_COUNT, x.shape[2])).permute(1, 0, 2)


def body_module(config: DanTransConfig, blocks: int) -> nn.Module:
    """A KPM of so many blocks, or what stands in its place in the ablations."""
    block = {"kpm": FkIkBlock, "gnn": GnnBlock, "linear": LinearBlock}[config.body]
    return nn.Sequential(*(block(config.width) for _ in range(blocks)))


class Reach(nn.Module):
    """The additive attention mask over distances (key minus query) first..last: [heads, N, M].

    `learned`: a number for each head and distance (it starts as a triangle); `gaussian`: a fixed bell of a quarter of the reach;
    `local`: 0 within; `global`: 0 everywhere. What is beyond is `FAR`.
    """

    def __init__(self, heads: int, first: int, last: int, kind: str) -> None:
        super().__init__()
        self.first, self.last, self.kind = first, last, kind
        distance = torch.arange(first, last + 1).abs().float()
        furthest = max(1.0, float(distance.max()))
        if kind == "learned":
            self.mask = nn.Parameter((-distance / furthest).repeat(heads, 1))
        else:
            bell = -(distance**2) / (2 * (furthest / 2) ** 2) if kind == "gaussian" else torch.zeros_like(distance)
            self.register_buffer("mask", bell.repeat(heads, 1), persistent=False)

    def forward(self, distance: Tensor, causal: bool = False) -> Tensor:
        """`distance` [N, M] whole numbers, key minus query."""
        inside = (distance >= self.first) & (distance <= self.last)
        values = self.mask[:, (distance - self.first).clamp(0, self.last - self.first)]
        if self.kind == "global":
            nothing = torch.zeros_like(values)
            return nothing + torch.where(distance > 0, FAR, 0.0) if causal else nothing
        return torch.where(inside, values, FAR)


class StructuredAttention(nn.Module):
    """Structured multi-head attention: each joint attends for itself. [J, B, N, D] -> [J, B, N, D].

    Over the joint's own tokens, or over music [B, M, W] (`music_width`), whose keys and values each joint computes itself.
    """

    def __init__(self, config: DanTransConfig, music_width: int = 0) -> None:
        super().__init__()
        self.width, self.over_music = config.width, music_width > 0
        self.norm = nn.LayerNorm(config.width)
        self.query = JointLinear(JOINT_COUNT, config.width, config.width)
        if self.over_music:
            self.key_value = nn.Linear(music_width, 2 * JOINT_COUNT * config.width)
        else:
            self.key_value = JointLinear(JOINT_COUNT, config.width, 2 * config.width)

    def forward(self, x: Tensor, mask: Tensor, music: Tensor | None = None) -> Tensor:  # mask broadcasts to [J, B, N, M]
        count = x.shape[2]
        normed = self.norm(x).flatten(1, 2)  # [J, B N, D]
        query = self.query(normed).unflatten(1, (-1, count)) * self.width**-0.5
        if self.over_music:
            key_value = self.key_value(music).unflatten(-1, (2, JOINT_COUNT, self.width))  # [B, M, 2, J, D]
            key, value = key_value.permute(2, 3, 0, 1, 4).unbind(0)
        else:
            key, value = self.key_value(normed).unflatten(1, (-1, count)).chunk(2, -1)
        weights = torch.softmax(torch.matmul(query, key.transpose(-1, -2)) + mask, -1)
        return torch.matmul(weights, value)


class DecoderLayer(nn.Module):
    """Self-attention, attention to the music, and a KPM of two blocks in place of the feed-forward network."""

    def __init__(self, config: DanTransConfig) -> None:
        super().__init__()
        self.self_attention = StructuredAttention(config)
        self.music_attention = StructuredAttention(config, config.music_width)
        self.body = body_module(config, 2)
        self.dropout = nn.Dropout(config.dropout)

    def forward(self, x: Tensor, mask: Tensor, music: Tensor, music_mask: Tensor) -> Tensor:  # [J, B, N, D]
        x = x + self.dropout(self.self_attention(x, mask))
        x = x + self.dropout(self.music_attention(x, music_mask, music))
        return x + self.dropout(self.body(x.flatten(1, 2))).unflatten(1, (-1, x.shape[2]))


class WaveEncoder(nn.Module):
    """The transformer over music tokens [B, M, inputs] -> [B, M, W]; `mask` [heads, M, M] is added before the softmax."""

    def __init__(self, config: DanTransConfig, inputs: int) -> None:
        super().__init__()
        width = config.music_width
        self.heads = config.music_heads
        self.embed = nn.Linear(inputs, width)
        self.norms = nn.ModuleList(nn.LayerNorm(width) for _ in range(2 * config.music_layers + 1))
        self.qkv = nn.ModuleList(nn.Linear(width, 3 * width) for _ in range(config.music_layers))
        self.out = nn.ModuleList(nn.Linear(width, width) for _ in range(config.music_layers))
        self.feed = nn.ModuleList(
            nn.Sequential(nn.Linear(width, 2 * width), nn.ReLU(), nn.Linear(2 * width, width)) for _ in range(config.music_layers)
        )
        self.dropout = nn.Dropout(config.dropout)

    def encode(self, x: Tensor, mask: Tensor) -> Tensor:
        """Embedded tokens [B, M, W] through all layers."""
        size = x.shape[-1] // self.heads
        for layer, (qkv, out, feed) in enumerate(zip(self.qkv, self.out, self.feed)):
            split = qkv(self.norms[2 * layer](x)).unflatten(-1, (3, self.heads, size)).permute(2, 0, 3, 1, 4)
            query, key, value = split.unbind(0)  # [B, H, M, W/H]
            weights = torch.softmax(torch.matmul(query * size**-0.5, key.transpose(-1, -2)) + mask, -1)
            x = x + self.dropout(out(torch.matmul(weights, value).transpose(1, 2).flatten(2)))
            x = x + self.dropout(feed(self.norms[2 * layer + 1](x)))
        return self.norms[-1](x)


def fold_norms(model: nn.Module) -> nn.Module:
    """Folds every BatchNorm of joint layers into the Linear behind it; the model is for inference afterwards."""
    for module in model.modules():
        if isinstance(module, JointFc):
            module.fold()
    return model.eval()
