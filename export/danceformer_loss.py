"""Losses of DanceFormer: what each network is asked for on a batch, and the discriminators of paper B, section 4.4."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from curve_net import FEATURES, STEPS, CurveNet
from curves import Curves, motion_channels, sample_evenly
from danceformer_data import Intervals, KeyRows, absent_poses
from frame_net import MOMENTS, FrameNet
from rotation import quaternion_to_matrix, six_d_to_matrix
from skeleton import forward_kinematics
from spec import JOINT_COUNT, ROTATION_SIZE
from suggest import BEAT_SIZE, CODES, STEP, Suggester, facing, part_joints, steps, without_heading

# Metres that a step's numbers count as beside the mean joint distance: turn (sine, cosine), height, side, forward.
STEP_METRES = torch.tensor([0.3, 0.3, 1.0, 0.5, 0.5])
CODE_SPREADS = {1: 0.06, 2: 0.04}  # metres, by the parts that have codes: codes this far from a pose share its probability


@dataclass
class LossConfig:
    """Weights."""

    position: float = 10.0  # joint positions, metres
    rotation: float = 0.5  # 6D or quaternion numbers squared
    velocity: float = 0.6  # joint velocities, m/s
    speed: float = 6.0  # amount of motion of an interval, (m/s) squared
    step: float = 3.0
    path: float = 2.0
    shape: float = 0.003  # keeps tension, continuity and bias small where they do nothing
    adversarial: float = 0.0


def _norm(vector: Tensor) -> Tensor:
    return (vector * vector).sum(-1).add(1e-8).sqrt()


def _mean(values: Tensor, mask: Tensor) -> Tensor:
    return (values * mask).sum() / mask.sum().clamp(min=1)


def code_vectors(vectors: Tensor, step: Tensor, parts: int = 1) -> list[Tensor]:
    """What the codes of each part are compared by: its joints as the body sees them (of [..., 69], the pelvis left out), and for the
    first part the step [..., 5]; distances are metres (root of the mean square over the joints)."""
    joints = vectors.unflatten(-1, (JOINT_COUNT - 1, 3))
    found = []
    for part, members in enumerate(part_joints(parts)):
        own = joints[..., [joint - 1 for joint in members if joint > 0], :]
        own = own.flatten(-2) / own.shape[-2] ** 0.5
        found.append(torch.cat([own, step * STEP_METRES.to(step)], -1) if part == 0 else own)
    return found


@dataclass
class KeyTargets:
    """Stage 1's row as the network's inputs and targets."""

    rotations: Tensor  # [B, N, 144] inputs: the pose before each beat, the first absent
    step: Tensor  # [B, N, 5]
    known: Tensor  # [B, N + 1]
    target: Tensor  # [B, N, 144]
    target_step: Tensor  # [B, N, 5]
    has_step: Tensor  # [B, N] the pose before is known too
    ahead: Tensor  # [B, N, 144] heading-free pose fixed ahead
    relative: Tensor  # [B, N, 2]
    beats: Tensor  # [B, N]
    codes: list[Tensor]  # of each part [B, N, ...]: code_vectors


def key_targets(rows: KeyRows, hidden: Tensor | None = None, parts: int = 1) -> KeyTargets:
    """`hidden` [B, N] 1 where a pose is kept from the history (as if it were missing)."""
    batch, count = rows.valid.shape
    poses = torch.cat([absent_poses(batch, 2), torch.where(rows.valid[..., None] > 0, rows.poses, absent_poses(batch, count))], 1)
    known = torch.cat([torch.zeros(batch, 2), rows.valid], 1)
    rotations, step = steps(poses, known)  # [B, N + 1, ...]: absent, P0 .. P(N-1)
    shown = known.clone()
    if hidden is not None:
        shown[:, 2:] *= 1 - hidden
    stand = absent_poses(batch, count)
    seen = torch.where(shown[:, :-1, None] > 0, poses[:, :-1], absent_poses(batch, count + 1))
    given, given_step = steps(seen, shown[:, :-1])
    index = rows.next_index.clamp(min=0)
    ahead = rows.poses.gather(1, index[..., None].expand(-1, -1, rows.poses.shape[-1]))
    ahead = torch.where((rows.next_index >= 0)[..., None], ahead, stand)
    ahead_sine, ahead_cosine = facing(ahead)
    sine, cosine = facing(seen[:, 1:])
    there = shown[:, 1:-1, None]
    sine, cosine = sine * there + ahead_sine * (1 - there), cosine * there + ahead_cosine * (1 - there)
    relative = torch.cat([ahead_sine * cosine - ahead_cosine * sine, ahead_cosine * cosine + ahead_sine * sine], -1)
    beats = torch.where(rows.next_index >= 0, rows.next_index - torch.arange(count), torch.full_like(rows.next_index, -1)).float()
    return KeyTargets(
        rotations=given,
        step=given_step,
        known=shown[:, :-1],
        target=rotations[:, 1:],
        target_step=step[:, 1:],
        has_step=rows.valid * known[:, 1:-1],
        ahead=without_heading(ahead, ahead_sine, ahead_cosine),
        relative=relative,
        beats=beats,
        codes=code_vectors(rows.vectors, step[:, 1:], parts),
    )


def heading_free_joints(six_d: Tensor) -> Tensor:
    """[..., 24, 6] -> joint positions [..., 24, 3]."""
    return forward_kinematics(six_d_to_matrix(six_d))


class KeyLoss:
    """Stage 1: cross-entropy of the codes, and reconstruction of the pose and the step from a code near the real pose."""

    def __init__(self, config: LossConfig, centres: list[Tensor]) -> None:
        """`centres` of each part [K / parts, ...]: code_vectors of its codes."""
        self.config, self.centres = config, centres

    def __call__(
        self, model: Suggester, rows: KeyRows, rng: torch.Generator | None, noise: float = 0.0, hide: float = 0.08
    ) -> tuple[Tensor, dict[str, float], dict]:
        """`noise` on the poses before, `hide`: share of them that is kept from the network; both only in training, with an `rng`."""
        hidden = None
        if rng is not None:
            hidden = (torch.rand(rows.valid.shape, generator=rng) < hide).float()
        parts = len(self.centres)
        targets = key_targets(rows, hidden, parts)
        rotations = targets.rotations
        if noise and rng is not None:  # the history is the network's own work when it is used
            rotations = rotations + noise * torch.randn(rotations.shape, generator=rng)
        heard = model.hear(rows.music, rows.music_mask, rows.style)
        x = model.decode(rotations, targets.step, targets.known, heard, 6)
        x = model.aim_at(x, rotations, targets.ahead, targets.relative, targets.beats, rows.style)
        mask = rows.valid
        terms: dict[str, Tensor] = {}
        if model.config.head == "codes":
            codes: list[Tensor] = []
            terms["codes"] = torch.zeros(())
            for part, (vectors, centres) in enumerate(zip(targets.codes, self.centres, strict=True)):
                distance = torch.cdist(vectors, centres)
                likely = torch.softmax(-(distance**2) / (2 * CODE_SPREADS[parts] ** 2), -1)
                logits = model.scores(x, codes)
                terms["codes"] = terms["codes"] + _mean(-(likely * torch.log_softmax(logits, -1)).sum(-1), mask)
                nearest = distance.argmin(-1) if rng is None else torch.multinomial(likely.flatten(0, 1), 1, generator=rng).view(mask.shape)
                codes.append(nearest + part * len(centres))
            code = torch.stack(codes, -1)
        else:
            code = torch.randn(*mask.shape, CODES, generator=rng)
        columns, step = model.finish(x, code)
        wanted = targets.target.unflatten(-1, (JOINT_COUNT, 6))
        terms["rotation"] = _mean((columns - wanted).square().sum((-1, -2)), mask)
        terms["position"] = _mean(_norm(heading_free_joints(columns) - heading_free_joints(wanted)).mean(-1), mask)
        apart = (step - targets.target_step).abs()
        terms["step"] = _mean(apart[..., 2], mask) + _mean((apart * STEP_METRES).sum(-1) - apart[..., 2], targets.has_step)
        c = self.config
        loss = c.position * terms["position"] + c.rotation * terms["rotation"] + c.step * terms["step"] + terms.get("codes", 0.0)
        made = {"columns": columns, "step": step, "wanted": wanted, "wanted_step": targets.target_step, "heard": rows.music, "mask": mask}
        return loss, {name: float(value.detach()) for name, value in terms.items()}, made


def network_inputs(batch: Intervals) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """keys, key_mask, seconds, music of all intervals of the rows, one after the other [B N, ...]."""
    rows, count = batch.music.shape[:2]
    quaternions = batch.keys[..., 3:].unflatten(-1, (JOINT_COUNT, 4))
    keys = torch.stack([quaternions[:, i : i + count] for i in range(4)], 2).flatten(0, 1)
    known = torch.ones(rows, count, 2)
    known[:, 0, 0], known[:, -1, 1] = batch.outer[:, 0], batch.outer[:, 1]
    seconds = torch.stack([batch.seconds[:, i : i + count] for i in range(3)], 2).flatten(0, 1)
    return keys, known.flatten(0, 1), seconds, batch.music.flatten(0, 1)


def network_frames(model: FrameNet, batch: Intervals) -> tuple[Tensor, Tensor]:
    """Frames instead of curves -> (channels [B, N, 9, 99] on the real key roots, path [B, N, 2])."""
    rows, count = batch.music.shape[:2]
    quaternions, offsets, path = (value.unflatten(0, (rows, count)) for value in model(*network_inputs(batch)))
    start, end = batch.keys[:, 1:-2, None, :3], batch.keys[:, 2:-1, None, :3]
    share = ((torch.arange(MOMENTS) + 0.5) / MOMENTS)[:, None]
    return torch.cat([start + (end - start) * share + offsets, quaternions.flatten(-2)], -1), path


def network_curves(model: CurveNet, batch: Intervals) -> tuple[Curves, Tensor, Tensor]:
    """The network on rows of intervals -> (curves on the real key roots, path [B, N, 2] of the roots in the world, raw output)."""
    rows, count = batch.music.shape[:2]
    output, root = model(*network_inputs(batch))
    output = output.unflatten(0, (rows, count))  # [B, N, 99, 5]
    return curves_of(output, batch.keys[:, 1:-1], batch.seconds[:, 1:-1]), root.unflatten(0, (rows, count))[:, :, 1, [0, 2]], output


def curves_of(output: Tensor, keys: Tensor, seconds: Tensor) -> Curves:
    """Network output [..., N, 99, 5] on key channels [..., N + 1, 99] (signs continuous) and lengths [..., N] -> curves.

    Root knots come as offsets from the straight line between the key roots.
    """
    times = torch.cat([seconds[..., :1] * 0, seconds.cumsum(-1)], -1)
    shape, inner = output[..., :3].transpose(-1, -2), output[..., 3:].transpose(-1, -2)
    start, end = keys[..., :-1, None, :3], keys[..., 1:, None, :3]
    share = torch.tensor([1 / 3, 2 / 3])[:, None]
    root = start + (end - start) * share + inner[..., :3]
    return Curves(times, keys, torch.cat([root, inner[..., 3:]], -1), shape)


class CurveLoss:
    """Stage 2: reconstruction of the motion that the curves sample to."""

    def __init__(self, config: LossConfig) -> None:
        self.config = config

    def __call__(self, model: CurveNet | FrameNet, batch: Intervals) -> tuple[Tensor, dict[str, float], dict]:
        if isinstance(model, FrameNet):
            values, path = network_frames(model, batch)
            output = values.new_zeros(*values.shape[:2], 99, 5)  # no tension, continuity or bias to keep small
        else:
            curves, path, output = network_curves(model, batch)
            values = sample_evenly(curves)  # [B, N, 9, 99]
        root, quaternions = motion_channels(values)
        real_root, real = motion_channels(batch.target)
        ours = forward_kinematics(quaternion_to_matrix(quaternions))
        with torch.no_grad():
            truth = forward_kinematics(quaternion_to_matrix(real))
        valid = batch.valid
        whole = valid[..., None].expand(values.shape[:3])
        terms = {"position": _mean(_norm(ours - truth).mean(-1), whole)}
        signs = torch.where((quaternions * real).sum(-1, keepdim=True) < 0, -1.0, 1.0)
        terms["rotation"] = _mean((quaternions * signs - real).square().sum((-1, -2)) * 4, whole)
        moment = (batch.seconds[:, 1:-1] / values.shape[2])[..., None, None, None]
        ours_velocity, velocity = ((p[:, :, 1:] - p[:, :, :-1]) / moment for p in (ours, truth))
        terms["velocity"] = _mean(_norm(ours_velocity - velocity).mean(-1), whole[..., 1:])
        speeds = [_norm(v).mean(2) for v in (ours_velocity, velocity)]  # of each joint over the interval
        terms["speed"] = _mean((speeds[0] - speeds[1]).square().mean(-1), valid)
        moved = (batch.keys[:, 2:-1, :3] - batch.keys[:, 1:-2, :3])[..., [0, 2]]
        terms["path"] = _mean(_norm(path - moved), valid) + _mean(_norm(root - real_root), whole)
        terms["shape"] = output[..., :3].square().mean() + 3 * output[..., 1].square().mean()
        c = self.config
        loss = sum(getattr(c, name) * value for name, value in terms.items())
        return loss, {name: float(value.detach()) for name, value in terms.items()}, {"output": output, "values": values, "target": batch.target, "music": batch.music, "mask": valid}


def _mlp(inputs: int, hidden: int, outputs: int) -> nn.Sequential:
    return nn.Sequential(nn.Linear(inputs, hidden), nn.LeakyReLU(0.2), nn.Linear(hidden, hidden), nn.LeakyReLU(0.2), nn.Linear(hidden, outputs))


class Discriminator(nn.Module):
    """Two 3-layer MLPs, for the music and for what was made of it, and a third for the verdict (section 4.4). [.., m], [.., n] -> [..]."""

    def __init__(self, stage: str, hidden: int = 128) -> None:
        super().__init__()
        music = BEAT_SIZE if stage == "suggest" else STEPS * FEATURES
        # Two poses and the step between them; or nine moments of the 99 channels, relative to the first.
        made = 2 * (ROTATION_SIZE + STEP) if stage == "suggest" else 9 * 96
        self.music, self.made, self.both = _mlp(music, hidden, hidden), _mlp(made, hidden, hidden), _mlp(2 * hidden, hidden, 1)

    def forward(self, music: Tensor, made: Tensor) -> Tensor:
        return self.both(torch.cat([self.music(music), self.made(made)], -1))[..., 0]


def discriminator_views(stage: str, made: dict) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """(music, made, real, mask) of a batch, in the form that the discriminator of the stage reads."""
    if stage == "suggest":
        pose = torch.cat([made["columns"].flatten(-2), made["step"]], -1)
        real = torch.cat([made["wanted"].flatten(-2), made["wanted_step"]], -1)
        count = pose.shape[1]
        # What follows the real pose before it: teacher forcing gives the network the same.
        before = real[:, :-1]
        return made["heard"][:, 7 : 6 + count], torch.cat([before, pose[:, 1:]], -1), torch.cat([before, real[:, 1:]], -1), made["mask"][:, 1:]
    quaternions = [motion_channels(made[name])[1].flatten(-2) for name in ("values", "target")]
    views = [(q - quaternions[1][:, :, :1].detach()).flatten(-2) for q in quaternions]
    return made["music"].flatten(-2), views[0], views[1], made["mask"]
