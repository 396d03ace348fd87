"""Trains the in-betweener, the learned base of the dance transformer, on random gaps of the training clips:

    python export/train_inbetween.py --data DATA_FOLDER --features export/cache/features --out export/runs/inbetween --minutes 40

It resumes by itself when --out holds a checkpoint; the log, the checkpoint and the exact command lie in --out.
"""

from __future__ import annotations

import copy
import json
import math
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from torch import Tensor

from anchors import turn_columns
from data import Clip, load_clips
from inbetween import Gap, InbetweenConfig, Inbetweener, body_joints, gap_features, level_heading, sample_curves
from metrics import matrices_of
from record import record_run
from rotation import slerp_matrices
from skeleton import forward_kinematics, mirror_motion
from spec import FPS, JOINT_COUNT, MOTION_SIZE, ROTATION_SIZE
from training import cosine_rate, follow, parse_flags, save_whole

SEED_REACH = 15  # frames from the seed's `earlier` pose to its last (see anchors.py)


@dataclass
class InbetweenTraining:
    """Everything that shapes a run. `minutes` > 0 ends it by the clock, else `steps` does."""

    steps: int = 20_000
    minutes: float = 0.0
    gaps: int = 384  # in a batch
    moments: int = 4  # pairs of neighbouring frames looked at in each gap
    lr: float = 1e-3
    warmup: int = 100
    weight_decay: float = 0.02
    noise: float = 0.05  # standard deviation added to the standardised inputs
    ema: float = 0.999
    position: float = 10.0  # metres, root-aligned
    velocity: float = 0.6  # m/s, root-aligned
    speed: float = 2.0  # squared difference of the joints' speeds: uncertain stretches must not stand still
    rotation: float = 0.5  # 6D numbers
    path: float = 0.5  # m/s and decimetres
    shortest: float = 0.25  # seconds
    longest: float = 2.6
    tempo: tuple[float, float] = (0.85, 1.2)
    mirror: float = 0.5  # share of gaps with left and right exchanged
    aist: float = 3.0  # how much oftener a frame of AIST++ is taken: ten genres in a quarter of the minutes
    seed: int = 0


class GapSampler:
    """Random gaps with the frames between them, from clips laid end to end."""

    def __init__(self, clips: list[Clip], config: InbetweenTraining) -> None:
        self.config = config
        self.rng = torch.Generator().manual_seed(config.seed)
        self.motion = torch.cat([clip.motion for clip in clips])
        both = torch.cat([self.motion, mirror_motion(self.motion)])
        # Joint positions of every frame once and for all: they are half of a step's work otherwise.
        joints = torch.cat([forward_kinematics(matrices_of(rows)).flatten(-2) for rows in both.split(8192)])
        self.table = torch.cat([both, joints], -1)
        self.whole = torch.cat([clip.valid.all(-1) & clip.root_valid for clip in clips])
        lengths = torch.tensor([clip.frames for clip in clips])
        weights = torch.cat([torch.full((clip.frames,), config.aist if clip.source == "aist" else 1.0) for clip in clips])
        self.cumulative = weights.double().cumsum(0) / weights.sum()
        self.first = torch.repeat_interleave(lengths.cumsum(0) - lengths, lengths)
        self.last = torch.repeat_interleave(lengths.cumsum(0) - 1, lengths)

    def _uniform(self, *shape: int) -> Tensor:
        return torch.rand(*shape, generator=self.rng)

    def gaps(self, count: int) -> tuple[Tensor, Tensor, Tensor, Tensor]:
        """Frame numbers of the four poses [n, 4], output frames between them [n, 3], whether earlier is a key, the speed."""
        c = self.config
        low, high = math.log(c.shortest * FPS), math.log(c.longest * FPS)
        lengths = (low + (high - low) * self._uniform(count, 3)).exp()
        # Users and the beat set keys at even distances more often than not.
        even = self._uniform(count) < 0.65
        lengths = torch.where(even[:, None], lengths[:, 1:2] * (1 + 0.04 * (self._uniform(count, 3) - 0.5)), lengths)
        seeded = self._uniform(count) < 0.15
        lengths[seeded, 0] = SEED_REACH
        lengths = lengths.round().clamp(min=2)
        lengths[self._uniform(count) < 0.12, 2] = 0
        speed = c.tempo[0] + (c.tempo[1] - c.tempo[0]) * self._uniform(count)
        drawn = torch.rand(count, generator=self.rng, dtype=torch.float64)
        before = torch.searchsorted(self.cumulative, drawn).clamp(max=len(self.motion) - 1)
        offsets = torch.stack([-lengths[:, 0], 0 * lengths[:, 0], lengths[:, 1], lengths[:, 1] + lengths[:, 2]], -1)
        frames = before[:, None] + offsets * speed[:, None]
        inside = (frames[:, 0] >= self.first[before]) & (frames[:, 3] <= self.last[before])
        return frames[inside], lengths[inside], (~seeded[inside]).float(), speed[inside]

    def batch(self) -> dict[str, Tensor]:
        """Poses [n, 4, 219], lengths in output frames [n, 3], inner [n], fractions [n, m, 2] and real frames [n, m, 2, 147 + 72]: motion, then joints."""
        c = self.config
        frames, lengths, inner, speed = self.gaps(int(c.gaps * 1.25))
        moments = (self._uniform(len(frames), c.moments) * (lengths[:, 1:2] - 1)).floor()
        pairs = torch.stack([moments, moments + 1], -1)  # output frames after `before`
        wanted = frames[:, 1, None, None] + pairs * speed[:, None, None]
        flip = self._uniform(len(frames)) < c.mirror
        return {
            "poses": self._at(frames, flip),
            "poses_whole": self._real(frames).all(-1),
            "lengths": lengths,
            "inner": inner,
            "fraction": pairs / lengths[:, 1, None, None],
            "target": self._at(wanted, flip),
            "whole": self._real(wanted),
            "speed": speed,
        }

    def _real(self, frames: Tensor) -> Tensor:
        return self.whole[frames.floor().long()] & self.whole[frames.ceil().long()]

    def _at(self, frames: Tensor, flip: Tensor) -> Tensor:
        low, part = frames.floor().long(), (frames - frames.floor())[..., None]
        rows = flip.view(-1, *[1] * (frames.ndim - 1)).long() * len(self.motion)
        return torch.lerp(self.table[rows + low], self.table[rows + frames.ceil().long()], part)


def gap_of(batch: dict[str, Tensor]) -> Gap:
    """The gaps of a batch."""
    poses = matrices_of(batch["poses"])
    places = body_joints(poses)
    return Gap(tuple(poses.unbind(1)), tuple(places.unbind(1)), batch["lengths"] / FPS, batch["inner"])


def slerp_at(gap: Gap, fraction: Tensor) -> Tensor:
    """SLERP between the two keys of gaps [n] at `fraction` [n, m, 2] -> rotations [n, m, 2, 24, 3, 3]."""
    before, after = (gap.poses[k][:, None, None] for k in (1, 2))
    return slerp_matrices(before, after, fraction[..., None, None])


def predict(model: Inbetweener, batch: dict[str, Tensor], noise: float = 0.0) -> tuple[Tensor, Tensor]:
    """Rotations [n, m, 2, 24, 3, 3] and (side, height, forward) [n, m, 2, 3] at the batch's moments."""
    gap = gap_of(batch)
    fraction = batch["fraction"]
    turns, path = model.curves(gap, noise)
    residual, path = sample_curves(turns[:, None, None], path[:, None, None], fraction)
    return torch.stack(turn_columns(slerp_at(gap, fraction).unbind(-1), residual), -1), path


def loss_terms(rotations: Tensor, path: Tensor, batch: dict[str, Tensor]) -> dict[str, Tensor]:
    """Means over whole frames of the real poses: position m, velocity m/s, rotation (6D distance), path (m/s, dm)."""
    target, real = batch["target"][..., :MOTION_SIZE], batch["target"][..., MOTION_SIZE:].unflatten(-1, (JOINT_COUNT, 3))
    real_columns = target[..., :ROTATION_SIZE].unflatten(-1, (JOINT_COUNT, 2, 3)).transpose(-1, -2)
    norm = lambda v: (v * v).sum(-1).add(1e-8).sqrt()  # noqa: E731
    whole = (batch["whole"] & batch["poses_whole"][:, None, None]).float()
    pair = whole.prod(-1)
    mean = lambda values, mask: (values * mask).sum() / mask.sum().clamp(min=1)  # noqa: E731
    ours = forward_kinematics(rotations)
    step = lambda p: (p[:, :, 1] - p[:, :, 0]) * FPS  # noqa: E731
    difference = (rotations[..., :2] - real_columns).flatten(-2)
    # The real way from frame to frame, turned into the heading of our own pelvis as the model integrates it.
    way = step(target[..., ROTATION_SIZE:])
    sine, cosine = level_heading(rotations[:, :, 1, 0, :, 2])
    x, y, z = way.split(1, -1)
    wanted = torch.cat([cosine * x - sine * z, sine * x + cosine * z], -1)
    apart = (path[:, :, 1][..., [0, 2]] - wanted).abs().sum(-1)
    height = (path[..., 1] - target[..., ROTATION_SIZE + 1]).abs()
    ours_step, real_step = step(ours), step(real)
    return {
        "position": mean(norm(ours - real).mean(-1), whole),
        "velocity": mean(norm(ours_step - real_step).mean(-1), pair),
        "speed": mean((norm(ours_step) - norm(real_step)).square().mean(-1), pair),
        "rotation": mean(norm(difference).mean(-1), whole),
        "path": mean(apart, pair) + 10 * mean(height, whole),
    }


class InbetweenTrainer:
    """Model, optimiser, averaged weights and random state of one run."""

    def __init__(self, config: InbetweenTraining, sizes: InbetweenConfig, clips: list[Clip]) -> None:
        torch.manual_seed(config.seed)
        self.config = config
        self.model = Inbetweener(sizes)
        self.sampler = GapSampler([clip for clip in clips if clip.split == "train"], config)
        sample = torch.cat([gap_features(gap_of(self.sampler.batch())) for _ in range(12)])
        deviation = sample.std(0)
        self.model.mean.copy_(sample.mean(0))
        self.model.scale.copy_(torch.where(deviation < 0.02, torch.ones_like(deviation), 1 / deviation.clamp_min(1e-6)))
        self.averaged = copy.deepcopy(self.model).requires_grad_(False).eval()
        self.optimiser = torch.optim.AdamW(
            self.model.parameters(), config.lr, betas=(0.9, 0.99), weight_decay=config.weight_decay, fused=True
        )
        validation = InbetweenTraining(gaps=500, moments=config.moments, tempo=(1.0, 1.0), seed=1)
        held = {source: [c for c in clips if c.split == "val" and c.source == source] for source in ("aist", "tang")}
        self.validation = {source: GapSampler(some, validation).batch() for source, some in held.items() if some}
        self.step, self.seconds = 0, 0.0

    def progress(self) -> float:
        """How much of the run is done, 0..1."""
        c = self.config
        return min(1.0, self.seconds / (60 * c.minutes) if c.minutes > 0 else self.step / c.steps)

    def train_step(self) -> dict[str, float]:
        """One optimiser step -> the loss terms."""
        started = time.monotonic()
        c = self.config
        rate = cosine_rate(c.lr, self.step, c.warmup, self.progress())
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        batch = self.sampler.batch()
        terms = loss_terms(*predict(self.model, batch, c.noise), batch)
        loss = sum(getattr(c, name) * value for name, value in terms.items())
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.model.parameters(), 2.0)
        self.optimiser.step()
        self.step += 1
        follow(self.averaged, self.model, c.ema, self.step)
        self.seconds += time.monotonic() - started
        return {"loss": float(loss.detach()), **{name: float(value.detach()) for name, value in terms.items()}}

    @torch.no_grad()
    def validate(self) -> dict[str, float]:
        """Position error, cm, of averaged weights and of SLERP on fixed gaps of the validation clips."""
        result = {}
        for source, batch in self.validation.items():
            rotations, path = predict(self.averaged, batch)
            flat = slerp_at(gap_of(batch), batch["fraction"])
            result[f"{source}_cm"] = float(loss_terms(rotations, path, batch)["position"]) * 100
            result[f"{source}_slerp_cm"] = float(loss_terms(flat, path, batch)["position"]) * 100
        return result

    def save(self, path: Path) -> None:
        """Writes everything that a continuation needs; the old file stays until the new one is whole."""
        state = {
            "sizes": self.model.config.as_dict(),
            "config": asdict(self.config),
            "model": self.model.state_dict(),
            "averaged": self.averaged.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "step": self.step,
            "seconds": self.seconds,
            "rng": self.sampler.rng.get_state(),
        }
        save_whole(state, path)

    def load(self, path: Path) -> None:
        """Continues from a checkpoint."""
        state = torch.load(path, weights_only=True)
        self.model.load_state_dict(state["model"])
        self.averaged.load_state_dict(state["averaged"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.step, self.seconds = state["step"], state["seconds"]
        self.sampler.rng.set_state(state["rng"])


def load_inbetweener(path: Path) -> Inbetweener:
    """The averaged in-betweener of a checkpoint."""
    state = torch.load(path, weights_only=True, map_location="cpu")
    model = Inbetweener(InbetweenConfig(**state["sizes"]))
    model.load_state_dict(state["averaged"])
    return model


def main() -> None:
    args, (config, sizes) = parse_flags(__doc__, InbetweenTraining(), InbetweenConfig())
    if args.threads:
        torch.set_num_threads(args.threads)
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    trainer = InbetweenTrainer(config, sizes, load_clips(args.data, args.features, args.cache))
    checkpoint = out / "checkpoint.pt"
    if checkpoint.exists():
        trainer.load(checkpoint)
    weights = sum(parameter.numel() for parameter in trainer.model.parameters())
    record_run(out, args.data, args.features, weights, {"config": asdict(config), "sizes": asdict(sizes)})
    with (out / "log.jsonl").open("a", encoding="utf-8") as log:
        sums: dict[str, float] = {}
        while trainer.progress() < 1:
            for name, value in trainer.train_step().items():
                sums[name] = sums.get(name, 0.0) + value / 50
            if trainer.step % 50 == 0:
                entry = {"step": trainer.step, "seconds": round(trainer.seconds, 1)}
                entry |= {name: round(value, 5) for name, value in sums.items()}
                if trainer.step % 200 == 0:
                    entry |= {name: round(value, 3) for name, value in trainer.validate().items()}
                    trainer.save(checkpoint)
                log.write(json.dumps(entry) + "\n")
                log.flush()
                sums = {}
        log.write(json.dumps({"step": trainer.step, "seconds": round(trainer.seconds, 1), **trainer.validate()}) + "\n")
    trainer.save(checkpoint)


if __name__ == "__main__":
    main()
