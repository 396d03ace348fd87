"""Storing weights in fewer bits inside an ONNX graph: quantisation, six-bit packing, short names."""

from __future__ import annotations

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

# Matrices below this many numbers (embeddings of positions, biases, norms) gain nothing from 8 bits.
SMALLEST_QUANTISED = 20_000
# Of matrices that come one for each joint there are many, and all are small.
SMALLEST_JOINT_QUANTISED = 2_000


def output_axis(proto: onnx.ModelProto, name: str) -> int | None:
    """Which axis of a weight matrix runs over outputs; None when it is not the weight of a product."""
    for node in proto.graph.node:
        if name in node.input:
            if node.op_type == "MatMul" and node.input[1] == name:
                return 1
            if node.op_type == "Gemm" and node.input[1] == name:
                return 0 if any(a.name == "transB" and a.i for a in node.attribute) else 1
            return None
    return None


def quantise(weight: np.ndarray, axis: int, levels: int = 127) -> tuple[np.ndarray, np.ndarray]:
    """Whole numbers in -levels..levels and fp32 scales (one per output) with the clipping that loses least in the squares."""
    other = 1 - axis
    peak = np.maximum(np.abs(weight).max(axis=other, keepdims=True), 1e-12)
    best_scale, best_error = peak / levels, None
    for clip in (1.0, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65, 0.6):
        scale = peak * clip / levels
        error = ((np.clip(np.round(weight / scale), -levels, levels) * scale - weight) ** 2).sum(axis=other, keepdims=True)
        if best_error is None:
            best_error = error
        else:
            better = error < best_error
            best_scale, best_error = np.where(better, scale, best_scale), np.where(better, error, best_error)
    return np.clip(np.round(weight / best_scale), -levels, levels).astype(np.int8), best_scale.astype(np.float32)


def pack_six_bits(numbers: np.ndarray) -> np.ndarray:
    """Whole numbers in -31..31 [rows, columns] -> bytes [3, rows / 4 rounded up, columns].

    Row group g of the four quarters of the matrix makes three bytes: each byte has one number in its upper six bits and two
    bits of the fourth number in its lower two. Missing rows are zero.
    """
    numbers = np.pad(numbers, ((0, -len(numbers) % 4), (0, 0)))
    first, second, third, fourth = (numbers + 32).astype(np.uint8).reshape(4, -1, numbers.shape[1])
    return np.stack([first << 2 | fourth >> 4, second << 2 | fourth >> 2 & 3, third << 2 | fourth & 3])


# Constants that all unpacking shares.
_SIX_BIT_CONSTANTS = {
    "six_quarter": np.float32(0.25),
    "six_four": np.float32(4),
    "six_middle": np.float32(32),
    "six_places": np.array([16, 4, 1], np.float32).reshape(3, 1, 1),
    "six_axis": np.array([0], np.int64),
}


def six_bit_constants() -> list[TensorProto]:
    """What every graph that unpacks six bits must hold once."""
    return [numpy_helper.from_array(value, name) for name, value in _SIX_BIT_CONSTANTS.items()]


def unpack_six_bits(name: str, packed: str, shape: tuple[int, int]) -> tuple[list, list]:
    """Nodes and constants that turn packed bytes back into numbers [rows, columns] called `name`; plain arithmetic only."""
    constants = [
        numpy_helper.from_array(np.array([-1, shape[1]], np.int64), name + "_shape"),
        numpy_helper.from_array(np.array([shape[0]], np.int64), name + "_end"),
    ]
    node = helper.make_node
    nodes = [
        node("Cast", [packed], [name + "_bytes"], to=TensorProto.FLOAT),
        node("Mul", [name + "_bytes", "six_quarter"], [name + "_scaled"]),
        node("Floor", [name + "_scaled"], [name + "_upper"]),  # the first three quarters
        node("Mul", [name + "_upper", "six_four"], [name + "_back"]),
        node("Sub", [name + "_bytes", name + "_back"], [name + "_lower"]),
        node("Mul", [name + "_lower", "six_places"], [name + "_parts"]),
        node("ReduceSum", [name + "_parts", "six_axis"], [name + "_fourth"], keepdims=1),
        node("Concat", [name + "_upper", name + "_fourth"], [name + "_all"], axis=0),
        node("Reshape", [name + "_all", name + "_shape"], [name + "_rows"]),
        node("Slice", [name + "_rows", "six_axis", name + "_end", "six_axis"], [name + "_real"]),
        node("Sub", [name + "_real", "six_middle"], [name]),
    ]
    return nodes, constants


def shorten_names(proto: onnx.ModelProto) -> None:
    """Renames everything inside the graph to short numbers: the exporter's long names make a quarter of a megabyte."""
    fixed = {value.name for value in (*proto.graph.input, *proto.graph.output)} | {""}
    short: dict[str, str] = {}

    def rename(name: str) -> str:
        return name if name in fixed else short.setdefault(name, f"v{len(short):x}")

    for named in (*proto.graph.initializer, *proto.graph.value_info):
        named.name = rename(named.name)
    for node in proto.graph.node:
        node.name = ""
        for names in (node.input, node.output):
            names[:] = [rename(name) for name in names]
