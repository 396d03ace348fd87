"""Trains one stage of DanceFormer (paper B); resumes from OUT/checkpoint.pt, so it can be stopped at any time:

    python export/train_danceformer.py --stage suggest --data DATA --song-features FEATURES53 --features FEATURES15 --out export/runs/suggest --minutes 20
    python export/train_danceformer.py --stage curves  --data DATA --song-features FEATURES53 --features FEATURES15 --out export/runs/curves --minutes 20

Writes OUT/checkpoint.pt, OUT/log.jsonl (losses of training and, every --every steps, of the development songs) and OUT/runs.jsonl
(command, settings, data hash, commit). Development songs are training songs held out for choices; --all trains on them too.
--adversarial WEIGHT adds the conditional discriminators. Network variants: --body kpm|gnn|linear, --attention learned|gaussian|local|global,
--head codes|regress, --frames (stage 2 without curves). --weights CHECKPOINT starts a new run (fresh rate, fresh optimiser) from the weights of an earlier one;
--trunk-rate SHARE trains stage 2's in-betweener along with the rest, at that share of the rate (0: it stays as it is).
"""

from __future__ import annotations

import copy
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from torch import Tensor, nn

from curve_net import CurveConfig, CurveNet
from danceformer_data import Dance, IntervalSampler, KeySampler, load_dances, split_dances
from danceformer_loss import CurveLoss, Discriminator, KeyLoss, LossConfig, discriminator_views, key_targets
from dantrans import DanTransConfig
from data import load_clips
from frame_net import FrameNet
from record import record_run
from spec import JOINT_COUNT, ROTATION_SIZE, spec_hash
from suggest import CODES, STEP, SuggestConfig, Suggester, part_joints
from train_inbetween import load_inbetweener
from training import cosine_rate, follow, parse_flags, save_whole


@dataclass
class Settings:
    """The run. Its length is in minutes of this process's own clock, so that variants get equal budgets."""

    stage: str = "suggest"
    song_features: str = ""
    minutes: float = 20.0
    steps: int = 0  # stop after so many steps instead, if given
    rows: int = 0  # rows a step (0: 20 for suggest, 40 for curves)
    beats: int = 24
    lr: float = 1.5e-3
    warmup: int = 50
    weight_decay: float = 0.05
    ema: float = 0.995
    noise: float = 0.03
    seed: int = 0
    every: int = 200
    hide: float = 0.08  # share of the poses before that stage 1 does not see
    aist: float = 2.0  # how much oftener AIST++ is taken than its length says (stage 1)
    parts: int = 1  # bodies with codes of their own: 1 the whole, 2 legs and what is above them
    head: str = "codes"
    body: str = "kpm"
    attention: str = "learned"
    width: int = 48
    layers: int = 2
    dropout: float = 0.1
    frames: bool = False  # stage 2 gives poses between the keys instead of curves
    all: bool = False
    trunk: str = ""  # checkpoint of train_inbetween.py that stage 2 starts from
    trunk_rate: float = 0.0  # share of the rate that the trunk is trained with
    weights: str = ""  # checkpoint of this program that a new run starts from


def find_codes(dances: list[Dance], rng: torch.Generator, parts: int = 1, aist: float = 2.0, rounds: int = 12) -> tuple[list[Tensor], Tensor, Tensor]:
    """K-means, part by part of the body, over the key poses of training dances (both mirror forms) -> (for each part the compared vectors
    [K / parts, ...]; rotations [K, 144] and steps [K, 5] of the real poses nearest to the centres, zero outside the part)."""
    sampler = KeySampler(dances, 64, 24, 5, aist=aist)
    vectors: list[list[Tensor]] = [[] for _ in range(parts)]
    rotations, steps_ = [], []
    for _ in range(14):
        rows = sampler.batch()
        targets = key_targets(rows, parts=parts)
        keep = (targets.has_step > 0).flatten()
        for part, compared in enumerate(targets.codes):
            vectors[part].append(compared.flatten(0, 1)[keep])
        rotations.append(targets.target.flatten(0, 1)[keep])
        steps_.append(targets.target_step.flatten(0, 1)[keep])
    rotation, step = torch.cat(rotations), torch.cat(steps_)
    size = CODES // parts
    found, code_rotations, code_steps = [], torch.zeros(CODES, ROTATION_SIZE), torch.zeros(CODES, STEP)
    for part, members in enumerate(part_joints(parts)):
        points = torch.cat(vectors[part])
        centres = points[torch.randperm(len(points), generator=rng)[:size]].clone()
        for _ in range(rounds):
            nearest = torch.cdist(points, centres).argmin(1)
            sums = torch.zeros_like(centres).index_add_(0, nearest, points)
            counts = torch.bincount(nearest, minlength=size)[:, None]
            centres = torch.where(counts > 0, sums / counts.clamp(min=1), centres)
        # A mean of poses is no pose: the real one nearest to it is.
        medoid = torch.cdist(centres, points).argmin(1)
        found.append(points[medoid])
        own = torch.zeros(JOINT_COUNT, 6)
        own[members] = 1
        rows_ = slice(part * size, (part + 1) * size)
        code_rotations[rows_] = rotation[medoid] * own.flatten()
        if part == 0:
            code_steps[rows_] = step[medoid]
    return found, code_rotations, code_steps


def build(settings: Settings) -> nn.Module:
    """The untrained network of the settings."""
    net = DanTransConfig(width=settings.width, layers=settings.layers, body=settings.body, attention=settings.attention, dropout=settings.dropout)
    if settings.stage == "suggest":
        return Suggester(SuggestConfig(net=net, head=settings.head, parts=settings.parts))
    if settings.stage == "curves":
        if not settings.trunk:
            return (FrameNet if settings.frames else CurveNet)(CurveConfig(net=net))
        whole = load_inbetweener(Path(settings.trunk))
        model = CurveNet(CurveConfig(net=net, trunk=whole.config))
        model.trunk.take(whole)
        return model
    raise ValueError(f"no stage named {settings.stage!r}: choose suggest or curves")


@torch.no_grad()
def follow_buffers(averaged: nn.Module, model: nn.Module, share: float = 0.02) -> None:
    """Statistics of the BatchNorms go the same way as the weights."""
    for ours, theirs in zip(averaged.buffers(), model.buffers()):
        if ours.is_floating_point():
            ours.lerp_(theirs, share)
        else:
            ours.copy_(theirs)


class Trainer:
    """One run: model, discriminator, optimisers, sampler; `step` does one step."""

    def __init__(self, settings: Settings, losses: LossConfig, training: list[Dance], held: list[Dance], codes: tuple[list[Tensor], Tensor, Tensor] | None = None) -> None:
        """`codes`: those of `find_codes` on the same dances, where they are known already."""
        self.settings, self.losses = settings, losses
        torch.manual_seed(settings.seed)
        self.model = build(settings)
        self.rng = torch.Generator().manual_seed(settings.seed + 1)
        if settings.stage == "suggest":
            rows = settings.rows or 20
            self.sampler = KeySampler(training, rows, settings.beats, settings.seed, aist=settings.aist)
            centres, rotations, steps_ = codes or find_codes(training, torch.Generator().manual_seed(settings.seed), settings.parts, settings.aist)
            self.codes = (centres, rotations, steps_)
            if settings.head == "regress":
                rotations, steps_ = rotations.mean(0, keepdim=True).expand(CODES, -1), steps_.mean(0, keepdim=True).expand(CODES, -1)
            self.model.code_rotations.copy_(rotations)
            self.model.code_steps.copy_(steps_)
            self.key_loss = KeyLoss(losses, centres)
            self.held = [KeySampler(held, 40, settings.beats, 77, 0.0, 0.0).batch()] if held else []
        else:
            self.sampler = IntervalSampler(training, settings.rows or 40, settings.seed)
            self.curve_loss = CurveLoss(losses)
            self.held = [IntervalSampler(held, 100, 77, beats_share=1.0).batch()] if held else []
        if settings.weights:
            self.model.load_state_dict(torch.load(settings.weights, weights_only=True, map_location="cpu")["averaged"])
        self.averaged = copy.deepcopy(self.model)
        groups = self.groups()
        self.optimiser = torch.optim.AdamW(groups, lr=settings.lr, betas=(0.9, 0.98))
        self.discriminator = Discriminator(settings.stage) if losses.adversarial > 0 else None
        if self.discriminator:
            self.critic = torch.optim.Adam(self.discriminator.parameters(), lr=4e-4, betas=(0.5, 0.9))
        self.steps, self.spent = 0, 0.0

    def groups(self) -> list[dict]:
        """Parameters by their decay and their share of the rate."""
        settings, trunk = self.settings, set()
        if settings.trunk and settings.trunk_rate > 0:
            trunk = set(self.model.trunk.requires_grad_(True).parameters())
        trained = [p for p in self.model.parameters() if p.requires_grad]
        split = [([p for p in trained if (p in trunk) == own and (p.ndim >= 2) == decayed], own, decayed) for own in (False, True) for decayed in (True, False)]
        return [
            {"params": found, "weight_decay": settings.weight_decay if decayed else 0.0, "share": settings.trunk_rate if own else 1.0}
            for found, own, decayed in split
            if found
        ]

    def loss(self, model: nn.Module, batch, train: bool) -> tuple[Tensor, dict[str, float], dict]:
        if self.settings.stage == "suggest":
            return self.key_loss(model, batch, self.rng if train else None, self.settings.noise, self.settings.hide)
        return self.curve_loss(model, batch)

    def step(self) -> dict[str, float]:
        """One step of the network (and of the discriminator) -> the terms of the loss."""
        self.model.train()
        total = self.settings.steps or 0
        progress = min(1.0, self.steps / total if total else self.spent / (self.settings.minutes * 60))
        for group in self.optimiser.param_groups:
            group["lr"] = group.get("share", 1.0) * cosine_rate(self.settings.lr, self.steps, self.settings.warmup, progress)
        begun = time.monotonic()
        loss, terms, made = self.loss(self.model, self.sampler.batch(), True)
        if self.discriminator:
            music, fake, real, mask = discriminator_views(self.settings.stage, made)
            verdict = lambda view: self.discriminator(music, view)  # noqa: E731
            judged = (torch.relu(1 - verdict(real)) + torch.relu(1 + verdict(fake.detach()))) * mask
            critic_loss = judged.sum() / mask.sum().clamp(min=1)
            self.critic.zero_grad(set_to_none=True)
            critic_loss.backward()
            self.critic.step()
            fooled = -(verdict(fake) * mask).sum() / mask.sum().clamp(min=1)
            loss = loss + self.losses.adversarial * fooled
            terms |= {"critic": float(critic_loss.detach()), "fooled": float(fooled.detach())}
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        nn.utils.clip_grad_norm_(self.model.parameters(), 1.0)
        self.optimiser.step()
        follow(self.averaged, self.model, self.settings.ema, self.steps)
        follow_buffers(self.averaged, self.model, max(0.02, 1 / (1 + self.steps)))
        self.steps += 1
        self.spent += time.monotonic() - begun
        return terms

    @torch.no_grad()
    def measure(self) -> dict[str, float]:
        """Terms of the averaged network on the held-out songs."""
        if not self.held:
            return {}
        self.averaged.eval()
        return self.loss(self.averaged, self.held[0], False)[1]

    def done(self) -> bool:
        return self.steps >= self.settings.steps if self.settings.steps else self.spent >= self.settings.minutes * 60

    def state(self) -> dict:
        state = {
            "stage": self.settings.stage,
            "config": self.model.config.as_dict(),
            "settings": asdict(self.settings),
            "losses": asdict(self.losses),
            "spec_hash": spec_hash(),
            "step": self.steps,
            "spent": self.spent,
            "model": self.model.state_dict(),
            "averaged": self.averaged.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "rng": self.rng.get_state(),
            "sampler": self.sampler.rng.get_state(),
            "torch": torch.get_rng_state(),
        }
        if self.discriminator:
            state |= {"discriminator": self.discriminator.state_dict(), "critic": self.critic.state_dict()}
        return state

    def resume(self, state: dict) -> None:
        """Goes on with the batches that the run would have seen."""
        self.model.load_state_dict(state["model"])
        self.averaged.load_state_dict(state["averaged"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.steps, self.spent = state["step"], state["spent"]
        self.rng.set_state(state["rng"])
        self.sampler.rng.set_state(state["sampler"])
        torch.set_rng_state(state["torch"])
        if self.discriminator and "discriminator" in state:
            self.discriminator.load_state_dict(state["discriminator"])
            self.critic.load_state_dict(state["critic"])


def train(trainer: Trainer, out: Path) -> None:
    """Runs to the end of the budget, with a log and a checkpoint every minute or so."""
    saved = time.monotonic()
    sums: dict[str, float] = {}
    count = 0
    while not trainer.done():
        for name, value in trainer.step().items():
            sums[name] = sums.get(name, 0.0) + value
        count += 1
        last = trainer.done()
        if trainer.steps % trainer.settings.every == 0 or last:
            line = {"step": trainer.steps, "minutes": round(trainer.spent / 60, 2)}
            line["train"] = {name: round(value / count, 4) for name, value in sums.items()}
            line["held"] = {name: round(value, 4) for name, value in trainer.measure().items()}
            with (out / "log.jsonl").open("a", encoding="utf-8") as file:
                file.write(json.dumps(line) + "\n")
            print(json.dumps(line), flush=True)
            sums, count = {}, 0
        if last or time.monotonic() - saved > 60:
            save_whole(trainer.state(), out / "checkpoint.pt")
            saved = time.monotonic()


def main() -> None:
    args, (settings, losses) = parse_flags(__doc__, Settings(), LossConfig())
    if args.threads:
        torch.set_num_threads(args.threads)
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    clips = load_clips(args.data, args.features, args.cache)
    dances = load_dances(Path(args.data), Path(settings.song_features), clips)
    training, held, _ = split_dances(dances)
    if settings.all:
        training, held = training + held, []
    trainer = Trainer(settings, losses, training, held)
    if (out / "checkpoint.pt").exists():
        trainer.resume(torch.load(out / "checkpoint.pt", weights_only=True, map_location="cpu"))
    weights = sum(parameter.numel() for parameter in trainer.model.parameters())
    record_run(out, args.data, settings.song_features, weights, {"settings": asdict(settings), "losses": asdict(losses)})
    train(trainer, out)


if __name__ == "__main__":
    main()
