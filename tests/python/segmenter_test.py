# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks that a network makes."""

import numpy as np
import pytest

import hullslam

onnx = pytest.importorskip("onnx")
numpy_helper = pytest.importorskip("onnx.numpy_helper")


@pytest.fixture(name="network")
def make_network(tmp_path):
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
    onnx.save(model, str(tmp_path / "red.onnx"))
    return tmp_path / "red.onnx"


def test_the_masks_of_an_image_are_found(network):
    segmenter = hullslam.Segmenter(network)
    assert segmenter.class_names == ["red"]
    image = np.full((96, 128, 3), 128, np.uint8)
    image[36:60, 36:60] = (0, 0, 255)
    masks = segmenter.segment(image)
    assert masks.classes == ["red"] and masks.scores[0] > 0.9
    ((outline,),) = masks.outlines
    assert outline.min(axis=0) == pytest.approx([35.5, 35.5])
    assert outline.max(axis=0) == pytest.approx([59.5, 59.5])
    assert len(segmenter.segment(image[:, :, 0])) == 0  # grey


def test_bad_networks_are_refused(network, tmp_path):
    with pytest.raises(hullslam.InputError, match="is a text"):
        hullslam.Segmenter(__file__)
    with pytest.raises(hullslam.InputError, match="min_score"):
        hullslam.Segmenter(network, min_score=2.0)
    with pytest.raises(hullslam.InputError, match="did you mean 'red'"):
        hullslam.Segmenter(network, classes=["rad"])
    with pytest.raises(hullslam.InputError, match="none.onnx"):
        hullslam.Segmenter(tmp_path / "none.onnx")
