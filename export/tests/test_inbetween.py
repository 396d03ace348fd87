"""The in-betweener against hand-worked curves, and its training."""

import pytest
import torch

import anchors
from anchors import LONGEST_GAP, find_anchors, find_base
from conftest import make_clip
from inbetween import GAP_SIZE, Inbetweener, InbetweenConfig, cubic_weights, gap_features, sample_curves
from metrics import matrices_of
from samples import randomise, synthetic_inputs
from spec import FPS, ROTATION_SIZE
from train_inbetween import (
    GapSampler,
    InbetweenTrainer,
    InbetweenTraining,
    gap_of,
    load_inbetweener,
    loss_terms,
    slerp_at,
)
from windows import key_distances

SMALL = InbetweenConfig(width=16, hidden=16, blocks=1, knots=4)
NAMES = ("seed", "key_poses", "to_previous", "to_next")


def test_cubic_weights_by_hand():
    # Four knots inside: they lie at 0, 0.2, 0.4 ... 1. At 0.3 the two neighbours weigh 9/16, the next ones -1/16.
    expected = torch.tensor([-1 / 16, 9 / 16, 9 / 16, -1 / 16, 0, 0])
    assert torch.allclose(cubic_weights(torch.tensor(0.3), 4), expected, atol=1e-6)
    assert torch.allclose(cubic_weights(torch.tensor(0.4), 4), torch.tensor([0.0, 0, 1, 0, 0, 0]), atol=1e-5)


def test_residual_is_zero_at_both_keys():
    turns, path = torch.randn(4, ROTATION_SIZE), torch.randn(6, 3)
    for end, knot in ((0.0, 0), (1.0, 5)):
        residual, way = sample_curves(turns, path, torch.tensor(end))
        assert residual.abs().max() < 1e-5
        assert torch.allclose(way, path[knot], atol=1e-5)


def test_base_comes_through_every_key_and_differs_from_slerp_between(monkeypatch):
    monkeypatch.setattr(anchors, "ROUNDING", 0.0)
    inputs = synthetic_inputs(1, 60, 60, 3)  # keys at 7, 27, 47
    inbetweener = randomise(Inbetweener(SMALL), 1, 0.2)
    values = [inputs[name] for name in NAMES]
    bent, plain = find_base(*values, inbetweener), find_base(*values)
    rotations = torch.stack(bent.columns, -1)[0]
    for key in (7, 27, 47):
        assert torch.allclose(rotations[key], matrices_of(inputs["key_poses"][0, key]), atol=1e-5)
    apart = (bent.columns[0] - plain.columns[0]).abs().amax((-1, -2))[0]
    assert apart[17] > 1e-2
    assert apart[48:].max() < 1e-6  # after the last key there is no gap to bend


def test_gap_too_long_for_the_inbetweener_is_slerp():
    frames = 150
    inputs = synthetic_inputs(1, 60, frames, 3)
    mask = torch.zeros(1, frames)
    mask[0, [0, 140]] = 1
    to_previous, to_next = (d[None] for d in key_distances(mask[0]))
    values = [inputs["seed"], inputs["key_poses"], to_previous, to_next]
    assert 140 / FPS > LONGEST_GAP + 1.4
    bent, plain = find_base(*values, randomise(Inbetweener(SMALL), 1, 0.2)), find_base(*values)
    assert torch.allclose(bent.columns[0][:, 3:-12], plain.columns[0][:, 3:-12], atol=1e-3)


def test_anchors_of_a_frame():
    inputs = synthetic_inputs(1, 60, 60, 3)  # keys at 7, 27, 47
    found = find_anchors(*(inputs[name] for name in NAMES))
    keys = matrices_of(inputs["key_poses"][0])
    for pose, key in zip(found.gap.poses[1:], (7, 27, 47)):
        assert torch.allclose(pose[0, 12], keys[key], atol=1e-5)
    # Before the first key lies the last seed frame, 8 frames earlier.
    assert torch.allclose(found.gap.poses[0][0, 12], matrices_of(inputs["seed"][0, -1]), atol=1e-5)
    assert torch.allclose(found.gap.seconds[0, 12], torch.tensor([8.0, 20.0, 20.0]) / FPS)
    assert float(found.fraction[0, 12]) == pytest.approx(5 / 20)


def test_features_have_their_size_and_no_heading(clip):
    batch = GapSampler([clip], InbetweenTraining(gaps=40)).batch()
    features = gap_features(gap_of(batch))
    assert features.shape[1] == GAP_SIZE and features.isfinite().all()


def test_targets_lie_where_the_fractions_say():
    clip = make_clip(400)
    sampler = GapSampler([clip], InbetweenTraining(gaps=60, tempo=(1.0, 1.0)))
    batch = sampler.batch()
    assert batch["fraction"].min() >= 0 and batch["fraction"].max() <= 1
    # The dance of SLERP is off by nothing where a gap is two frames long and by more where it is a second.
    error = (slerp_at(gap_of(batch), batch["fraction"])[..., :2] - matrices_of(batch["target"])[..., :2]).abs().amax((-1, -2, -3, -4, -5))
    short, long = batch["lengths"][:, 1] <= 12, batch["lengths"][:, 1] > 40
    assert error[short].mean() < 0.5 * error[long].mean()


def test_real_motion_costs_nothing_but_its_path():
    batch = GapSampler([make_clip(400)], InbetweenTraining(gaps=60)).batch()
    rotations = matrices_of(batch["target"])
    terms = loss_terms(rotations, torch.zeros(*batch["fraction"].shape, 3), batch)
    # Joints of frames between two recorded ones are taken along the chord, hence a millimetre.
    assert float(terms["position"]) < 2e-3 and float(terms["rotation"]) < 5e-3 and float(terms["speed"]) < 1e-2


def test_learns_and_resumes(tmp_path):
    clips = [make_clip(500), make_clip(200)]
    clips[1].split = "val"
    config = InbetweenTraining(gaps=64, moments=2, steps=60, warmup=5, lr=3e-3, noise=0.0, seed=3)
    trainer = InbetweenTrainer(config, SMALL, clips)
    draw, kept = trainer.sampler.batch, trainer.sampler.batch()
    trainer.sampler.batch = lambda: kept
    losses = [trainer.train_step()["position"] for _ in range(60)]
    assert losses[-1] < 0.6 * losses[0]  # can learn one batch by heart
    trainer.sampler.batch = draw
    trainer.save(tmp_path / "checkpoint.pt")
    other = InbetweenTrainer(config, SMALL, clips)
    other.load(tmp_path / "checkpoint.pt")
    torch.manual_seed(1)
    again = other.train_step()
    torch.manual_seed(1)
    assert again == trainer.train_step()
    loaded = load_inbetweener(tmp_path / "checkpoint.pt")
    assert loaded.config == SMALL
