"""Ways to run the network: from a checkpoint, or from the ONNX file that the page gets."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import onnxruntime
import torch
from torch import Tensor

from export_onnx import load_averaged
from model import INPUT_NAMES, OUTPUT_NAME

Run = Callable[[dict[str, Tensor]], Tensor]
"""Model inputs with a leading batch axis -> motion [B, T, 147]."""


def torch_runner(checkpoint: Path) -> Run:
    """Runs the averaged weights of a checkpoint."""
    model = load_averaged(checkpoint)

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
