"""Trains the key-pose dancer. One command:

    python export/train.py --data DATA_FOLDER --out export/runs/light

It resumes by itself when --out holds a checkpoint. The log (one JSON object a line), the checkpoint and what is needed to
repeat the run (command, data hash, git commit) lie in --out.
"""

from __future__ import annotations

import contextlib
import copy
import json
import math
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import torch

from anchors import find_base
from data import Clip, load_clips
from loss import LossConfig, dance_loss
from metrics import joints, mean_joint_speed
from model import INPUT_NAMES, KeyPoseDancer, ModelConfig, count_weights
from record import record_run
from spec import FPS, MUSIC_FRAMES, ROTATION_SIZE, SEED_FRAMES, spec_hash
from train_inbetween import load_inbetweener
from training import cosine_rate, follow, parse_flags, save_whole
from windows import Augmentation, WindowSampler, collate, cut_window


@dataclass
class TrainConfig:
    """Everything that shapes a run. `minutes` > 0 ends it by the clock, else `steps` does."""

    model: str = "light"
    steps: int = 300_000
    minutes: float = 0.0
    schedule: str = "paper"  # paper: 1e-4, then 1e-5 and 1e-6 at 100k and 250k steps; cosine: warm-up, then down to 1% of lr
    lr: float = 1e-4
    warmup: int = 100
    tokens: int = 6000  # frames in a batch, seed included: 20 windows of 300
    lengths: tuple[int, ...] = (MUSIC_FRAMES,)
    ema: float = 0.999
    weight_decay: float = 0.0
    dropout: float = -1.0  # below 0: what the model config says
    patch: int = 0  # frames in a token; 0: what the model config says
    inbetweener: str = ""  # checkpoint of train_inbetween.py, kept as it is; empty: SLERP is the base
    clip_norm: float = 1.0
    grow: tuple[float, ...] = ()  # shares of the run at which more layers join; (0.4, 0.7): a third, two thirds, all
    precision: str = "fp32"  # fp32 | bf16 | fp16 (fp16 needs a GPU)
    seed: int = 0
    validate_every: int = 500
    save_every: int = 250
    device: str = "cpu"


class Trainer:
    """Model, optimiser, averaged weights and random state of one run."""

    def __init__(
        self, config: TrainConfig, loss: LossConfig, clips: list[Clip], augmentation: Augmentation | None = None
    ) -> None:
        torch.manual_seed(config.seed)
        self.config, self.loss_config = config, loss
        model_config = ModelConfig.named(config.model)
        if config.dropout >= 0:
            model_config.dropout = config.dropout
        if config.patch > 0:
            model_config.patch = config.patch
        prior = load_inbetweener(Path(config.inbetweener)) if config.inbetweener else None
        model_config.inbetween = prior.config if prior else None
        self.model = KeyPoseDancer(model_config).to(config.device)
        if prior:
            self.model.inbetweener.load_state_dict(prior.state_dict())
            self.model.inbetweener.requires_grad_(False)
        train = [clip for clip in clips if clip.split == "train"]
        statistics = WindowSampler(train, 4 * config.tokens, (MUSIC_FRAMES // 2,), seed=config.seed + 1)
        self.model.fit_inputs([statistics.batch() for _ in range(8)])
        self.averaged = copy.deepcopy(self.model).requires_grad_(False).eval()
        self.trained = [parameter for parameter in self.model.parameters() if parameter.requires_grad]
        self.optimiser = torch.optim.AdamW(self.trained, config.lr, betas=(0.9, 0.99), weight_decay=config.weight_decay, fused=True)
        self.scaler = torch.amp.GradScaler(config.device, enabled=config.precision == "fp16")
        self.sampler = WindowSampler(train, config.tokens, tuple(config.lengths), augmentation, config.seed)
        self.validation = validation_batches([clip for clip in clips if clip.split == "val"])
        self.step, self.seconds = 0, 0.0

    def learning_rate(self) -> float:
        """The rate of the coming step."""
        c = self.config
        if c.schedule == "paper":
            return c.lr * (1.0 if self.step < 100_000 else 0.1 if self.step < 250_000 else 0.01)
        return cosine_rate(c.lr, self.step, c.warmup, self.progress())

    def progress(self) -> float:
        """How much of the run is done, 0..1."""
        done = self.seconds / (60 * self.config.minutes) if self.config.minutes > 0 else self.step / self.config.steps
        return min(done, 1.0)

    def set_depth(self) -> None:
        """Lets the layers run that have joined by now."""
        stages, joined = len(self.config.grow), sum(self.progress() >= share for share in self.config.grow)
        share = (joined + 1) / (stages + 1)
        sizes = self.model.config
        depth = math.ceil(sizes.encoder_layers * share - 0.5) or 1, math.ceil(sizes.cross_layers * share)
        for model in (self.model, self.averaged):
            model.set_depth(*depth)

    def train_step(self) -> dict[str, float]:
        """One optimiser step -> loss terms, rate and gradient norm."""
        started = time.monotonic()
        c = self.config
        rate = self.learning_rate()
        self.set_depth()
        for group in self.optimiser.param_groups:
            group["lr"] = rate
        batch = {name: value.to(c.device) for name, value in self.sampler.batch().items()}
        self.model.train()
        low = {"bf16": torch.bfloat16, "fp16": torch.float16}.get(c.precision)
        with torch.autocast(c.device, low) if low else contextlib.nullcontext():
            predicted = self.model(*(batch[name] for name in INPUT_NAMES))
        loss, terms = dance_loss(predicted.float(), batch, self.loss_config)
        self.optimiser.zero_grad(set_to_none=True)
        self.scaler.scale(loss).backward()
        self.scaler.unscale_(self.optimiser)
        norm = torch.nn.utils.clip_grad_norm_(self.trained, c.clip_norm)
        self.scaler.step(self.optimiser)
        self.scaler.update()
        self.step += 1
        follow(self.averaged, self.model, c.ema, self.step)
        self.seconds += time.monotonic() - started
        return {"loss": float(loss.detach()), **terms, "lr": rate, "grad": float(norm)}

    @torch.no_grad()
    def validate(self) -> dict[str, float]:
        """Averaged weights against SLERP on fixed validation windows with a key pose every second."""
        total: dict[str, float] = {}
        for batch in self.validation:
            batch = {name: value.to(self.config.device) for name, value in batch.items()}
            predicted = self.averaged(*(batch[name] for name in INPUT_NAMES))
            columns = find_base(batch["seed"], batch["key_poses"], batch["to_previous"], batch["to_next"]).columns
            slerp = torch.cat([torch.cat(columns[:2], -1).flatten(-2), batch["target"][..., ROTATION_SIZE:]], -1)
            real = joints(batch["target"])
            mask = batch["valid"].all(-1) & (batch["key_mask"] == 0)
            for name, motion in (("model", predicted), ("slerp", slerp), ("real", batch["target"])):
                ours = joints(motion)
                error = (ours - real).norm(dim=-1).mean(-1)[mask].mean() * 100
                speed = torch.stack([mean_joint_speed(window) for window in ours]).mean()
                jerk = (ours.diff(n=3, dim=1) * FPS**3).norm(dim=-1).mean()
                for key, value in ((f"{name}_cm", error), (f"{name}_speed", speed), (f"{name}_jerk", jerk)):
                    total[key] = total.get(key, 0.0) + float(value) / len(self.validation)
        return {
            "val_cm": total["model_cm"],
            "val_slerp_cm": total["slerp_cm"],
            "val_speed_ratio": total["model_speed"] / total["real_speed"],
            "val_slerp_speed_ratio": total["slerp_speed"] / total["real_speed"],
            "val_jerk_ratio": total["model_jerk"] / total["real_jerk"],
        }

    def save(self, path: Path) -> None:
        """Writes everything that a bit-identical continuation needs; the old file stays until the new one is whole."""
        state = {
            "config": asdict(self.config),
            "loss": asdict(self.loss_config),
            "model_config": self.model.config.as_dict(),
            "spec_hash": spec_hash(),
            "model": self.model.state_dict(),
            "averaged": self.averaged.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "scaler": self.scaler.state_dict(),
            "step": self.step,
            "seconds": self.seconds,
            "sampler_rng": self.sampler.rng.get_state(),
            "torch_rng": torch.get_rng_state(),
        }
        save_whole(state, path)

    def load(self, path: Path) -> None:
        """Continues from a checkpoint. Raises ValueError when it was made for another spec."""
        state = torch.load(path, weights_only=True, map_location=self.config.device)
        if state["spec_hash"] != spec_hash():
            raise ValueError(f"{path} was trained for another spec.json")
        self.model.load_state_dict(state["model"])
        self.averaged.load_state_dict(state["averaged"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.scaler.load_state_dict(state["scaler"])
        self.step, self.seconds = state["step"], state["seconds"]
        self.sampler.rng.set_state(state["sampler_rng"].cpu())
        torch.set_rng_state(state["torch_rng"].cpu())


def validation_batches(clips: list[Clip], spacing: int = FPS, most: int = 24) -> list[dict[str, torch.Tensor]]:
    """Fixed windows of the validation clips, keys every `spacing` frames from the first to the last frame; at most `most`."""
    frames = (MUSIC_FRAMES - 1) // spacing * spacing + 1
    rng = torch.Generator().manual_seed(0)
    windows = []
    for clip in clips:
        for start in range(0, clip.frames - SEED_FRAMES - frames + 1, SEED_FRAMES + frames):
            windows.append(cut_window(clip, start, frames, rng, keys=torch.arange(0, frames, spacing)))
    # Evenly spread over the clips, so that one long song does not fill the list.
    windows = windows[:: max(1, math.ceil(len(windows) / most))]
    return [collate(windows[i : i + 6]) for i in range(0, len(windows), 6)]


def main() -> None:
    args, (config, loss, augmentation) = parse_flags(__doc__, TrainConfig(), LossConfig(), Augmentation())
    if args.threads:
        torch.set_num_threads(args.threads)
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    trainer = Trainer(config, loss, load_clips(args.data, args.features, args.cache), augmentation)
    checkpoint = out / "checkpoint.pt"
    if checkpoint.exists():
        trainer.load(checkpoint)
    settings = {"config": asdict(config), "loss": asdict(loss), "augmentation": asdict(augmentation)}
    record_run(out, args.data, args.features, count_weights(trainer.model), settings)
    with (out / "log.jsonl").open("a", encoding="utf-8") as log:

        def write(entry: dict) -> None:
            log.write(json.dumps({"step": trainer.step, "seconds": round(trainer.seconds, 1), **entry}) + "\n")
            log.flush()

        sums: dict[str, float] = {}
        while trainer.step < config.steps and trainer.progress() < 1:
            for name, value in trainer.train_step().items():
                sums[name] = sums.get(name, 0.0) + value / 10
            if trainer.step % 10 == 0:
                write({name: round(value, 6) for name, value in sums.items()})
                sums = {}
            if trainer.step % config.validate_every == 0:
                write({name: round(value, 4) for name, value in trainer.validate().items()})
            if trainer.step % config.save_every == 0:
                trainer.save(checkpoint)
        write({name: round(value, 4) for name, value in trainer.validate().items()})
    trainer.save(checkpoint)


if __name__ == "__main__":
    main()
