"""The network against its formulas: shapes, positional embeddings, masks, the interpolation base."""

import math

import pytest
import torch

from anchors import find_base
from inbetween import InbetweenConfig, Inbetweener
from metrics import joints, matrices_of
from model import (
    INPUT_NAMES,
    Attention,
    KeyPoseDancer,
    LocalPositionalEmbedding,
    ModelConfig,
    count_weights,
    patches,
    positional_encoding,
)
from rotation import matrix_to_quaternion, quaternion_to_matrix, slerp
from samples import randomise, synthetic_inputs
from spec import JOINT_COUNT, MOTION_SIZE, ROTATION_SIZE


def tiny(random: bool = True) -> KeyPoseDancer:
    """A small model: random with an in-betweener, or untrained with SLERP alone as its base."""
    torch.manual_seed(0)
    config = ModelConfig.named("tiny")
    if random:
        return randomise(KeyPoseDancer(config), 1, 0.1).eval()
    config.inbetween = None
    return KeyPoseDancer(config).eval()


def run(model: KeyPoseDancer, inputs: dict) -> torch.Tensor:
    with torch.no_grad():
        return model(*(inputs[name] for name in INPUT_NAMES))


def test_sizes_of_the_paper():
    light, large = ModelConfig.named("light"), ModelConfig.named("large")
    assert (light.width, light.heads, light.cross_layers, light.encoder_layers) == (256, 4, 8, 4)
    assert (large.width, large.heads, large.cross_layers, large.encoder_layers) == (800, 10, 12, 4)
    light.inbetween = None  # the paper's own weights, without the learned base
    assert count_weights(KeyPoseDancer(light)) == pytest.approx(12.8e6, rel=0.04)
    with pytest.raises(ValueError, match="light, large or tiny"):
        ModelConfig.named("medium")


@pytest.mark.parametrize("seed_frames, frames", [(60, 90), (20, 31)])
def test_shapes_and_rotations(seed_frames, frames):
    motion = run(tiny(), synthetic_inputs(2, seed_frames, frames, 0))
    assert motion.shape == (2, frames, MOTION_SIZE) and motion.isfinite().all()
    columns = motion[..., :ROTATION_SIZE].view(2, frames, JOINT_COUNT, 2, 3)
    assert torch.allclose(columns.norm(dim=-1), torch.ones(2, frames, JOINT_COUNT, 2), atol=1e-5)
    assert (columns[..., 0, :] * columns[..., 1, :]).sum(-1).abs().max() < 1e-5


def test_positional_encoding_is_eq_7():
    table = positional_encoding(50, 8)
    for position in (0, 1, 49):
        for i in range(4):
            angle = position / 10000 ** (2 * i / 8)
            assert float(table[position, 2 * i]) == pytest.approx(math.sin(angle), abs=1e-6)
            assert float(table[position, 2 * i + 1]) == pytest.approx(math.cos(angle), abs=1e-6)


def test_local_positional_embedding_is_eq_8_to_10_with_sentinels():
    local = LocalPositionalEmbedding(ModelConfig.named("tiny"))  # width 32: 16 for each side
    rows = local(torch.tensor([[3.0, -1.0, 0.0]]), torch.tensor([[5.0, 2.0, -1.0]]))[0]
    table = positional_encoding(16, 16)
    assert torch.allclose(rows[0], torch.cat([table[3], table[5]]))
    assert torch.equal(rows[1], torch.cat([local.no_previous, table[2]]))
    assert torch.equal(rows[2], torch.cat([table[0], local.no_next]))


def test_attention_is_eq_1_and_2():
    config = ModelConfig.named("tiny")
    attention = Attention(config)
    x = torch.randn(2, 7, config.width)
    query, key, value = attention.query_key_value(x).chunk(3, -1)
    split = lambda v: v.view(2, 7, config.heads, -1).transpose(1, 2)  # noqa: E731
    expected = torch.nn.functional.scaled_dot_product_attention(split(query), split(key), split(value))
    assert torch.allclose(attention(x), attention.out(expected.transpose(1, 2).flatten(2)), atol=1e-5)


def test_patches_pad_at_the_end_or_at_the_start():
    x = torch.arange(8.0).reshape(1, 4, 2)
    assert torch.equal(patches(x, 3, 4), torch.tensor([[[0.0, 1, 2, 3, 4, 5], [6, 7, 6, 7, 6, 7]]]))
    assert torch.equal(patches(x, 3, 4, from_end=True), torch.tensor([[[0.0, 1, 0, 1, 0, 1], [2, 3, 4, 5, 6, 7]]]))


def test_untrained_model_is_slerp_between_the_keys():
    inputs = synthetic_inputs(1, 60, 60, 3)  # keys at 7, 27, 47
    motion = run(tiny(random=False), inputs)[0]
    quaternions = matrix_to_quaternion(matrices_of(inputs["key_poses"][0]))
    for a, b, t in ((7, 27, 7), (7, 27, 12), (27, 47, 40)):
        expected = slerp(quaternions[a], quaternions[b], torch.tensor([(t - a) / (b - a)]))
        assert torch.allclose(matrices_of(motion[t]), quaternion_to_matrix(expected), atol=1e-5)
    # Before the first key it comes from the last seed frame, 8 frames away from the key at 7.
    seed = matrix_to_quaternion(matrices_of(inputs["seed"][0, -1]))
    expected = slerp(seed, quaternions[7], torch.tensor([5 / 8]))
    assert torch.allclose(matrices_of(motion[4]), quaternion_to_matrix(expected), atol=1e-5)
    # After the last key it holds; the pelvis stays above the place where the seed left it.
    assert torch.allclose(motion[55, :ROTATION_SIZE], inputs["key_poses"][0, 47], atol=1e-5)
    place = motion[:, ROTATION_SIZE:][:, [0, 2]]
    assert torch.allclose(place, inputs["seed"][0, -1:, ROTATION_SIZE:][:, [0, 2]].expand(60, -1), atol=1e-6)


def test_without_keys_the_base_holds_the_seed():
    inputs = synthetic_inputs(2, 60, 40, 3)  # the last window of a batch has no key
    motion = run(tiny(random=False), inputs)[1]
    assert torch.allclose(motion[:, :ROTATION_SIZE], inputs["seed"][1, -1:, :ROTATION_SIZE].expand(40, -1), atol=1e-5)


def test_half_turn_between_keys_stays_finite():
    inputs = synthetic_inputs(1, 60, 60, 3)
    facing = torch.tensor([1.0, 0, 0, 0, 1, 0]).repeat(JOINT_COUNT)
    inputs["key_poses"][0, 7] = facing
    turned = facing.clone()
    turned[:3] = torch.tensor([-1.0, 0, 0])
    inputs["key_poses"][0, 27] = turned
    motion = run(tiny(random=False), inputs)
    assert motion.isfinite().all()
    steps = joints(motion[0, 8:27]).diff(dim=0).norm(dim=-1)
    assert steps.max() < 0.2  # turns evenly instead of snapping in the middle


def test_key_mask_gates_the_key_embedding():
    model, inputs = tiny(), synthetic_inputs(1, 60, 60, 3)
    before = run(model, inputs)
    stray = {**inputs, "key_poses": inputs["key_poses"].clone()}
    stray["key_poses"][0, 20] = 1.0  # not a key frame: nobody may look at it
    assert torch.equal(run(model, stray), before)


@pytest.mark.parametrize("name", ["music", "seed", "key_poses"])
def test_every_input_matters(name):
    model, inputs = tiny(), synthetic_inputs(1, 60, 60, 3)
    changed = {**inputs, name: inputs[name].roll(1, 1) if name != "key_poses" else inputs[name].clone()}
    if name == "key_poses":
        changed[name][0, 7, 24:30] = torch.tensor([0.0, 1, 0, -1, 0, 0])
    assert (run(model, changed) - run(model, inputs)).abs().max() > 1e-3


def test_windows_of_a_batch_do_not_mix():
    model, both = tiny(), synthetic_inputs(3, 60, 50, 4)
    together = run(model, both)
    for item in range(3):
        alone = run(model, {name: value[item : item + 1] for name, value in both.items()})
        assert torch.allclose(alone[0], together[item], atol=1e-5)


def test_base_features_do_not_depend_on_the_heading():
    inputs = synthetic_inputs(1, 60, 50, 4)
    names = ("seed", "key_poses", "to_previous", "to_next")
    torch.manual_seed(0)
    inbetweener = randomise(Inbetweener(InbetweenConfig(16, 16, 1, 4)), 2, 0.3)
    before = find_base(*(inputs[n] for n in names), inbetweener)
    for name in ("seed", "key_poses"):  # turn everybody by 90 degrees about Y: (x, y, z) -> (z, y, -x)
        column = lambda c: torch.stack([c[..., 2], c[..., 1], -c[..., 0]], -1)  # noqa: E731
        inputs[name] = torch.cat([column(inputs[name][..., :3]), column(inputs[name][..., 3:6]), inputs[name][..., 6:]], -1)
    after = find_base(*(inputs[n] for n in names), inbetweener)
    for name in ("pose", "steps", "velocity"):
        assert torch.allclose(getattr(after, name), getattr(before, name), atol=1e-4)


def test_layers_that_have_not_joined_change_nothing():
    torch.manual_seed(0)
    model = KeyPoseDancer(ModelConfig(width=32, heads=2, feedforward=64, encoder_layers=2, cross_layers=3, dropout=0)).eval()
    randomise(model.music_encoder.layers[0], 0)
    randomise(model.cross_encoder.layers[0], 1)
    randomise(model.head, 2)
    inputs = synthetic_inputs(1, 60, 40, 0)
    whole = run(model, inputs)
    model.set_depth(1, 1)
    assert torch.equal(run(model, inputs), whole)
