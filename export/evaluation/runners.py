"""Ways to run the network: from a checkpoint, or from the ONNX file that the page gets."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import onnxruntime
import torch
from torch import Tensor

from export_onnx import load_averaged
from model import INPUT_NAMES, OUTPUT_NAME, KeyPoseDancer, ModelConfig

Run = Callable[[dict[str, Tensor]], Tensor]
"""Model inputs with a leading batch axis -> motion [B, T, 147]."""


def load_network(checkpoint: Path) -> KeyPoseDancer:
    """The averaged weights of a checkpoint: of train.py, or of train_inbetween.py, whose in-betweener then dances without the
    transformer (an untrained one adds nothing to its base)."""
    state = torch.load(checkpoint, weights_only=True, map_location="cpu")
    if "model_config" in state:
        return load_averaged(checkpoint)
    from train_inbetween import load_inbetweener

    alone = load_inbetweener(checkpoint)
    config = ModelConfig.named("tiny")
    config.inbetween = alone.config
    model = KeyPoseDancer(config)
    model.inbetweener.load_state_dict(alone.state_dict())
    return model.eval()


def torch_runner(checkpoint: Path) -> Run:
    """Runs the averaged weights of a checkpoint."""
    model = load_network(checkpoint)

    @torch.no_grad()
    def run(inputs: dict[str, Tensor]) -> Tensor:
        return model(*(inputs[name] for name in INPUT_NAMES))

    return run


def onnx_runner(path: Path, threads: int = 1) -> Run:
    """Runs an ONNX file on onnxruntime's CPU backend."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])

    def run(inputs: dict[str, Tensor]) -> Tensor:
        return torch.from_numpy(session.run([OUTPUT_NAME], {name: inputs[name].numpy() for name in INPUT_NAMES})[0])

    return run
