"""Writes the trained model as ONNX for the browser, in four forms, and picks nothing by itself:

    python export/export_onnx.py --checkpoint export/runs/light/checkpoint.pt --form q8 --out public/models

fp32   as trained
fp16   weights stored in half precision + Cast (all arithmetic stays fp32)
q8     large matrices stored as int8 with a scale per output column + Cast x scale, the rest as fp16
q6     like q8 with 64 levels, four of them packed into three bytes; the graph unpacks them once, when the session is made
--compare prints size, output error and native speed of all forms. The output folder also gets manifest.json and a golden window
(golden.json + golden.bin) on which the app checks each backend before it trusts it.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import json
import logging
import statistics
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import torch
from onnx import TensorProto, helper, numpy_helper

from compress import SMALLEST_JOINT_QUANTISED, SMALLEST_QUANTISED, output_axis, pack_six_bits, quantise, shorten_names, six_bit_constants, unpack_six_bits
from model import INPUT_NAMES, OUTPUT_NAME, KeyPoseDancer, ModelConfig
from samples import synthetic_inputs
from shapes import name_lengths
from spec import MOTION_SIZE, MUSIC_FRAMES, SEED_FRAMES, SPEC, spec_hash

OPSET = 18
LICENCE = "MIT (code and weights); trained on data under other terms, see attribution"
ATTRIBUTION = (
    "Trained on: AIST++ Dance Motion Dataset annotations, (c) Google LLC, CC BY 4.0 (Li et al., ICCV 2021), modified; "
    "CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217); "
    "Dance with Melody (Tang, Jia, Mao, ACM Multimedia 2018), SMPL fits from an MIT-licensed repository."
)


def load_averaged(path: Path) -> KeyPoseDancer:
    """The averaged (EMA) model of a checkpoint, ready to run. Raises ValueError when it belongs to another spec."""
    state = torch.load(path, weights_only=True, map_location="cpu")
    if state["spec_hash"] != spec_hash():
        raise ValueError(f"{path} was trained for another spec.json")
    model = KeyPoseDancer(ModelConfig(**state["model_config"]))
    model.load_state_dict(state["averaged"])
    return model.eval()


def to_onnx(model: KeyPoseDancer, name: str) -> onnx.ModelProto:
    """fp32 ONNX with dynamic batch, seed and music lengths, and the contract in its metadata.

    Uses torch's TorchScript exporter: the newer one takes 80 s of CPU for the same operators.
    """
    example = synthetic_inputs(2, 24, 40, 0)
    axes = {n: {0: "B", 1: "S" if n == "seed" else "T"} for n in (*INPUT_NAMES, OUTPUT_NAME)}
    file = io.BytesIO()
    logging.getLogger("torch.onnx").setLevel(logging.ERROR)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            model.eval(),
            tuple(example[n] for n in INPUT_NAMES),
            file,
            dynamo=False,
            opset_version=OPSET,
            input_names=list(INPUT_NAMES),
            output_names=[OUTPUT_NAME],
            dynamic_axes=axes,
        )
    proto = _fold_constants(file.getvalue())
    proto.graph.output[0].type.tensor_type.shape.dim[2].dim_value = MOTION_SIZE
    name_lengths(proto)
    set_metadata(proto, name, "fp32")
    return proto


def _fold_constants(data: bytes) -> onnx.ModelProto:
    """The same graph after onnxruntime's basic rewrites, which use standard operators only."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "folded.onnx"
        options = onnxruntime.SessionOptions()
        options.graph_optimization_level = onnxruntime.GraphOptimizationLevel.ORT_ENABLE_BASIC
        options.optimized_model_filepath = str(path)
        options.log_severity_level = 3
        onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
        proto = onnx.load(path)
    # onnxruntime lists every operator set it knows; only the standard one is in use.
    del proto.opset_import[:]
    proto.opset_import.append(helper.make_opsetid("", OPSET))
    return proto


def set_metadata(proto: onnx.ModelProto, name: str, precision: str) -> None:
    """Writes what the app reads before it trusts the file."""
    del proto.metadata_props[:]
    entries = {"name": name, "specHash": spec_hash(), "precision": precision, "licence": LICENCE, "attribution": ATTRIBUTION}
    for key, value in entries.items():
        proto.metadata_props.add(key=key, value=value)
    # Exporter notes (stack traces with local paths) are of no use to anybody and make half the size of a small model.
    for node in proto.graph.node:
        node.doc_string = ""
        del node.metadata_props[:]
    for info in (*proto.graph.value_info, *proto.graph.input, *proto.graph.output, *proto.graph.initializer):
        info.doc_string = ""
        del info.metadata_props[:]
    del proto.graph.metadata_props[:]
    proto.graph.doc_string = proto.doc_string = ""
    proto.producer_name = "posebeat"


def compress(proto: onnx.ModelProto, form: str, name: str) -> onnx.ModelProto:
    """A copy with weights stored as `fp16`, `q8` or `q6`; arithmetic stays fp32, so every backend can run it."""
    small = onnx.ModelProto()
    small.CopyFrom(proto)
    kept, unpack = six_bit_constants() if form == "q6" else [], []
    for tensor in proto.graph.initializer:
        values = numpy_helper.to_array(tensor)
        if tensor.data_type != TensorProto.FLOAT or values.size < 64:
            kept.append(tensor)
            continue
        axis = output_axis(proto, tensor.name)
        stored = tensor.name + "_stored"
        if form in ("q8", "q6") and axis == 1 and values.ndim == 3 and values.size >= SMALLEST_JOINT_QUANTISED:
            # One matrix for each joint: a scale for each joint and output.
            rows = values.transpose(0, 2, 1).reshape(-1, values.shape[1])
            numbers, scale = quantise(rows, 0)
            numbers = np.ascontiguousarray(numbers.reshape(values.shape[0], values.shape[2], values.shape[1]).transpose(0, 2, 1))
            kept.append(numpy_helper.from_array(scale.astype(np.float16).reshape(values.shape[0], 1, -1), tensor.name + "_scale_stored"))
            kept.append(numpy_helper.from_array(numbers, stored))
            unpack.append(helper.make_node("Cast", [tensor.name + "_scale_stored"], [tensor.name + "_scale"], to=TensorProto.FLOAT))
            unpack.append(helper.make_node("Cast", [stored], [tensor.name + "_float"], to=TensorProto.FLOAT))
            unpack.append(helper.make_node("Mul", [tensor.name + "_float", tensor.name + "_scale"], [tensor.name]))
            continue
        if form in ("q8", "q6") and axis is not None and values.ndim == 2 and values.size >= SMALLEST_QUANTISED:
            six = form == "q6"
            numbers, scale = quantise(values, axis, 31 if six else 127)
            kept.append(numpy_helper.from_array(scale.astype(np.float16), tensor.name + "_scale_stored"))
            unpack.append(helper.make_node("Cast", [tensor.name + "_scale_stored"], [tensor.name + "_scale"], to=TensorProto.FLOAT))
            if six:
                kept.append(numpy_helper.from_array(pack_six_bits(numbers), stored))
                nodes, constants = unpack_six_bits(tensor.name + "_float", stored, values.shape)
                unpack += nodes
                kept += constants
            else:
                kept.append(numpy_helper.from_array(numbers, stored))
                unpack.append(helper.make_node("Cast", [stored], [tensor.name + "_float"], to=TensorProto.FLOAT))
            unpack.append(helper.make_node("Mul", [tensor.name + "_float", tensor.name + "_scale"], [tensor.name]))
        else:
            kept.append(numpy_helper.from_array(values.astype(np.float16), stored))
            unpack.append(helper.make_node("Cast", [stored], [tensor.name], to=TensorProto.FLOAT))
    del small.graph.initializer[:]
    small.graph.initializer.extend(kept)
    nodes = unpack + list(proto.graph.node)
    del small.graph.node[:]
    small.graph.node.extend(nodes)
    shorten_names(small)
    set_metadata(small, name, form)
    onnx.checker.check_model(small)
    return small


def run_onnx(proto: onnx.ModelProto | bytes, inputs: dict[str, torch.Tensor], threads: int = 1) -> np.ndarray:
    """Output [B, T, 147] of onnxruntime on the CPU."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.log_severity_level = 3
    data = proto if isinstance(proto, bytes) else proto.SerializeToString()
    session = onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
    return session.run([OUTPUT_NAME], {name: inputs[name].numpy() for name in INPUT_NAMES})[0]


def window_milliseconds(data: bytes, inputs: dict[str, torch.Tensor], runs: int = 9) -> tuple[float, float]:
    """CPU milliseconds of one thread: to make a session, and median of a window (the first two are not counted)."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.log_severity_level = 1, 3
    started = time.process_time()
    session = onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
    load = time.process_time() - started
    feed = {name: inputs[name].numpy() for name in INPUT_NAMES}
    times = []
    for _ in range(runs + 2):
        started = time.process_time()
        session.run([OUTPUT_NAME], feed)
        times.append(time.process_time() - started)
    return load * 1000, statistics.median(times[2:]) * 1000


def write_golden(folder: Path, model: KeyPoseDancer, shipped: bytes, seed_frames: int = 60, frames: int = 120) -> float:
    """One window: golden.json (shapes, offsets in floats) + golden.bin (float32, little-endian). Returns max |shipped - fp32 torch|."""
    inputs = synthetic_inputs(1, seed_frames, frames, 7)
    with torch.no_grad():
        reference = model(*(inputs[name] for name in INPUT_NAMES)).numpy()
    output = run_onnx(shipped, inputs)
    arrays = {name: inputs[name].numpy() for name in INPUT_NAMES}
    arrays |= {OUTPUT_NAME: output, f"{OUTPUT_NAME}_torch": reference}
    write_arrays(folder, "golden", arrays, {"note": "motion: onnxruntime CPU on the shipped file; motion_torch: fp32 torch"})
    return float(np.abs(output - reference).max())


def write_arrays(folder: Path, stem: str, arrays: dict[str, np.ndarray], extra: dict) -> None:
    """Float32 arrays end to end in STEM.bin, their shapes and offsets (in floats) in STEM.json."""
    table, offset = {}, 0
    for name, array in arrays.items():
        table[name] = {"shape": list(array.shape), "offset": offset}
        offset += array.size
    data = np.concatenate([array.astype("<f4").ravel() for array in arrays.values()])
    (folder / f"{stem}.bin").write_bytes(data.tobytes())
    header = {"specHash": spec_hash(), "arrays": table, **extra}
    (folder / f"{stem}.json").write_text(json.dumps(header, indent=1) + "\n", encoding="utf-8")


def write_manifest(folder: Path, name: str, precision: str, data: bytes, steps: int) -> None:
    manifest = {
        "name": name,
        "file": f"{name}.onnx",
        "bytes": len(data),
        "sha256": hashlib.sha256(data).hexdigest(),
        "specHash": spec_hash(),
        "precision": precision,
        "trainingSteps": steps,
        "windows": {"seedFrames": SEED_FRAMES, "musicFrames": MUSIC_FRAMES, "overlapFrames": SPEC["model"]["overlapFrames"]},
        "inputs": {
            "music": ["B", "T", 15],
            "seed": ["B", "S", 147],
            "key_poses": ["B", "T", 144],
            "key_mask": ["B", "T"],
            "to_previous": ["B", "T"],
            "to_next": ["B", "T"],
        },
        "outputs": {"motion": ["B", "T", 147]},
        "maxFrames": SPEC["model"]["maxFrames"],
        "rotations": "The 6D numbers of the output are orthonormal already.",
        "licence": LICENCE,
        "attribution": ATTRIBUTION,
    }
    (folder / "manifest.json").write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--checkpoint", required=True)
    parser.add_argument("--name", default="light")
    parser.add_argument("--form", choices=["fp32", "fp16", "q8", "q6"], default="q8")
    parser.add_argument("--out", required=True, help="folder for NAME.onnx, manifest.json, golden.json and golden.bin")
    parser.add_argument("--compare", action="store_true", help="print size, error and speed of every form")
    args = parser.parse_args()
    model = load_averaged(Path(args.checkpoint))
    steps = torch.load(args.checkpoint, weights_only=True, map_location="cpu")["step"]
    full = to_onnx(model, args.name)
    forms = {"fp32": full}
    for form in ("fp16", "q8", "q6"):
        if args.compare or args.form == form:
            forms[form] = compress(full, form, args.name)
    inputs = synthetic_inputs(1, SEED_FRAMES, MUSIC_FRAMES, 3)
    with torch.no_grad():
        reference = model(*(inputs[name] for name in INPUT_NAMES)).numpy()
    for form, proto in forms.items():
        data = proto.SerializeToString()
        print(f"{form}: {len(data) / 1e6:.2f} MB, max |output - torch fp32| {np.abs(run_onnx(data, inputs) - reference).max():.2e}", end="")
        load, window = window_milliseconds(data, inputs) if args.compare else (0, 0)
        print(f", session {load:.0f} ms, window {window:.0f} ms" if args.compare else "")
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    data = forms[args.form].SerializeToString()
    (out / f"{args.name}.onnx").write_bytes(data)
    write_manifest(out, args.name, args.form, data, steps)
    print(f"golden window: max |shipped - torch fp32| {write_golden(out, model, data):.2e}")


if __name__ == "__main__":
    main()
