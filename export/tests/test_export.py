"""ONNX files answer like torch, at other lengths than they were exported with; golden files are up to date."""

import json
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import pytest
import torch
from onnx import TensorProto, helper, numpy_helper

import golden
from compress import pack_six_bits, quantise, six_bit_constants, unpack_six_bits
from export_onnx import compress, run_onnx, to_onnx
from model import INPUT_NAMES, OUTPUT_NAME, KeyPoseDancer, ModelConfig
from samples import randomise, synthetic_inputs
from shapes import SOURCES, measure_shapes, name_lengths
from spec import spec_hash

TESTS = Path(__file__).resolve().parents[2] / "tests" / "golden"
MODELS = Path(__file__).resolve().parents[2] / "public" / "models"


@pytest.fixture(scope="module")
def light():
    torch.manual_seed(0)
    model = randomise(KeyPoseDancer(ModelConfig.named("light")), 0, 0.02).eval()
    return model, to_onnx(model, "light")


def torch_output(model, inputs) -> np.ndarray:
    with torch.no_grad():
        return model(*(inputs[name] for name in INPUT_NAMES)).numpy()


@pytest.mark.parametrize("batch, seed_frames, frames", [(1, 60, 240), (2, 30, 77)])
def test_fp32_parity(light, batch, seed_frames, frames):
    model, proto = light
    inputs = synthetic_inputs(batch, seed_frames, frames, 4)
    assert np.abs(run_onnx(proto, inputs, 2) - torch_output(model, inputs)).max() <= 1e-4


def test_compressed_forms_stay_close_and_get_small(light):
    model, proto = light
    inputs = synthetic_inputs(1, 60, 120, 4)
    expected, full = torch_output(model, inputs), proto.ByteSize()
    for form, share, error in (("fp16", 0.52, 1e-3), ("q8", 0.28, 0.02), ("q6", 0.22, 0.08)):
        small = compress(proto, form, "light")
        assert small.ByteSize() < share * full
        assert np.abs(run_onnx(small, inputs, 2) - expected).mean() <= error


def test_plain_operators_and_metadata(light):
    proto = light[1]
    assert {node.domain for node in proto.graph.node} <= {"", "ai.onnx"}
    assert "Attention" not in {node.op_type for node in proto.graph.node}
    metadata = {entry.key: entry.value for entry in proto.metadata_props}
    assert metadata["specHash"] == spec_hash() and metadata["precision"] == "fp32"
    assert "MIT" in metadata["licence"] and "AIST++" in metadata["attribution"]
    axes = {i.name: [d.dim_param for d in i.type.tensor_type.shape.dim][:2] for i in proto.graph.input}
    assert axes["music"] == ["B", "T"] and axes["seed"] == ["B", "S"]


def test_lengths_inside_the_graph_are_named_for_what_they_are(light):
    proto = light[1]
    named = {v.name: [d.dim_param or d.dim_value for d in v.type.tensor_type.shape.dim] for v in proto.graph.value_info}
    sources = {name for node in proto.graph.node if node.op_type in SOURCES for name in node.output}
    assert len(named) > 100 and set(named) <= sources
    sizes = ((1, 44, 90), (2, 23, 31))  # none of those that gave the names
    for name, (_, shapes) in measure_shapes(proto, sizes).items():
        for axis, dim in enumerate(named.get(name, [])):
            expected = {"B": 0, "S": 1, "T": 2}.get(dim)
            for size, shape in zip(sizes, shapes):
                if expected is not None:
                    assert shape[axis] == size[expected], name
                elif isinstance(dim, int):
                    assert shape[axis] == dim, name


def test_a_tensor_whose_number_of_axes_changes_is_refused():
    nodes = [helper.make_node("Shape", ["music"], ["shape"]), helper.make_node("Squeeze", ["music"], ["thin"]), helper.make_node("Size", ["thin"], ["size"])]
    music = helper.make_tensor_value_info("music", TensorProto.FLOAT, ["B", "T", 15])
    graph = helper.make_graph(nodes, "g", [music], [helper.make_tensor_value_info("size", TensorProto.INT64, [])])
    proto = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=9)
    with pytest.raises(ValueError, match="thin"):
        name_lengths(proto)


def test_six_bits_by_hand():
    # Four rows of one number: 33, 31, 30 and 45 after adding 32; 45 = 2 * 16 + 3 * 4 + 1 gives its pairs of bits to the three bytes.
    packed = pack_six_bits(np.array([[1], [-1], [-2], [13]], np.int8))
    assert packed.tolist() == [[[33 * 4 + 2]], [[31 * 4 + 3]], [[30 * 4 + 1]]]


@pytest.mark.parametrize("rows", [8, 10, 13])
def test_six_bits_come_back(rows):
    numbers = np.random.default_rng(rows).integers(-31, 32, (rows, 5)).astype(np.int8)
    nodes, constants = unpack_six_bits("w", "packed", numbers.shape)
    constants += [*six_bit_constants(), numpy_helper.from_array(pack_six_bits(numbers), "packed")]
    made = helper.make_tensor_value_info("w", TensorProto.FLOAT, numbers.shape)
    graph = helper.make_graph(nodes, "unpack", [], [made], constants)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=8)
    session = onnxruntime.InferenceSession(model.SerializeToString(), providers=["CPUExecutionProvider"])
    assert np.array_equal(session.run(None, {})[0], numbers)


def test_quantise_is_within_half_a_step():
    weight = np.random.default_rng(0).standard_normal((40, 30)).astype(np.float32)
    numbers, scale = quantise(weight, 1)
    assert numbers.dtype == np.int8 and scale.shape == (1, 30)
    error = np.abs(numbers * scale - weight)
    clipped = np.abs(numbers) == 127
    assert (error[~clipped] <= np.broadcast_to(scale / 2 + 1e-6, error.shape)[~clipped]).all()


@pytest.mark.parametrize("name, make", [(n, getattr(golden, f)) for n, f in golden.SECTIONS.items()])
def test_golden_files_are_what_the_code_says(name, make):
    stored = json.loads((TESTS / f"{name}.json").read_text())
    _same(stored, make(), 1e-6, name)


def _same(stored, fresh, tolerance: float, where: str) -> None:
    assert type(stored) is type(fresh) or isinstance(stored, (int, float)), where
    if isinstance(stored, dict):
        assert stored.keys() == fresh.keys(), where
        for key in stored:
            _same(stored[key], fresh[key], tolerance, f"{where}.{key}")
    elif isinstance(stored, list):
        assert len(stored) == len(fresh), where
        for i, pair in enumerate(zip(stored, fresh)):
            _same(*pair, tolerance, f"{where}[{i}]")
    elif isinstance(stored, float):
        assert stored == pytest.approx(fresh, rel=tolerance, abs=tolerance), where
    else:
        assert stored == fresh, where


def read_arrays(folder: Path, stem: str) -> dict[str, torch.Tensor]:
    header = json.loads((folder / f"{stem}.json").read_text())
    assert header["specHash"] == spec_hash()
    data = np.fromfile(folder / f"{stem}.bin", "<f4")
    return {
        name: torch.from_numpy(data[a["offset"] : a["offset"] + int(np.prod(a["shape"]))].reshape(a["shape"]).copy())
        for name, a in header["arrays"].items()
    }


@pytest.mark.parametrize("folder, stem, file", [(TESTS, "tiny", "tiny.onnx"), (MODELS, "golden", "light.onnx")])
def test_committed_models_give_their_golden_window(folder, stem, file):
    arrays = read_arrays(folder, stem)
    output = run_onnx((folder / file).read_bytes(), arrays, 2)
    assert np.abs(output - arrays[OUTPUT_NAME].numpy()).max() <= 1e-4
    metadata = {entry.key: entry.value for entry in onnx.load(folder / file).metadata_props}
    assert metadata["specHash"] == spec_hash()


def test_tiny_model_file_is_the_code_s():
    arrays = read_arrays(TESTS, "tiny")
    expected = torch_output(golden.tiny_model(), arrays)
    assert np.abs(expected - arrays[OUTPUT_NAME].numpy()).max() <= 5e-3  # its weights are stored in half precision


def test_manifest_describes_the_shipped_file():
    import hashlib

    manifest = json.loads((MODELS / "manifest.json").read_text())
    data = (MODELS / manifest["file"]).read_bytes()
    assert manifest["bytes"] == len(data) and manifest["sha256"] == hashlib.sha256(data).hexdigest()
    assert manifest["specHash"] == spec_hash()
