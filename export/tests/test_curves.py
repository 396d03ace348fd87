"""Kochanek-Bartels curves: values worked out by hand, smoothness through keys, and that a fit finds a curve again."""

import pytest
import torch

from curve_fit import errors, fit
from curves import Curves, align_signs, knot_rows, motion_channels, sample, sample_evenly, tangents
from danceformer_data import motion_to_channels
from samples import synthetic_motion

TIMES = torch.tensor([0.0, 3.0])


def one_channel(values: tuple[float, float, float, float], tension=0.0, continuity=0.0, bias=0.0) -> Curves:
    """One interval of three seconds, knots at 0, 1, 2, 3 s."""
    keys = torch.tensor([[values[0]], [values[3]]], dtype=torch.float32)
    inner = torch.tensor([[[values[1]], [values[2]]]], dtype=torch.float32)
    return Curves(TIMES, keys, inner, torch.tensor([[[tension], [continuity], [bias]]], dtype=torch.float32))


def at(curves: Curves, *times: float) -> list[float]:
    return sample(curves, torch.tensor(times))[:, 0].tolist()


def test_knots_on_a_line_give_the_line():
    assert at(one_channel((1, 2, 3, 4)), 0, 0.25, 1.5, 2.9, 3) == pytest.approx([1, 1.25, 2.5, 3.9, 4])


def test_half_way_to_the_first_knot_by_hand():
    # Leaving key 0 with the slope 1, arriving at knot 1 with (0 - 0) / 2 = 0: 0.5 * 0 + 0.125 * 1 + 0.5 * 1 - 0.125 * 0.
    assert at(one_channel((0, 1, 0, 0)), 0.5) == pytest.approx([0.625])
    # Full tension stops at every knot: the middle is the mean.
    assert at(one_channel((0, 1, 0, 0), tension=1), 0.5) == pytest.approx([0.5])
    # Full bias looks back only: (1 + 1) * 1 / 2 = 1 on both sides of knot 1.
    assert at(one_channel((0, 1, 0, 0), bias=1), 0.5) == pytest.approx([0.5])
    # Full continuity turns the arrival to the line ahead, 2 * -1 / 2 = -1: 0.125 + 0.5 + 0.125.
    assert at(one_channel((0, 1, 0, 0), continuity=1), 0.5) == pytest.approx([0.75])


def test_velocities_by_hand():
    arriving, leaving = tangents(*knot_rows(one_channel((0, 1, 0, 0), continuity=1)))
    assert arriving[:, 0].tolist() == pytest.approx([1, -1, 0, 0])
    assert leaving[:, 0].tolist() == pytest.approx([1, 1, -1, 0])


def test_uneven_knots_take_the_line_between_the_neighbours():
    curves = Curves(torch.tensor([0.0, 1.0, 4.0]), torch.tensor([[0.0], [1.0], [1.0]]), torch.tensor([[[0.0], [0.0]], [[4.0], [0.0]]]), torch.zeros(2, 3, 1))
    arriving, leaving = tangents(*knot_rows(curves))
    # Key 1 at 1 s lies between 0 (1/3 s before) and 4 (1 s after): (4 - 0) / (4/3) = 3.
    assert arriving[3, 0].item() == pytest.approx(3) and leaving[3, 0].item() == pytest.approx(3)


def test_a_key_takes_the_mean_of_both_intervals_so_the_velocity_does_not_jump():
    rng = torch.Generator().manual_seed(0)
    tcb = torch.rand(3, 3, 4, generator=rng)
    tcb[:, 1] = 0
    curves = Curves(torch.tensor([0.0, 0.5, 1.3, 2.0]), torch.randn(4, 4, generator=rng), torch.randn(3, 2, 4, generator=rng), tcb)
    handles = knot_rows(curves)[2]
    assert torch.allclose(handles[3], (tcb[0] + tcb[1]) / 2)
    arriving, leaving = tangents(*knot_rows(curves))
    assert torch.allclose(arriving, leaving, atol=1e-6)


def test_outside_the_keys_the_dance_holds():
    assert at(one_channel((5, 1, 0, 7)), -1, 9) == [5, 7]


def test_even_moments_agree_with_the_search():
    rng = torch.Generator().manual_seed(1)
    curves = Curves(torch.tensor([0.0, 0.4, 1.3]), torch.randn(3, 5, generator=rng), torch.randn(2, 2, 5, generator=rng), torch.rand(2, 3, 5, generator=rng) - 0.5)
    share = (torch.arange(9) + 0.5) / 9
    times = curves.times[:-1, None] + (curves.times[1:] - curves.times[:-1])[:, None] * share
    assert torch.allclose(sample_evenly(curves).flatten(0, 1), sample(curves, times.flatten()), atol=1e-5)


def test_signs_run_on():
    quaternions = torch.tensor([[[0.0, 0, 0, -1]], [[0.1, 0, 0, 0.99]], [[-0.2, 0, 0, -0.97]]])
    aligned = align_signs(quaternions)
    assert aligned[:, 0, 3].min() > 0


@pytest.mark.parametrize("form, centimetres", [("knots", 2.5), ("5 values", 1.5), ("sparse", 2.0)])
def test_fit_holds_smooth_motion(form, centimetres):
    channels = motion_to_channels(synthetic_motion(120, torch.Generator().manual_seed(2)))
    made, numbers = fit(channels, torch.arange(0, 120, 17.0), form, rounds=120)
    assert float(errors(channels, made)[0].mean()) < centimetres
    assert {"knots": 3, "5 values": 6}.get(form, numbers) == pytest.approx(numbers) and 3 <= numbers <= 6


def test_quaternions_have_length_one():
    values = torch.randn(6, 99)
    assert torch.allclose(motion_channels(values)[1].norm(dim=-1), torch.ones(6, 24))
