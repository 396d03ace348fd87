"""Training: learns a batch by heart, and goes on after a stop as if there had been none."""

import pytest
import torch

from conftest import make_clip
from loss import LossConfig, dance_loss
from model import INPUT_NAMES, KeyPoseDancer, ModelConfig
from train import TrainConfig, Trainer, validation_batches
from windows import WindowSampler

CONFIG = TrainConfig(model="tiny", steps=8, schedule="cosine", lr=2e-3, warmup=2, tokens=240, lengths=(60,), grow=(0.5,), dropout=0.1)


def make_trainer(config: TrainConfig = CONFIG) -> Trainer:
    return Trainer(config, LossConfig(), [make_clip(200, 0), make_clip(200, 1), make_clip(400, 2, "val")])


def test_overfits_one_batch():
    torch.manual_seed(0)
    batch = WindowSampler([make_clip(200, 0)], tokens=160, lengths=(45,), seed_frames=20).batch()
    model = KeyPoseDancer(ModelConfig(width=64, heads=2, feedforward=128, encoder_layers=1, cross_layers=2, dropout=0))
    model.fit_inputs([batch])
    optimiser = torch.optim.Adam(model.parameters(), 3e-3)
    values = []
    for _ in range(80):
        loss, terms = dance_loss(model(*(batch[name] for name in INPUT_NAMES)), batch, LossConfig())
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        values.append(terms["position"])
    assert values[-1] < 0.35 * values[0]


def test_resume_continues_identically(tmp_path):
    straight = make_trainer()
    expected = [straight.train_step() for _ in range(6)]
    stopped = make_trainer()
    for _ in range(3):
        stopped.train_step()
    stopped.save(tmp_path / "checkpoint.pt")
    torch.manual_seed(99)
    resumed = make_trainer()
    resumed.load(tmp_path / "checkpoint.pt")
    assert [resumed.train_step() for _ in range(3)] == expected[3:]
    for a, b in zip(straight.averaged.parameters(), resumed.averaged.parameters()):
        assert torch.equal(a, b)


def test_checkpoint_of_another_spec_is_refused(tmp_path, monkeypatch):
    trainer = make_trainer()
    monkeypatch.setattr("train.spec_hash", lambda: "other")
    trainer.save(tmp_path / "checkpoint.pt")
    monkeypatch.undo()
    with pytest.raises(ValueError, match="another spec"):
        make_trainer().load(tmp_path / "checkpoint.pt")


def test_schedules():
    trainer = make_trainer()
    rates = []
    for trainer.step in range(8):
        rates.append(trainer.learning_rate())
    assert rates[0] == pytest.approx(1e-3, rel=0.05) and max(rates) == rates[1] and rates[-1] < 0.1 * max(rates)
    paper = make_trainer(TrainConfig(model="tiny", lengths=(60,), tokens=240))
    for step, rate in ((0, 1e-4), (99_999, 1e-4), (100_000, 1e-5), (250_000, 1e-6)):
        paper.step = step
        assert paper.learning_rate() == pytest.approx(rate)


def test_untrained_validation_is_slerp():
    values = make_trainer().validate()
    assert values["val_cm"] == pytest.approx(values["val_slerp_cm"], rel=1e-3)
    assert values["val_cm"] > 0.5


def test_validation_windows_have_a_key_each_second_and_at_both_ends():
    batch = validation_batches([make_clip(700, 3, "val")])[0]
    assert batch["key_mask"].shape == (2, 211)  # the last whole second below the window length of 240
    mask = batch["key_mask"][0]
    assert mask[0] == 1 and mask[-1] == 1 and mask[::30].all() and mask.sum() == len(mask[::30])


def test_bf16_step_runs():
    trainer = make_trainer(TrainConfig(model="tiny", steps=2, tokens=240, lengths=(60,), precision="bf16"))
    assert trainer.train_step()["loss"] > 0
