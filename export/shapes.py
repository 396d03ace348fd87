"""Names for the lengths inside an ONNX graph.

onnxruntime plans which tensors share memory when it makes a session. Tensors whose lengths it cannot tell match nothing, so they pile up
and the plan takes time in the square of their number: most of the time that a session took. Here each length is measured on a few
inputs; lengths that go together on all of them get one name.
"""

from __future__ import annotations

import numpy as np
import onnx
import onnxruntime
from onnx import helper

from samples import synthetic_inputs

# Where lengths come out of values or out of several inputs: onnxruntime works out the rest of the graph from these.
SOURCES = frozenset({"Concat", "ConstantOfShape", "Expand", "Gather", "Range", "Reshape", "Slice", "Where"})
# Batch, seed and music frames: short and long, odd and even, in every order of size.
SIZES = ((1, 60, 240), (2, 15, 97), (3, 33, 50), (2, 61, 400), (1, 17, 8))


def measure_shapes(proto: onnx.ModelProto, sizes: tuple[tuple[int, int, int], ...] = SIZES) -> dict[str, tuple[np.dtype, list[tuple[int, ...]]]]:
    """Type and shapes of every tensor that a node of `proto` gives, one shape for each of `sizes`."""
    graph = onnx.ModelProto()
    graph.CopyFrom(proto)
    del graph.graph.value_info[:]
    given = {output.name for output in graph.graph.output}
    names = [name for node in proto.graph.node for name in node.output if name and name not in given]
    graph.graph.output.extend(onnx.ValueInfoProto(name=name) for name in names)
    options = onnxruntime.SessionOptions()
    options.graph_optimization_level = onnxruntime.GraphOptimizationLevel.ORT_DISABLE_ALL
    options.log_severity_level = 3
    options.enable_mem_reuse = False
    session = onnxruntime.InferenceSession(graph.SerializeToString(), options, providers=["CPUExecutionProvider"])
    found: dict[str, tuple[np.dtype, list[tuple[int, ...]]]] = {}
    for batch, seed, frames in sizes:
        made = synthetic_inputs(batch, seed, frames, 0)
        values = session.run(names, {value.name: made[value.name].numpy() for value in session.get_inputs()})
        for name, value in zip(names, values):
            found.setdefault(name, (value.dtype, []))[1].append(value.shape)
    return found


def name_lengths(proto: onnx.ModelProto, sizes: tuple[tuple[int, int, int], ...] = SIZES) -> None:
    """Writes the shapes of tensors of varying length into `proto`, as far as onnxruntime cannot find them. Raises ValueError when a tensor changes its number of axes."""
    known = {tuple(lengths): letter for letter, lengths in zip("BST", zip(*sizes))}
    sources = {name for node in proto.graph.node if node.op_type in SOURCES for name in node.output}
    del proto.graph.value_info[:]
    for name, (dtype, shapes) in measure_shapes(proto, sizes).items():
        if len({len(shape) for shape in shapes}) > 1:
            raise ValueError(f"{name} has {shapes}: its number of axes is not fixed")
        lengths = [tuple(shape[axis] for shape in shapes) for axis in range(len(shapes[0]))]
        if name not in sources or all(len(set(each)) == 1 for each in lengths):
            continue
        dims = [each[0] if len(set(each)) == 1 else known.setdefault(each, f"L{len(known)}") for each in lengths]
        proto.graph.value_info.append(helper.make_tensor_value_info(name, helper.np_dtype_to_tensor_dtype(dtype), dims))
