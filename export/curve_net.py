"""Stage 2 of DanceFormer: the curves between key poses (paper B, section 4.2). One interval is one item of the batch.

The paper decodes interval after interval from the ones before. Here an interval sees the key poses on either side of its own two instead:
all intervals of a song are one batch, and a change of one key pose changes at most four of them.

With `trunk`, the in-betweener of the light model (inbetween.py, trained before and kept as it is) bends the SLERP first and the DanTrans
learns what is left: minutes of training on a CPU then go further. Only its curve at the two inner knots is needed, so its last layer is
folded to those. Without it the inner knots start on the SLERP.

Decoder tokens are the two key poses, each told with the other one and with its neighbour outside; the music is eight moments of the interval. The inner knots are a turn
each from the SLERP of the two key poses at 1/3 and 2/3, so that an untrained network gives the interpolation.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field

import torch
from torch import Tensor, nn

from dantrans import FROM_TREE, TREE_ORDER, DanTransConfig, DecoderLayer, JointLinear, WaveEncoder, body_module
from anchors import LIFT
from inbetween import Gap, Inbetweener, InbetweenConfig, body_joints, cubic_weights, gap_features, level_heading
from rotation import gram_schmidt, quaternion_to_matrix
from skeleton import forward_kinematics
from spec import JOINT_COUNT, ROTATION_SIZE, SPEC, TOE_HEIGHT, TOES
from suggest import turn_columns

PART = SPEC["danceformer"]
STEPS: int = PART["curve"]["intervalSteps"]
FEATURES = len(PART["featureNames"])
VALUES: list[str] = PART["curve"]["values"]
FRACTIONS: tuple[float, float] = tuple(PART["curve"]["innerFractions"])
INPUTS = ("keys", "key_mask", "seconds", "music")
OUTPUTS = ("curves", "root")

TOKENS = 2
INNER = 2
SHARED = 3 * 2 + 2  # three lengths in two forms, two flags
JOINT_INPUTS = 6 + 6 + 6 + SHARED + TOKENS
LARGEST_SHAPE = 0.9  # of tension, continuity, bias
GAIN = 0.3  # of the last layers' numbers: their steps must not be large beside what they mean
LARGEST_TURN = 1.5  # radians that an inner knot may leave the SLERP by


@dataclass
class CurveConfig:
    """Sizes."""

    net: DanTransConfig = field(default_factory=DanTransConfig)
    trunk: InbetweenConfig | None = None

    def __post_init__(self) -> None:
        if isinstance(self.net, dict):
            self.net = DanTransConfig(**self.net)
        if isinstance(self.trunk, dict):
            self.trunk = InbetweenConfig(**self.trunk)

    def as_dict(self) -> dict:
        return asdict(self)


def product(a: Tensor, b: Tensor) -> Tensor:
    """Quaternion product a b [..., 4], x y z w, as plain multiplications."""
    ax, ay, az, aw = a.split(1, -1)
    bx, by, bz, bw = b.split(1, -1)
    return torch.cat(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        -1,
    )


def slerp_at(a: Tensor, b: Tensor, fraction: float) -> Tensor:
    """SLERP of quaternions [..., 4] whose signs agree already."""
    dot = (a * b).sum(-1, keepdim=True).clamp(-1, 0.9995)
    angle = torch.acos(dot)
    sine = torch.sin(angle).clamp_min(1e-6)
    mixed = a * (torch.sin((1 - fraction) * angle) / sine) + b * (torch.sin(fraction * angle) / sine)
    return mixed / (mixed * mixed).sum(-1, keepdim=True).clamp_min(1e-12).sqrt()


def small_turn(vector: Tensor) -> Tensor:
    """Half rotation vector [..., 3] -> unit quaternion [..., 4] along (v, 1): smooth, and no sine in the graph."""
    whole = torch.cat([vector, vector[..., :1] * 0 + 1], -1)
    return whole / (whole * whole).sum(-1, keepdim=True).sqrt()


def ground_height(matrices: Tensor) -> Tensor:
    """Pelvis height [...] at which the lower toe joint of a pose [..., 24, 3, 3] stands where a standing figure's does."""
    return TOE_HEIGHT - forward_kinematics(matrices)[..., TOES, 1].amin(-1)


def small_quaternion(six_d: Tensor) -> Tensor:
    """[..., 6] of a rotation well under half a turn -> quaternion [..., 4]: one algebraic form is enough there."""
    a, b, c = gram_schmidt(six_d[..., :3], six_d[..., 3:])
    w = (1 + a[..., :1] + b[..., 1:2] + c[..., 2:]).clamp_min(0.04).sqrt() / 2
    vector = torch.cat([b[..., 2:] - c[..., 1:2], c[..., :1] - a[..., 2:], a[..., 1:2] - b[..., :1]], -1) / (4 * w)
    whole = torch.cat([vector, w], -1)
    return whole / (whole * whole).sum(-1, keepdim=True).sqrt()


class Trunk(nn.Module):
    """The light model's in-betweener, asked at the two inner knots only, and never trained here."""

    def __init__(self, config: InbetweenConfig) -> None:
        super().__init__()
        whole = Inbetweener(config)
        self.register_buffer("mean", whole.mean)
        self.register_buffer("scale", whole.scale)
        self.enter, self.blocks, self.norm = whole.enter, whole.blocks, whole.norm
        self.turns = nn.Linear(config.width, INNER * ROTATION_SIZE)
        for parameter in self.parameters():
            parameter.requires_grad_(False)

    @torch.no_grad()
    def take(self, whole: Inbetweener) -> None:
        """Copies the weights of a trained one; its curve's knots are weighed to what they give at the inner knots."""
        self.mean.copy_(whole.mean)
        self.scale.copy_(whole.scale)
        for ours, theirs in ((self.enter, whole.enter), (self.blocks, whole.blocks), (self.norm, whole.norm)):
            ours.load_state_dict(theirs.state_dict())
        knots = whole.config.knots
        weights = cubic_weights(torch.tensor(FRACTIONS), knots)[:, 1:-1]  # [2, knots]
        self.turns.weight.copy_(torch.einsum("fk,kri->fri", weights, whole.turns.weight.unflatten(0, (knots, ROTATION_SIZE))).flatten(0, 1))
        self.turns.bias.copy_((weights @ whole.turns.bias.unflatten(0, (knots, ROTATION_SIZE))).flatten())

    def forward(self, matrices: Tensor, key_mask: Tensor, seconds: Tensor) -> tuple[Tensor, Tensor]:
        """[B, 4, 24, 3, 3], [B, 2], [B, 3] -> (quaternions that the SLERP is turned by [B, 2, 24, 4], features [B, width])."""
        joints = body_joints(matrices)
        # Without an earlier key it was trained on the pose of half a second before: here the start, standing.
        before = seconds[:, :1] + 0.5 * (1 - key_mask[:, :1])
        gap = Gap(matrices.unbind(1), joints.unbind(1), torch.cat([before, seconds[:, 1:]], 1), key_mask[:, 0])
        x = self.enter(((gap_features(gap) - self.mean) * self.scale).clamp(-5, 5))
        for block in self.blocks:
            x = x + block(x)
        x = self.norm(x)
        lift = 1 + LIFT * ((seconds[:, 1:2] - 0.5) / 1.5).clamp(0, 1)
        six_d = (self.turns(x) * lift).unflatten(-1, (INNER, JOINT_COUNT, 6)) + x.new_tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
        return small_quaternion(six_d), x


class CurveNet(nn.Module):
    """keys [B, 4, 24, 4], key_mask [B, 2], seconds [B, 3], music [B, 8, 53] -> curves [B, 99, 5], root [B, 2, 3]."""

    def __init__(self, config: CurveConfig) -> None:
        super().__init__()
        self.config = config
        net = config.net
        width = net.width
        self.wave = WaveEncoder(net, FEATURES)
        self.places = nn.Parameter(torch.randn(STEPS, net.music_width) * 0.1)
        self.wave_mask = nn.Parameter(torch.zeros(net.music_heads, STEPS, STEPS))
        self.enter = JointLinear(JOINT_COUNT, JOINT_INPUTS, width)
        self.embed = body_module(net, 1)
        self.layers = nn.ModuleList(DecoderLayer(net) for _ in range(net.layers))
        learned = net.attention == "learned"
        self.mask = nn.ParameterList(nn.Parameter(torch.zeros(JOINT_COUNT, 1, TOKENS, TOKENS), requires_grad=learned) for _ in self.layers)
        self.music_mask = nn.ParameterList(nn.Parameter(torch.zeros(JOINT_COUNT, 1, TOKENS, STEPS), requires_grad=learned) for _ in self.layers)
        self.close = body_module(net, 1)
        self.join = JointLinear(JOINT_COUNT, 2 * width, width)
        self.norm = nn.LayerNorm(width)
        self.turns = JointLinear(JOINT_COUNT, width, 3 * 2 + 3)
        self.path = nn.Linear(JOINT_COUNT * width, 2 + 3 * 2 + 3 * 3)
        self.trunk = Trunk(config.trunk) if config.trunk else None
        last_layers = [self.turns, self.path]
        if config.trunk:
            self.trunk_path = nn.Linear(config.trunk.width, 2 + 3 * 2 + 3 * 3)
            last_layers.append(self.trunk_path)
        for last in last_layers:
            nn.init.zeros_(last.weight)
            nn.init.zeros_(last.bias)

    def forward(self, keys: Tensor, key_mask: Tensor, seconds: Tensor, music: Tensor) -> tuple[Tensor, Tensor]:
        matrices, sine, cosine, columns = self._level(keys)
        x = self._decode(columns, key_mask, seconds, music)  # [J, B, D]
        turns = self.turns(x)[FROM_TREE].transpose(0, 1)  # [B, J, 9]
        first, second, shape = turns.split((3, 3, 3), -1)
        start, end = keys[:, 1], keys[:, 2]
        end = end * torch.where((start * end).sum(-1, keepdim=True) < 0, -1.0, 1.0)
        knots = []
        bent, seen = self.trunk(matrices, key_mask, seconds) if self.trunk else (None, None)
        for number, (fraction, turn) in enumerate(zip(FRACTIONS, (first, second))):
            turn = torch.tanh(turn * GAIN) * (LARGEST_TURN / 2)
            base = slerp_at(start, end, fraction)
            base = base if bent is None else product(base, bent[:, number])
            knots.append(product(base, small_turn(turn)))
        shape = torch.tanh(shape * GAIN) * LARGEST_SHAPE
        rotations = torch.cat([shape[:, :, None].expand(-1, -1, 4, -1), torch.stack(knots, -1)], -1).flatten(1, 2)  # [B, 96, 5]
        path = self.path(x.transpose(0, 1).flatten(1))
        path = path if seen is None else path + self.trunk_path(seen)
        path, offsets, path_shape = (path * GAIN).split((2, 6, 9), -1)
        length = seconds[:, 1:2]
        moved = self._to_world(torch.stack([path[:, :1] * length, length * 0, path[:, 1:] * length], -1), sine, cosine)[:, 0]
        offsets = self._to_world(offsets.unflatten(-1, (2, 3)) * length[..., None], sine, cosine)  # [B, 2, 3]
        path_shape = torch.tanh(path_shape.unflatten(-1, (3, 3))) * LARGEST_SHAPE
        root_curves = torch.cat([path_shape, offsets.transpose(1, 2)], -1)  # [B, 3, 5]
        heights = ground_height(matrices[:, 1:3])  # [B, 2]
        zero = heights[:, :1] * 0
        root = torch.stack([torch.cat([zero, heights[:, :1], zero], 1), torch.cat([moved[:, :1], heights[:, 1:], moved[:, 2:]], 1)], 1)
        return torch.cat([root_curves, rotations], 1), root

    @staticmethod
    def _level(keys: Tensor) -> tuple[Tensor, Tensor, Tensor, Tensor]:
        """Matrices [B, 4, 24, 3, 3] of the keys, sine and cosine [B, 1] of the start's heading, columns [B, 4, 24, 6] in that heading."""
        matrices = quaternion_to_matrix(keys)
        sine, cosine = level_heading(matrices[:, 1, 0, :, 2])
        columns = matrices[..., :2].transpose(-1, -2).flatten(-2)
        pelvis = turn_columns(columns[:, :, 0], -sine[:, None], cosine[:, None])
        return matrices, sine, cosine, torch.cat([pelvis[:, :, None], columns[:, :, 1:]], 2)

    def _decode(self, columns: Tensor, key_mask: Tensor, seconds: Tensor, music: Tensor) -> Tensor:
        """Four poses in the heading of the second [B, 4, 24, 6] -> features of the interval [J, B, D]."""
        joints = columns[:, :, TREE_ORDER].permute(2, 0, 1, 3)  # [J, B, 4, 6]
        own = joints[:, :, 1:3]
        across = joints[:, :, 2:3] - joints[:, :, 1:2]
        across = torch.cat([across, across], 2)
        outside = torch.cat([joints[:, :, 1:2] - joints[:, :, :1], joints[:, :, 3:] - joints[:, :, 2:3]], 2)
        shared = torch.cat([seconds, 1 / (seconds + 0.2), key_mask], -1)  # [B, 8]
        shared = shared[None, :, None].expand(JOINT_COUNT, -1, TOKENS, -1)
        which = torch.eye(TOKENS, device=columns.device)[None, None] + shared[..., :1] * 0
        x = self.enter(torch.cat([own, across, outside, shared, which], -1).flatten(1, 2))
        x = self.embed(x).unflatten(1, (-1, TOKENS))
        heard = self.wave.encode(self.wave.embed(music) + self.places, self.wave_mask)
        for layer, mask, music_mask in zip(self.layers, self.mask, self.music_mask):
            x = layer(x, mask, heard, music_mask)
        x = self.join(torch.cat([x[:, :, 0], x[:, :, 1]], -1))
        return self.norm(x + self.close(x))

    @staticmethod
    def _to_world(vectors: Tensor, sine: Tensor, cosine: Tensor) -> Tensor:
        """[B, n, 3] in the heading of the start -> world axes."""
        x, y, z = vectors.split(1, -1)
        s, c = sine[:, None], cosine[:, None]
        return torch.cat([c * x + s * z, y, c * z - s * x], -1)
