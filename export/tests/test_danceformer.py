"""DanceFormer's networks: a step is the whole model, ONNX answers like torch, masks and data are what they say."""

import json
from pathlib import Path

import numpy as np
import onnx
import pytest
import torch

import suggest
from ablate_danceformer import finer
from conftest import make_clip
from curve_net import CurveConfig, CurveNet, ground_height, small_quaternion
from curves import Curves, sample
from danceformer_data import Dance, IntervalSampler, KeySampler, bar_places, beat_music, deltas, interval_music, motion_to_channels
from danceformer_loss import CurveLoss, KeyLoss, LossConfig, curves_of, key_targets
from dance_metrics import pose_vectors
from dantrans import FkIkBlock, JointFc, Reach, TREE_ORDER, DanTransConfig, fold_norms
from export_danceformer import made_up_inputs, names_of, run, to_onnx
from export_onnx import compress
from frame_net import FrameNet
from inbetween import InbetweenConfig, Inbetweener
from metrics import matrices_of
from rotation import axis_angle_to_matrix, matrix_to_quaternion, matrix_to_six_d, quaternion_to_matrix
from samples import synthetic_motion
from skeleton import forward_kinematics, mirror_motion
from spec import FPS, JOINT_COUNT, PARENTS, ROTATION_SIZE, TOE_HEIGHT, TOES, spec_hash
from suggest import BEAT_SIZE, CODES, PAST_BEATS, PAST_POSES, STEP, SuggestConfig, Suggester, part_joints, steps
from train_danceformer import Settings, Trainer, find_codes

MODELS = Path(__file__).resolve().parents[2] / "public" / "models"
SMALL = DanTransConfig(width=8, music_width=16, dropout=0.0)


def settled(model, name: str):
    """A network whose BatchNorms have seen a batch, and whose last layers are not zero."""
    torch.manual_seed(1)
    for parameter in model.parameters():
        if not parameter.any():
            torch.nn.init.normal_(parameter, std=0.05)
    inputs = made_up_inputs(name, 32, 1)
    momentum, JointFc.momentum = JointFc.momentum, 1.0
    with torch.no_grad():
        model.train()(*(inputs[n] for n in names_of(name)[0]))
    JointFc.momentum = momentum
    return model.eval()


@pytest.fixture(scope="module")
def small_suggest() -> Suggester:
    torch.manual_seed(0)
    model = Suggester(SuggestConfig(net=SMALL, code_width=8, parts=2))
    poses = synthetic_motion(CODES, torch.Generator().manual_seed(2), 0.6)[:, :ROTATION_SIZE].unflatten(1, (24, 6))
    for part, members in enumerate(part_joints(2)):
        own = slice(part * CODES // 2, (part + 1) * CODES // 2)
        model.code_rotations.unflatten(1, (24, 6))[own, members] = poses[own, members]
    model.code_steps[: CODES // 2] = torch.tensor([0.0, 1, 0.95, 0.02, 0.05])
    return settled(model, "suggest")


@pytest.fixture(scope="module")
def small_curves() -> CurveNet:
    torch.manual_seed(0)
    return settled(CurveNet(CurveConfig(net=SMALL)), "curves")


def made_dance(frames: int = 400) -> Dance:
    clip = make_clip(frames, 3)
    motions = (clip.motion, mirror_motion(clip.motion))
    rng = np.random.default_rng(1)
    table = rng.standard_normal((frames, 53)).astype(np.float32)
    music = beat_music(table, clip.beats.numpy() / FPS, bar_places(clip.beats.numpy(), clip.downbeats.numpy(), 4))
    channels, vectors = (tuple(f(m) for m in motions) for f in (motion_to_channels, pose_vectors))
    return Dance(clip, motions, clip.valid.all(-1), torch.eye(len(suggest.STYLES))[2], clip.beats, torch.from_numpy(music), torch.from_numpy(table), 0.0, channels, vectors)


def test_messages_go_along_the_tree():
    torch.manual_seed(0)
    block = FkIkBlock(4).eval()
    x = torch.randn(JOINT_COUNT, 2, 4)
    with torch.no_grad():
        found = block(x)
        down: dict[int, torch.Tensor] = {}

        def fc(stack, joint, value):
            level, place = next((depth, lv.index(joint)) for depth, lv in enumerate(suggest_levels()) if joint in lv)
            linear = stack[level].linear
            return torch.relu(value / (1 + 1e-3) ** 0.5 @ linear.weight[place] + linear.bias[place])

        for joint in TREE_ORDER:
            taken = down[PARENTS[joint]] if PARENTS[joint] >= 0 else 0
            down[joint] = fc(block.down, joint, x[TREE_ORDER.index(joint)] + taken)
        up: dict[int, torch.Tensor] = {}
        for joint in reversed(TREE_ORDER):
            below = sum((up[child] for child in range(JOINT_COUNT) if PARENTS[child] == joint), torch.zeros(2, 4))
            up[joint] = fc(block.up, joint, down[joint] + below)
    expected = torch.stack([up[joint] for joint in TREE_ORDER])
    assert torch.allclose(found, expected, atol=1e-5)


def suggest_levels():
    from skeleton import LEVELS

    return LEVELS


def test_folding_changes_nothing(small_curves):
    import copy

    inputs = made_up_inputs("curves", 5, 9)
    folded = fold_norms(copy.deepcopy(small_curves))
    with torch.no_grad():
        for ours, theirs in zip(small_curves(*inputs.values()), folded(*inputs.values())):
            assert torch.allclose(ours, theirs, atol=1e-4)


def test_reach_hides_what_is_beyond():
    reach = Reach(3, -2, 0, "learned")
    at = torch.arange(6)
    mask = reach(at[None, :] - at[:, None], causal=True)
    assert mask.shape == (3, 6, 6)
    assert (mask[:, 5, :3] < -1e4).all() and (mask[:, 2, 3:] < -1e4).all() and mask[0, 5, 5] == 0 and mask[0, 5, 3] == -1


def test_a_step_on_the_last_poses_is_the_whole_model(small_suggest):
    """Twenty poses in a row through the decoder give the same last choice as the step on the last sixteen."""
    rng = torch.Generator().manual_seed(5)
    count, back = 30, 6
    poses = synthetic_motion(15 * count, rng)[None, ::15]
    music = torch.randn(1, count + 1 + 2 * back, BEAT_SIZE, generator=rng)
    style, ones = torch.zeros(1, len(suggest.STYLES)), torch.ones(1, count)
    with torch.no_grad():
        rotations, step = steps(poses, ones)
        heard = small_suggest.hear(music, torch.ones(1, music.shape[1]), style)
        # Token i stands for pose i + 1 and predicts beat i + 2, which the music has at i + 2 + 6.
        long = small_suggest.decode(rotations, step, ones, heard, 2 + back)[:, :, -1:]
        at = count + back  # the music of the beat after the last pose
        heard = small_suggest.hear(music[:, at - PAST_BEATS : at + back + 1], torch.ones(1, PAST_BEATS + back + 1), style)
        earlier = suggest.without_heading(poses[:, -PAST_POSES:][:, :1], *suggest.facing(poses[:, -PAST_POSES:][:, :1]))
        rotations, step = steps(poses[:, -PAST_POSES:], ones[:, :PAST_POSES])
        short = small_suggest.decode(rotations, step, ones[:, :PAST_POSES], heard, PAST_BEATS - PAST_POSES + 2, earlier)[:, :, -1:]
    assert torch.allclose(long, short, atol=1e-4)


def test_the_suggested_pose_turns_with_the_dancer(small_suggest):
    """Turned and moved history, turned and moved result."""
    inputs = made_up_inputs("suggest", 1, 3)
    inputs["next_beats"][:] = -1
    angle = torch.tensor(0.8)
    from rotation import yaw_matrix

    turn = yaw_matrix(angle)
    poses = inputs["poses"]
    moved = poses.clone()
    moved[..., :6] = matrix_to_six_d(turn @ matrices_of(poses[..., :6])[..., 0, :, :])
    moved[..., ROTATION_SIZE:] = poses[..., ROTATION_SIZE:] @ turn.T + torch.tensor([1.0, 0.0, -2.0])
    with torch.no_grad():
        ours, code = small_suggest(*(inputs[n] for n in suggest.INPUTS))
        theirs, same = small_suggest(*({**inputs, "poses": moved}[n] for n in suggest.INPUTS))
    assert torch.equal(code, same) and code.shape == (1, 2)
    expected = ours[:, ROTATION_SIZE:] @ turn.T + torch.tensor([1.0, 0.0, -2.0])
    assert torch.allclose(theirs[:, ROTATION_SIZE:], expected, atol=1e-4)
    assert torch.allclose(theirs[:, 6:ROTATION_SIZE], ours[:, 6:ROTATION_SIZE], atol=1e-4)


def test_noise_forbids_codes(small_suggest):
    inputs = made_up_inputs("suggest", 4, 3)
    with torch.no_grad():
        code = small_suggest(*(inputs[n] for n in suggest.INPUTS))[1].long()
        inputs["noise"][torch.arange(4)[:, None], code] = -1e9
        other = small_suggest(*(inputs[n] for n in suggest.INPUTS))[1].long()
    assert (code != other).all()
    # Legs from the first half of the codes, what is above them from the second.
    for found in (code, other):
        assert (found[:, 0] < CODES // 2).all() and (found[:, 1] >= CODES // 2).all()


def test_untrained_curves_are_the_slerp():
    model = CurveNet(CurveConfig(net=SMALL)).eval()
    inputs = made_up_inputs("curves", 3, 4)
    with torch.no_grad():
        curves, root = model(*inputs.values())
    assert curves.shape == (3, 99, 5) and not curves[..., :3].any() and not curves[:, :3, 3:].any()
    inner = curves[:, 3:, 3].unflatten(1, (JOINT_COUNT, 4))
    angles = [2 * torch.acos((a * b).sum(-1).abs().clamp(max=1)) for a, b in ((inputs["keys"][:, 1], inner), (inputs["keys"][:, 1], inputs["keys"][:, 2]))]
    assert torch.allclose(angles[0], angles[1] / 3, atol=2e-3)
    toes = forward_kinematics(quaternion_to_matrix(inputs["keys"][:, 2]))[:, TOES, 1].amin(-1)
    assert torch.allclose(root[:, 1, 1] + toes, torch.tensor(TOE_HEIGHT))


def test_untrained_frames_are_the_slerp():
    model = FrameNet(CurveConfig(net=SMALL)).eval()
    inputs = made_up_inputs("curves", 3, 4)
    with torch.no_grad():
        poses, offsets, path = model(*inputs.values())
    assert poses.shape == (3, 9, JOINT_COUNT, 4) and not offsets.any() and not path.any()
    start, end = inputs["keys"][:, 1], inputs["keys"][:, 2]
    angle = lambda a, b: 2 * torch.acos((a * b).sum(-1).abs().clamp(max=1))  # noqa: E731
    assert torch.allclose(angle(start, poses[:, 1]), angle(start, end) / 6, atol=3e-3)


def test_frames_learn_from_the_loss_of_curves():
    torch.manual_seed(0)
    model = FrameNet(CurveConfig(net=SMALL))
    batch = IntervalSampler([made_dance()], 6, 0).batch()
    optimiser = torch.optim.Adam(model.parameters(), 5e-3)
    losses = []
    for _ in range(12):
        loss, terms, _ = CurveLoss(LossConfig())(model, batch)
        assert terms["shape"] == 0
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(float(loss.detach()))
    assert losses[-1] < 0.95 * losses[0]


def test_a_finer_dance_keeps_its_beats_and_hears_between_them():
    dance = made_dance()
    fine = finer(dance, 3)
    assert torch.allclose(fine.beats[::3], dance.beats) and len(fine.beats) == 3 * (len(dance.beats) - 1) + 1
    assert torch.allclose(fine.music[::3, :53], dance.music[:, :53], atol=1e-4)
    assert torch.allclose(fine.beats[1] - fine.beats[0], (dance.beats[1] - dance.beats[0]) / 3)
    assert fine.music.shape == (len(fine.beats), BEAT_SIZE)


def test_a_trunk_is_trained_only_when_it_is_asked_for(tmp_path):
    whole = Inbetweener(InbetweenConfig(width=16, hidden=16, blocks=1))
    torch.save({"sizes": whole.config.as_dict(), "averaged": whole.state_dict()}, tmp_path / "trunk.pt")
    dances = [made_dance()]
    for rate in (0.0, 0.5):
        torch.manual_seed(0)
        settings = Settings(stage="curves", steps=3, rows=2, width=8, trunk=str(tmp_path / "trunk.pt"), trunk_rate=rate)
        trainer = Trainer(settings, LossConfig(), dances, [])
        before = trainer.model.trunk.turns.weight.clone()
        while not trainer.done():
            trainer.step()
        assert torch.equal(before, trainer.model.trunk.turns.weight) == (rate == 0)
    rates = {group["share"]: group["lr"] for group in trainer.optimiser.param_groups}
    assert rates[0.5] == pytest.approx(rates[1.0] / 2)


def test_ground_height_stands_the_figure_on_the_floor():
    rest = torch.eye(3).expand(JOINT_COUNT, 3, 3)
    assert float(ground_height(rest)) == pytest.approx(TOE_HEIGHT + 0.09 + 0.38 + 0.4 + 0.06)


def test_small_quaternion():
    matrix = axis_angle_to_matrix(torch.tensor([0.3, -0.5, 0.2]))
    expected = matrix_to_quaternion(matrix)
    assert torch.allclose(small_quaternion(matrix_to_six_d(matrix)), expected, atol=1e-6)


@pytest.mark.parametrize("name", ["suggest", "curves"])
def test_onnx_answers_like_torch(name, small_suggest, small_curves):
    import copy

    model = copy.deepcopy({"suggest": small_suggest, "curves": small_curves}[name])
    proto = to_onnx(model, name)
    assert {node.domain for node in proto.graph.node} <= {"", "ai.onnx"} and "Attention" not in {node.op_type for node in proto.graph.node}
    inputs, outputs = names_of(name)
    for batch in (1, 4):
        given = made_up_inputs(name, batch, 11)
        with torch.no_grad():
            expected = dict(zip(outputs, model(*(given[n] for n in inputs))))
        for form, tolerance in (("fp32", 1e-4), ("fp16", 2e-2)):
            made = run((proto if form == "fp32" else compress(proto, form, name)).SerializeToString(), name, given)
            for output in outputs:
                if form == "fp32" or output != "code":
                    same = slice(None) if name == "curves" else np.flatnonzero((made["code"] == expected["code"].numpy()).all(-1))
                    assert np.abs(made[output][same] - expected[output].numpy()[same]).max(initial=0) <= tolerance, (form, output)


def test_music_of_a_beat_by_hand():
    table = np.zeros((40, 53), np.float32)
    table[:, 0] = 2.0  # constant: any weighted mean is 2
    table[17, -1] = 0.7  # an onset two frames after the beat
    music = beat_music(table, np.array([0.5, 1.0]), np.array([0.25, np.nan]))
    assert music[0, 0] == pytest.approx(2) and music[0, 53] == pytest.approx(0.7) and music[1, 53] == 0
    assert music[0, 54:56] == pytest.approx([1, 0], abs=1e-6) and not music[1, 54:56].any()
    assert music[:, 56] == pytest.approx([0, 0])


def test_bar_places_count_back_before_the_first_downbeat():
    assert bar_places(np.arange(5) * 0.5, np.array([1.0]), 4).tolist() == [0.5, 0.75, 0, 0.25, 0.5]


def test_deltas_of_a_line_are_its_slope():
    values = np.arange(30.0)[:, None] * 3
    assert deltas(values)[10, 0] == pytest.approx(3)


def test_interval_music_is_between_the_frames():
    table = torch.arange(20.0)[:, None].expand(-1, 53).contiguous()
    music = interval_music(table, torch.tensor([2.0]), torch.tensor([10.0]), 8)
    assert music[0, :, 0].tolist() == pytest.approx([2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5])


def test_key_rows_and_targets_fit():
    rows = KeySampler([made_dance()], 3, 12, 0).batch()
    targets = key_targets(rows)
    assert rows.poses.shape == (3, 12, 147) and rows.music.shape == (3, 24, BEAT_SIZE)
    assert targets.known[:, :2].sum() == 0 and targets.rotations.shape == (3, 12, ROTATION_SIZE)
    # What is told of beat i is the pose of beat i - 1.
    both = (rows.valid[:, 1:] * rows.valid[:, :-1]) > 0
    assert torch.allclose(targets.rotations[:, 1:][both], targets.target[:, :-1][both], atol=1e-6)
    assert (rows.next_index[rows.next_index >= 0] > 0).all()
    assert torch.equal(targets.beats > 0, rows.next_index >= 0)


@pytest.mark.parametrize("parts", [1, 2])
def test_codes_are_found_part_by_part(parts):
    rng = torch.Generator().manual_seed(0)
    centres, rotations, steps_ = find_codes([made_dance()], rng, parts, rounds=2)
    assert [len(found) for found in centres] == [CODES // parts] * parts
    members = part_joints(parts)
    assert sorted(joint for part in members for joint in part) == list(range(24))
    for part, own in enumerate(members):
        mine = rotations.unflatten(1, (24, 6))[part * CODES // parts : (part + 1) * CODES // parts]
        others = [joint for joint in range(24) if joint not in own]
        # Columns of rotations inside the part, nothing outside it.
        assert torch.allclose(mine[:, own, :3].norm(dim=-1), torch.ones(len(mine), len(own)), atol=1e-5)
        assert not mine[:, others].any()
    first = steps_[: CODES // parts]
    assert torch.allclose(first[:, :2].norm(dim=-1), torch.ones(len(first)), atol=1e-5) and not steps_[CODES // parts :].any()
    # One of each part makes a whole pose.
    whole = rotations.unflatten(0, (parts, -1))[:, 0].sum(0).unflatten(0, (24, 6))
    assert torch.allclose(whole[:, 3:].norm(dim=-1), torch.ones(24), atol=1e-5)


def test_the_second_part_is_chosen_for_the_first():
    torch.manual_seed(0)
    model = Suggester(SuggestConfig(net=SMALL, code_width=8, parts=2)).eval()
    x = torch.randn(24, 1, 1, 8)
    legs = model.scores(x, [])
    assert legs.shape == (1, 1, CODES // 2)
    above = [model.scores(x, [torch.tensor([[code]])]) for code in (0, 1)]
    assert above[0].shape == (1, 1, CODES // 2) and not torch.allclose(*above)


@pytest.mark.parametrize("parts", [1, 2])
def test_losses_have_gradients_everywhere_that_matters(parts):
    dance = made_dance()
    rows = KeySampler([dance], 4, 12, 0).batch()
    model = Suggester(SuggestConfig(net=SMALL, code_width=8, parts=parts)).train()
    centres, rotations, steps_ = find_codes([dance], torch.Generator().manual_seed(0), parts, rounds=1)
    model.code_steps.copy_(steps_)
    model.code_rotations.copy_(rotations)
    loss, terms, _ = KeyLoss(LossConfig(), centres)(model, rows, torch.Generator().manual_seed(0))
    loss.backward()
    assert terms.keys() == {"codes", "rotation", "position", "step"} and all(np.isfinite(v) for v in terms.values())
    assert all(p.grad is not None for n, p in model.named_parameters())
    net = CurveNet(CurveConfig(net=SMALL)).train()
    loss, terms, _ = CurveLoss(LossConfig())(net, IntervalSampler([dance], 4, 0).batch())
    loss.backward()
    assert net.turns.weight.grad.any() and net.path.weight.grad.any()


def test_real_inner_knots_come_back_through_the_output_form():
    """Curves packed as the network gives them sample as the curves they were."""
    rng = torch.Generator().manual_seed(3)
    knots = motion_to_channels(synthetic_motion(4 * 3 + 1, rng))
    keys, inner = knots[::3], knots[:-1].unflatten(0, (-1, 3))[:, 1:]
    seconds = torch.tensor([0.4, 0.5, 0.6, 0.5])
    line = keys[:-1, None, :3] + (keys[1:, None, :3] - keys[:-1, None, :3]) * torch.tensor([1 / 3, 2 / 3])[:, None]
    packed = torch.cat([inner[..., :3] - line, inner[..., 3:]], -1)
    shape = torch.rand(4, 3, 99, generator=rng) - 0.5
    output = torch.cat([shape, packed], 1).transpose(1, 2)
    curves = curves_of(output, keys, seconds)
    at = torch.linspace(0, 2, 30)
    assert torch.allclose(sample(curves, at), sample(Curves(curves.times, keys, inner, shape), at), atol=1e-5)


@pytest.mark.parametrize("name", ["suggest", "curves"])
def test_shipped_model_gives_its_golden_run(name):
    if not (MODELS / f"{name}.onnx").exists():
        pytest.skip("not exported yet")
    header = json.loads((MODELS / f"{name}.golden.json").read_text())
    manifest = json.loads((MODELS / f"{name}.json").read_text())
    assert header["specHash"] == manifest["specHash"] == spec_hash()
    data = np.fromfile(MODELS / f"{name}.golden.bin", "<f4")
    arrays = {n: data[a["offset"] : a["offset"] + int(np.prod(a["shape"]))].reshape(a["shape"]) for n, a in header["arrays"].items()}
    inputs, outputs = names_of(name)
    shipped = (MODELS / f"{name}.onnx").read_bytes()
    assert len(shipped) == manifest["bytes"]
    made = run(shipped, name, {n: torch.from_numpy(arrays[n].copy()) for n in inputs})
    for output in outputs:
        assert np.abs(made[output] - arrays[output]).max() <= 1e-4
    metadata = {entry.key: entry.value for entry in onnx.load(MODELS / f"{name}.onnx").metadata_props}
    assert metadata["specHash"] == spec_hash()
