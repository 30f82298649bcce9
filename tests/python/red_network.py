# SPDX-License-Identifier: GPL-3.0-or-later
"""A network that is small enough for tests."""

import numpy as np
import onnx
from onnx import numpy_helper


def write_red_network(path):
    """A network as YOLOv8-seg before its decoding, which finds what is red in cells of 32 px."""
    helper, tensor_type = onnx.helper, onnx.TensorProto.FLOAT
    nodes, weights, outputs = [], [], []

    def add(name, stride, rows):
        rows = np.array(rows, np.float32)
        weights.extend([numpy_helper.from_array(rows[:, :3].reshape(-1, 3, 1, 1), f"{name}w"),
                        numpy_helper.from_array(rows[:, 3], f"{name}b")])
        nodes.extend([helper.make_node("AveragePool", ["images"], [f"{name}m"],
                                       kernel_shape=[stride] * 2, strides=[stride] * 2),
                      helper.make_node("Conv", [f"{name}m", f"{name}w", f"{name}b"], [name],
                                       kernel_shape=[1, 1])])
        outputs.append(helper.make_tensor_value_info(
            name, tensor_type, [1, len(rows), 96 // stride, 128 // stride]))
    box = [[0, 0, 0, 30 if i % 16 == 1 else 0] for i in range(64)]  # a stride to each side
    for stride in (8, 16, 32):
        logit = [20, -10, -10, -5] if stride == 32 else [0, 0, 0, -20]
        add(f"head{stride}", stride, [*box, logit, [0, 0, 0, 1]])
    add("prototypes", 4, [[20, -10, -10, -10]])
    graph = helper.make_graph(nodes, "red", [helper.make_tensor_value_info(
        "images", tensor_type, [1, 3, 96, 128])], outputs, weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 12)], ir_version=8)
    helper.set_model_props(model, {"names": "{0: 'red'}"})
    onnx.save(model, str(path))
