"""Writes DanceFormer's two networks as ONNX for the browser, each with a manifest and a golden run:

    python export/export_danceformer.py --suggest RUN/checkpoint.pt --curves RUN/checkpoint.pt --out public/models

NAME.onnx (weights stored as `--form`), NAME.json (manifest), NAME.training.json (commands, settings and log of the run), NAME.golden.json + NAME.golden.bin (inputs and outputs of one made-up run by
onnxruntime on the shipped file). BatchNorms are folded, attention is plain products, the batch is free, everything else has fixed lengths.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import json
import logging
import warnings
from pathlib import Path

import numpy as np
import onnx
import onnxruntime
import torch
from torch import Tensor, nn

import curve_net
import suggest
from curve_net import CurveConfig, CurveNet
from dantrans import fold_norms
from export_onnx import ATTRIBUTION, LICENCE, OPSET, _fold_constants, compress, set_metadata, write_arrays
from rotation import axis_angle_to_quaternion, matrix_to_quaternion
from samples import synthetic_motion
from metrics import matrices_of
from spec import JOINT_COUNT, MOTION_SIZE, ROTATION_SIZE, spec_hash
from suggest import BEAT_SIZE, CODES, PAST_BEATS, PAST_POSES, STYLES, SuggestConfig, Suggester

TOLERANCE = 0.01  # of every output, for the golden run on any backend


def made_up_inputs(name: str, batch: int, seed: int) -> dict[str, Tensor]:
    """Inputs of `suggest` or `curves` from a seeded generator; no recorded data is in them."""
    rng = torch.Generator().manual_seed(seed)
    if name == "curves":
        motion = synthetic_motion(15 * (batch + 3), rng)[::15]
        quaternions = matrix_to_quaternion(matrices_of(motion))
        keys = torch.stack([quaternions[i : i + 4] for i in range(batch)])
        mask = torch.ones(batch, 2)
        seconds = 0.3 + 0.7 * torch.rand(batch, 3, generator=rng)
        mask[0, 0], seconds[0, 0], keys[0, 0] = 0, 0, keys[0, 1]
        return {
            "keys": keys,
            "key_mask": mask,
            "seconds": seconds,
            "music": torch.randn(batch, curve_net.STEPS, curve_net.FEATURES, generator=rng),
        }
    poses = synthetic_motion(15 * PAST_POSES, rng)[None, ::15].repeat(batch, 1, 1)
    known = torch.ones(batch, PAST_POSES)
    known[1:2, :9] = 0
    known[2:3] = 0
    ahead = synthetic_motion(batch, rng)[:, :ROTATION_SIZE]
    beats = torch.tensor([4.0, -1.0, 2.5, 1.0]).repeat(-(-batch // 4))[:batch]
    style = torch.zeros(batch, len(STYLES))
    style[0, 0] = 1
    heard = torch.ones(batch, PAST_BEATS + 1 + suggest.FUTURE_BEATS)
    heard[-1, -3:] = 0
    uniform = torch.rand(batch, CODES, generator=rng).clamp(1e-6, 1 - 1e-6)
    return {
        "poses": poses * known[..., None],
        "pose_mask": known,
        "music": torch.randn(batch, heard.shape[1], BEAT_SIZE, generator=rng) * heard[..., None],
        "music_mask": heard,
        "next_pose": ahead * (beats > 0)[:, None],
        "next_beats": beats,
        "style": style,
        "temperature": torch.full((batch,), 0.7),
        "noise": -torch.log(-torch.log(uniform)),
    }


def names_of(name: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Input and output names of a network."""
    module = {"suggest": suggest, "curves": curve_net}[name]
    return module.INPUTS, module.OUTPUTS


def to_onnx(model: nn.Module, name: str) -> onnx.ModelProto:
    """fp32 ONNX of a network whose norms are folded; the batch is free."""
    inputs, outputs = names_of(name)
    example = made_up_inputs(name, 3, 0)
    file = io.BytesIO()
    logging.getLogger("torch.onnx").setLevel(logging.ERROR)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            fold_norms(model),
            tuple(example[n] for n in inputs),
            file,
            dynamo=False,
            opset_version=OPSET,
            input_names=list(inputs),
            output_names=list(outputs),
            dynamic_axes={n: {0: "B"} for n in (*inputs, *outputs)},
        )
    proto = _fold_constants(file.getvalue())
    shapes = {"pose": [MOTION_SIZE], "code": [getattr(model.config, "parts", 1)], "curves": [99, 5], "root": [2, 3]}
    for output in proto.graph.output:
        dims = output.type.tensor_type.shape.dim
        for dim, size in zip(dims[1:], shapes[output.name]):
            dim.dim_value = size
    set_metadata(proto, name, "fp32")
    return proto


def run(data: bytes, name: str, inputs: dict[str, Tensor]) -> dict[str, np.ndarray]:
    """Outputs of onnxruntime on the CPU, by name."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads, options.log_severity_level = 1, 3
    session = onnxruntime.InferenceSession(data, options, providers=["CPUExecutionProvider"])
    given, made = names_of(name)
    return dict(zip(made, session.run(list(made), {n: inputs[n].numpy() for n in given})))


def golden_inputs(model: nn.Module, name: str) -> dict[str, Tensor]:
    """A made-up run; for `suggest` one whose choices are no near-ties, so that rounding cannot change a code."""
    if name == "curves":
        return made_up_inputs(name, 4, 7)
    best, widest = None, -1.0
    for seed in range(20):
        inputs = made_up_inputs(name, 4, seed)
        scores = []
        hook = model.logits.register_forward_hook(lambda module, args, output: scores.append(output[:, 0]))
        with torch.no_grad():
            model(*(inputs[n] for n in suggest.INPUTS))
        hook.remove()
        gap, size = float("inf"), CODES // model.config.parts
        for part, logits in enumerate(scores):
            own = slice(part * size, (part + 1) * size)
            top = (logits[:, own] / inputs["temperature"][:, None] + inputs["noise"][:, own]).topk(2).values
            gap = min(gap, float((top[:, 0] - top[:, 1]).min()))
        if gap > widest:
            best, widest = inputs, gap
    return best


def write_model(out: Path, name: str, model: nn.Module, form: str, about: dict) -> float:
    """NAME.onnx, NAME.json and the golden run into `out` -> largest difference of the shipped file to fp32 torch on it."""
    out.mkdir(parents=True, exist_ok=True)
    proto = to_onnx(model, name)
    inputs = golden_inputs(model, name)
    shipped = (proto if form == "fp32" else compress(proto, form, name)).SerializeToString()
    (out / f"{name}.onnx").write_bytes(shipped)
    made = run(shipped, name, inputs)
    given, outputs = names_of(name)
    with torch.no_grad():
        expected = dict(zip(outputs, (value.numpy() for value in model(*(inputs[n] for n in given)))))
    difference = max(float(np.abs(made[n] - expected[n]).max()) for n in outputs)
    arrays = {n: inputs[n].numpy() for n in given} | {n: made[n].astype(np.float32) for n in outputs}
    write_arrays(out, f"{name}.golden", arrays, {"tolerance": TOLERANCE})
    shape = lambda value: ["B", *value.shape[1:]]  # noqa: E731
    manifest = {
        "name": name,
        "file": f"{name}.onnx",
        "bytes": len(shipped),
        "sha256": hashlib.sha256(shipped).hexdigest(),
        "specHash": spec_hash(),
        "precision": form,
        **about,
        "inputs": {n: shape(inputs[n]) for n in given},
        "outputs": {n: shape(made[n]) for n in outputs},
        "licence": LICENCE,
        "attribution": ATTRIBUTION,
    }
    (out / f"{name}.json").write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")
    print(f"{name}: {len(shipped) / 1e6:.2f} MB as {form}, max |shipped - torch fp32| {difference:.2e}, {len(proto.graph.node)} nodes")
    return difference


def load(path: Path) -> tuple[str, nn.Module, dict]:
    """(name, averaged network ready to run, checkpoint) of a run of train_danceformer.py."""
    state = torch.load(path, weights_only=True, map_location="cpu")
    if state["spec_hash"] != spec_hash():
        raise ValueError(f"{path} was trained for another spec.json")
    name = state["stage"]
    model = Suggester(SuggestConfig(**state["config"])) if name == "suggest" else CurveNet(CurveConfig(**state["config"]))
    model.load_state_dict(state["averaged"])
    return name, model.eval(), state


def _records(run_folder: Path) -> tuple[list[dict], list[dict]]:
    """Runs and log of a training folder."""
    return tuple([json.loads(line) for line in (run_folder / file).read_text(encoding="utf-8").splitlines()] for file in ("runs.jsonl", "log.jsonl"))


def write_training(out: Path, name: str, checkpoint: Path) -> None:
    """NAME.training.json: the runs (commands, settings, data hash, commit) and the log of a checkpoint's folder. Folders of this machine
    are named by what is in them."""
    runs, log = _records(checkpoint.parent)
    # A run that started from the weights of an earlier one is only half of the story.
    while earlier := runs[0]["settings"].get("weights"):
        before = _records(Path(earlier).parent)
        runs, log = before[0] + runs, before[1] + log
    for run_ in runs:
        words = run_["command"].split()
        for flag, word in (("--data", "DATA"), ("--features", "FEATURES15"), ("--song-features", "FEATURES53"), ("--out", None)):
            if flag in words:
                place = words.index(flag) + 1
                words[place] = word or f"export/runs/{Path(words[place]).name}"
        words[1] = "export/train_danceformer.py"
        run_["command"] = " ".join(words)
        run_["settings"]["song_features"] = "FEATURES53"
    (out / f"{name}.training.json").write_text(json.dumps({"runs": runs, "log": log}, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suggest", type=Path, help="checkpoint of stage 1")
    parser.add_argument("--curves", type=Path, help="checkpoint of stage 2")
    parser.add_argument("--form", choices=["fp32", "fp16", "q8", "q6"], default="q8")
    parser.add_argument("--out", type=Path, required=True)
    args = parser.parse_args()
    torch.set_num_threads(1)
    for path in filter(None, (args.suggest, args.curves)):
        name, model, state = load(path)
        write_model(args.out, name, model, args.form, {"trainingSteps": state["step"]})
        write_training(args.out, name, path)


if __name__ == "__main__":
    main()
