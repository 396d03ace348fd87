"""Stage 1 of DanceFormer: a key pose for every beat (paper B, section 4.1), beat after beat.

Letters: J joints, B batch, N beats in a row, K codes, D width. A pose is [147]: 24 x 6D and the root in metres.

What differs from the paper, and why:
- The paper regresses the pose with a GAN against averaging. Here the decoder first chooses pose codes (centres of the key poses of the
  training set), one for the legs with turn and step, then one for what is above them, and then regresses what the pose differs by from
  the two. The choice is sampled: with a few thousand beats of data a regression stands still and a GAN falls over; see the ablation in
  results/danceformer.md. K codes in two halves name K K / 4 poses, so that a code is nearer to the pose than one of K for all of it.
- A step sees the last 16 poses only. Attention reaches 8 beats in each of 2 causal layers, so this is not a shortcut: it gives what
  decoding with cached keys and values of the whole song would.
- A pose that the user has fixed ahead, and the beats to it, are given behind the decoder, so they need no place in the history.
- Poses are told in the dancer's own heading; the step and the turn since the beat before stand beside them.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field

import torch
from torch import Tensor, nn

from dantrans import FAR, FROM_TREE, TREE_ORDER, DanTransConfig, DecoderLayer, JointLinear, Reach, WaveEncoder, body_module
from inbetween import level_heading
from rotation import gram_schmidt, unit
from spec import JOINT_COUNT, JOINTS, MOTION_SIZE, ROTATION_SIZE, SPEC

PART = SPEC["danceformer"]
PAST_POSES: int = PART["suggest"]["pastPoses"]
PAST_BEATS: int = PART["suggest"]["pastBeats"]
FUTURE_BEATS: int = PART["suggest"]["futureBeats"]
CODES: int = PART["suggest"]["codes"]
FARTHEST: int = PART["suggest"]["farthestFixedBeats"]
STYLES: list[str] = PART["styles"]
BEAT_SIZE = len(PART["featureNames"]) + len(PART["beatExtraNames"])
INPUTS = ("poses", "pose_mask", "music", "music_mask", "next_pose", "next_beats", "style", "temperature", "noise")
OUTPUTS = ("pose", "code")

REACH = 8  # beats a decoder layer looks back, itself included
MUSIC_REACH = 2  # beats to either side, in the wave encoder's layers and in the decoder's look at the music
STEP = 5  # sine and cosine of the turn since the beat before, height, step to the side and forward in the heading before
JOINT_INPUTS = 6 + 6 + STEP + 1


@dataclass
class SuggestConfig:
    """Sizes."""

    net: DanTransConfig = field(default_factory=DanTransConfig)
    head: str = "codes"  # codes | regress (the paper's, for the ablation: `noise` is then its random input)
    code_width: int = 64
    parts: int = 1  # bodies that have codes of their own: 1 the whole, 2 legs and what is above them

    def __post_init__(self) -> None:
        if isinstance(self.net, dict):
            self.net = DanTransConfig(**self.net)

    def as_dict(self) -> dict:
        return asdict(self)


LEGS = [JOINTS.index(side + name) for name in ("hip", "knee", "ankle", "foot") for side in ("left_", "right_")]


def part_joints(parts: int) -> list[list[int]]:
    """Joints of each part of the body, in the order in which their codes are chosen; the pelvis goes with the first."""
    if parts == 1:
        return [list(range(JOINT_COUNT))]
    if parts == 2:
        return [[0, *LEGS], [joint for joint in range(1, JOINT_COUNT) if joint not in LEGS]]
    raise ValueError(f"codes for {parts} parts of the body: choose 1 or 2")


def turn_columns(columns: Tensor, sine: Tensor, cosine: Tensor) -> Tensor:
    """6D of the pelvis [..., 6] turned about +Y by the angle of (sine, cosine) [..., 1]."""
    ax, ay, az, bx, by, bz = columns.split(1, -1)
    a = [cosine * ax + sine * az, ay, cosine * az - sine * ax]
    b = [cosine * bx + sine * bz, by, cosine * bz - sine * bx]
    return torch.cat(a + b, -1)


def facing(poses: Tensor) -> tuple[Tensor, Tensor]:
    """Sine and cosine [..., 1] of the heading of poses [..., >= 6]."""
    return level_heading(torch.cat(gram_schmidt(poses[..., :3], poses[..., 3:6])[2:], -1))


def without_heading(poses: Tensor, sine: Tensor, cosine: Tensor) -> Tensor:
    """Rotations [..., 144] of poses that face (sine, cosine), turned to face +Z."""
    return torch.cat([turn_columns(poses[..., :6], -sine, cosine), poses[..., 6:ROTATION_SIZE]], -1)


def steps(poses: Tensor, known: Tensor) -> tuple[Tensor, Tensor]:
    """Poses [B, N + 1, 147] -> (heading-free rotations [B, N, 144] and step [B, N, 5]) of poses 1..N since the pose before each.

    `known` [B, N + 1]: where a pose or the one before it is missing, the step is: no turn, no step, the pose's height.
    """
    sine, cosine = facing(poses)
    rotations = without_heading(poses, sine, cosine)[:, 1:]
    s0, c0, s1, c1 = sine[:, :-1], cosine[:, :-1], sine[:, 1:], cosine[:, 1:]
    moved = poses[:, 1:, ROTATION_SIZE:] - poses[:, :-1, ROTATION_SIZE:]
    x, z = moved[..., :1], moved[..., 2:]
    both = (known[:, 1:] * known[:, :-1])[..., None]
    turn_sine, turn_cosine = (s1 * c0 - c1 * s0) * both, (c1 * c0 + s1 * s0) * both + (1 - both)
    side, forward = (c0 * x - s0 * z) * both, (s0 * x + c0 * z) * both
    height = poses[:, 1:, ROTATION_SIZE + 1 : ROTATION_SIZE + 2]
    return rotations, torch.cat([turn_sine, turn_cosine, height, side, forward], -1)


def to_joints(rotations: Tensor) -> Tensor:
    """[B, N, 144] -> [J, B, N, 6] in tree order."""
    return rotations.unflatten(-1, (JOINT_COUNT, 6))[:, :, TREE_ORDER].permute(2, 0, 1, 3)


class Suggester(nn.Module):
    """The network. Training runs `decode` and `choose`/`finish` on rows of beats; the browser runs `forward`, one step."""

    def __init__(self, config: SuggestConfig) -> None:
        super().__init__()
        self.config = config
        net = config.net
        width = net.width
        self.wave = WaveEncoder(net, BEAT_SIZE)
        self.style = nn.Linear(len(STYLES), net.music_width)
        self.no_music = nn.Parameter(torch.zeros(net.music_width))
        self.wave_reach = Reach(net.music_heads, -MUSIC_REACH, MUSIC_REACH, "global" if net.attention == "global" else "learned")
        self.enter = JointLinear(JOINT_COUNT, JOINT_INPUTS, width)
        self.no_pose = nn.Parameter(torch.zeros(JOINT_COUNT, 1, 1, width))
        self.embed = body_module(net, 1)
        self.layers = nn.ModuleList(DecoderLayer(net) for _ in range(net.layers))
        reach = 1 - REACH
        self.reach = nn.ModuleList(Reach(JOINT_COUNT, reach, 0, net.attention) for _ in range(net.layers))
        self.music_reach = nn.ModuleList(Reach(JOINT_COUNT, -MUSIC_REACH, MUSIC_REACH, net.attention) for _ in range(net.layers))
        self.enter_next = JointLinear(JOINT_COUNT, 6 + 6 + 2 + 6, width)
        self.enter_style = nn.Linear(len(STYLES), width)
        self.aim = body_module(net, 1)
        flat = JOINT_COUNT * width
        if config.head == "codes":
            self.logits = nn.Linear(flat, CODES)
            self.code = nn.Embedding(CODES, config.code_width)
        else:
            self.code = nn.Linear(CODES, config.code_width)
        self.enter_code = nn.Linear(config.code_width, flat)
        self.aimed, self.finished = nn.LayerNorm(width), nn.LayerNorm(width)
        self.finish_body = body_module(net, 1)
        self.turns = JointLinear(JOINT_COUNT, width, 6)
        self.step = nn.Linear(flat, STEP)
        # Rotations outside a code's own part, and the steps of all but the first part's codes, are zero.
        self.register_buffer("code_rotations", torch.zeros(CODES, ROTATION_SIZE))
        self.register_buffer("code_steps", torch.zeros(CODES, STEP))
        for last in (self.turns, self.step):
            nn.init.normal_(last.weight, std=1e-3)
            nn.init.zeros_(last.bias)

    def hear(self, music: Tensor, known: Tensor, style: Tensor) -> Tensor:
        """Music of beats [B, M, 57] -> code [B, M, W]."""
        at = torch.arange(music.shape[1], device=music.device)
        mask = self.wave_reach(at[None, :] - at[:, None])
        tokens = self.wave.embed(music) * known[..., None] + self.no_music * (1 - known[..., None])
        return self.wave.encode(tokens + self.style(style)[:, None], mask)

    def decode(self, rotations: Tensor, step: Tensor, known: Tensor, heard: Tensor, first: int, earlier: Tensor | None = None) -> Tensor:
        """Poses [B, N, ...] (token i predicts the beat after pose i) -> features [J, B, N, D].

        `known` [B, N + 1] of the poses and of the one before the first; `heard` [B, M, W] with the beat that token 0 predicts at `first`;
        `earlier` [B, 1, 144] rotations of the pose before the first, where there is one.
        """
        count = rotations.shape[1]
        joints = to_joints(rotations)
        start = joints[:, :, :1] if earlier is None else to_joints(earlier)
        before = torch.cat([start, joints[:, :, :-1]], 2)
        both = known[:, 1:] * known[:, :-1]
        change = (joints - before) * both[None, :, :, None]
        whole = torch.cat([step, both[..., None]], -1)[None].expand(JOINT_COUNT, -1, -1, -1)
        tokens = torch.cat([joints, change, whole], -1)
        present = known[None, :, 1:, None]
        x = self.enter(tokens.flatten(1, 2)).unflatten(1, (-1, count)) * present + self.no_pose * (1 - present)
        x = self.embed(x.flatten(1, 2)).unflatten(1, (-1, count))
        at = torch.arange(count, device=x.device)
        distance = at[None, :] - at[:, None]
        sounds = torch.arange(heard.shape[1], device=x.device)
        music_distance = sounds[None, :] - first - at[:, None]
        # A missing pose is looked at by nobody but itself.
        absent = (1 - known[None, :, None, 1:]) * (distance != 0)[None, None] * FAR  # [1, B, N, N]
        for layer, reach, music_reach in zip(self.layers, self.reach, self.music_reach):
            mask = reach(distance, causal=True)[:, None] + absent
            x = layer(x, mask, heard, music_reach(music_distance)[:, None])
        return x

    def aim_at(self, x: Tensor, last: Tensor, next_pose: Tensor, relative: Tensor, beats: Tensor, style: Tensor) -> Tensor:
        """Adds the pose fixed ahead and the style. x [J, B, N, D]; `last`, `next_pose` heading-free [B, N, 144]; `relative` [B, N, 2]:
        sine and cosine of the turn from the last pose to the next; `beats` [B, N], below 0 for none -> [J, B, N, D]."""
        given = (beats > 0).to(x)[..., None]
        near = beats.clamp(min=0.25)[..., None]
        clock = torch.cat([given, 1 / near, near / FARTHEST, *((near - k).abs().clamp(max=1) for k in (1, 2, 4))], -1) * given
        ahead, now = to_joints(next_pose), to_joints(last)
        whole = torch.cat([relative * given, clock], -1)[None].expand(JOINT_COUNT, -1, -1, -1)
        tokens = torch.cat([ahead * given, (ahead - now) * given, whole], -1)
        count = x.shape[2]
        x = x + self.enter_next(tokens.flatten(1, 2)).unflatten(1, (-1, count)) + self.enter_style(style)[None, :, None]
        return self.aimed(x + self.aim(x.flatten(1, 2)).unflatten(1, (-1, count)))

    def told(self, code: Tensor) -> Tensor:
        """Codes of the first parts [B, N, G] (or, for the regressing head, noise [B, N, K]) as features [J, B, N, D]."""
        known = self.code(code).sum(-2) if self.config.head == "codes" else self.code(code)
        return self.enter_code(known).unflatten(-1, (JOINT_COUNT, -1)).permute(2, 0, 1, 3)

    def scores(self, x: Tensor, codes: list[Tensor]) -> Tensor:
        """Features [J, B, N, D] and the codes [B, N] of the parts before, none for the first -> logits [B, N, K / parts] of the next part's."""
        part, size = len(codes), CODES // self.config.parts
        if codes:
            x = x + self.told(torch.stack(codes, -1))
        return self.logits(x.permute(1, 2, 0, 3).flatten(2))[..., part * size : (part + 1) * size]

    def finish(self, x: Tensor, code: Tensor) -> tuple[Tensor, Tensor]:
        """Features and the codes [B, N, parts] (or, for the regressing head, noise [B, N, K]) -> rotations [B, N, J, 6] orthonormal, step [B, N, 5]."""
        count = x.shape[2]
        x = x + self.told(code)
        x = self.finished(x + self.finish_body(x.flatten(1, 2)).unflatten(1, (-1, count)))
        turns = self.turns(x.flatten(1, 2)).unflatten(1, (-1, count))[FROM_TREE].permute(1, 2, 0, 3)
        step = self.step(x.permute(1, 2, 0, 3).flatten(2))
        if self.config.head == "codes":
            base, base_step = (nn.functional.embedding(code, table).sum(-2) for table in (self.code_rotations, self.code_steps))
        else:
            base, base_step = self.code_rotations[:1], self.code_steps[:1]  # the mean pose
        raw = base.unflatten(-1, (JOINT_COUNT, 6)) + turns
        first, second, _ = gram_schmidt(raw[..., :3], raw[..., 3:])
        step = base_step + step
        return torch.cat([first, second], -1), torch.cat([unit(step[..., :2]), step[..., 2:]], -1)

    def forward(
        self,
        poses: Tensor,
        pose_mask: Tensor,
        music: Tensor,
        music_mask: Tensor,
        next_pose: Tensor,
        next_beats: Tensor,
        style: Tensor,
        temperature: Tensor,
        noise: Tensor,
    ) -> tuple[Tensor, Tensor]:
        """One step: see INPUTS; poses [B, 16, 147] in the world -> (pose [B, 147] in the world, codes [B, parts])."""
        mask = pose_mask[:, :, None]
        stand = torch.zeros(MOTION_SIZE, device=poses.device)
        stand[0:ROTATION_SIZE:6] = 1
        stand[4:ROTATION_SIZE:6] = 1
        poses = poses * mask + stand * (1 - mask)
        rotations, step = steps(poses, pose_mask)
        heard = self.hear(music, music_mask, style)
        # Token i stands for pose i + 1 of the 16 and predicts the beat after it; the last one predicts beat PAST_BEATS of the music.
        earlier = without_heading(poses[:, :1], *facing(poses[:, :1]))
        x = self.decode(rotations, step, pose_mask, heard, PAST_BEATS - (PAST_POSES - 2), earlier)[:, :, -1:]
        given = (next_beats > 0).to(poses)[:, None]
        target = next_pose * given + stand[:ROTATION_SIZE] * (1 - given)
        ahead_sine, ahead_cosine = facing(target)
        sine, cosine = facing(poses[:, -1])
        # Before the first pose the dancer faces as the pose fixed ahead does.
        sine, cosine = sine * mask[:, -1] + ahead_sine * (1 - mask[:, -1]), cosine * mask[:, -1] + ahead_cosine * (1 - mask[:, -1])
        relative = torch.cat([ahead_sine * cosine - ahead_cosine * sine, ahead_cosine * cosine + ahead_sine * sine], -1)
        last, ahead = rotations[:, -1:], without_heading(target, ahead_sine, ahead_cosine)[:, None]
        x = self.aim_at(x, last, ahead, relative[:, None], next_beats[:, None], style)
        if self.config.head == "codes":
            size = CODES // self.config.parts
            codes: list[Tensor] = []
            for part in range(self.config.parts):
                weighed = self.scores(x, codes)[:, 0] / temperature[:, None] + noise[:, part * size : (part + 1) * size]
                codes.append(weighed.argmax(-1)[:, None] + part * size)
            columns, moved = self.finish(x, torch.stack(codes, -1))
            code = torch.cat(codes, -1).to(poses)
        else:
            columns, moved = self.finish(x, (noise * temperature[:, None])[:, None])
            code = temperature[:, None] * 0
        columns, moved = columns[:, 0], moved[:, 0]
        turn_sine, turn_cosine, height, side, forward = moved.split(1, -1)
        known = mask[:, -1]
        turn_sine, turn_cosine, side, forward = turn_sine * known, turn_cosine * known + (1 - known), side * known, forward * known
        new_sine, new_cosine = sine * turn_cosine + cosine * turn_sine, cosine * turn_cosine - sine * turn_sine
        pelvis = turn_columns(columns[:, 0], new_sine, new_cosine)
        root = poses[:, -1, ROTATION_SIZE:]
        place = [root[:, :1] + cosine * side + sine * forward, height, root[:, 2:] + cosine * forward - sine * side]
        return torch.cat([pelvis, columns[:, 1:].flatten(1), *place], -1), code
