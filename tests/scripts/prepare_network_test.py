#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of scripts/prepare_network.py with tiny networks whose ends are those of YOLO's exports."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

import cv2
import numpy as np

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
import prepare_network  # noqa: E402

try:
    import onnx
    from onnx import TensorProto, helper, numpy_helper
except ImportError:
    onnx = None

HEIGHT, WIDTH = 96, 128
CLASSES, COEFFICIENTS = 3, 4
CHANNELS = {"box": 64, "class": CLASSES, "mask": COEFFICIENTS}
CELLS = sum((HEIGHT // s) * (WIDTH // s) for s in (8, 16, 32))


class Maker:
    """Makes a network node by node."""

    def __init__(self):
        self.nodes, self.weights = [], []

    def weight(self, array):
        name = f"w{len(self.weights)}"
        self.weights.append(numpy_helper.from_array(np.asarray(array), name))
        return name

    def add(self, kind, inputs, count=1, **attributes):
        names = [f"t{len(self.nodes)}_{i}" for i in range(count)]
        self.nodes.append(helper.make_node(kind, inputs, names, **attributes))
        return names[0] if count == 1 else names

    def conv(self, source, channels, of, constant, stride=1):
        weights = np.zeros((channels, of, stride, stride), np.float32)
        return self.add("Conv", [source, self.weight(weights),
                                 self.weight(np.full(channels, constant).astype(np.float32))],
                        kernel_shape=[stride, stride], strides=[stride, stride])

    def reshape(self, source, shape):
        return self.add("Reshape", [source, self.weight(np.array(shape, np.int64))])


def decode(maker, boxes, classes):
    """The decoding of the exporter: the mean of each distribution, boxes around the cells, scores."""
    spread = maker.reshape(boxes, [1, 4, 16, CELLS])
    weights = maker.add("Softmax", [maker.add("Transpose", [spread], perm=[0, 2, 1, 3])], axis=1)
    mean = maker.add("Conv", [weights, maker.weight(np.arange(16, dtype=np.float32)
                                                    .reshape(1, 16, 1, 1))], kernel_shape=[1, 1])
    sides = maker.reshape(mean, [1, 4, CELLS])
    first, second = maker.add("Split", [sides, maker.weight(np.array([2, 2], np.int64))], 2, axis=1)
    centres = maker.weight(np.zeros((1, 2, CELLS), np.float32))
    low, high = maker.add("Sub", [centres, first]), maker.add("Add", [centres, second])
    box = maker.add("Concat", [maker.add("Add", [low, high]), maker.add("Sub", [high, low])], axis=1)
    return [maker.add("Mul", [box, maker.weight(np.full((1, 1, CELLS), 8, np.float32))]),
            maker.add("Sigmoid", [classes])]


def yolo(joins_maps, attention=False, shape=(1, 3, HEIGHT, WIDTH)):
    """A network like YOLOv8-seg. Boxes have the constant 1, classes 2, coefficients 3. In exports
    of 2023 (joins_maps) the maps of boxes and classes are joined before they are flattened. With
    attention, as in YOLO11, a part before the maps reshapes too."""
    maker = Maker()
    flat = {"box": [], "class": [], "mask": []}
    for stride in (8, 16, 32):
        trunk = maker.conv("images", 8, 3, 0.0, stride)
        if attention and stride == 32:
            side = [HEIGHT // 32, WIDTH // 32]
            trunk = maker.reshape(maker.reshape(trunk, [1, 2, 4, side[0] * side[1]]), [1, 8, *side])
        maps = {"mask": maker.conv(trunk, COEFFICIENTS, 8, 3.0), "class": maker.conv(trunk, CLASSES, 8, 2.0),
                "box": maker.conv(trunk, 64, 8, 1.0)}
        if joins_maps:
            maps["box"] = maker.add("Concat", [maps["box"], maps.pop("class")], axis=1)
        for kind, name in maps.items():
            channels = 64 + CLASSES if joins_maps and kind == "box" else CHANNELS[kind]
            flat[kind].append(maker.reshape(name, [1, channels, -1]))
    flat = {kind: maker.add("Concat", names, axis=2) for kind, names in flat.items() if names}
    boxes, classes = (maker.add("Split", [flat["box"], maker.weight(np.array([64, CLASSES], np.int64))],
                                2, axis=1) if joins_maps else (flat["box"], flat["class"]))
    maker.nodes.append(helper.make_node("Concat", [*decode(maker, boxes, classes), flat["mask"]],
                                        ["output0"], axis=1))
    maker.nodes.append(helper.make_node("Identity", [maker.conv("images", COEFFICIENTS, 3, 0.5, 4)],
                                        ["output1"]))
    return model_of(maker, {"output0": [1, 4 + CLASSES + COEFFICIENTS, CELLS],
                            "output1": [1, COEFFICIENTS, HEIGHT // 4, WIDTH // 4]}, shape)


def yolo5():
    """A network like YOLOv5-seg: three anchors in each cell, whose boxes have the constant 1 and the
    rest 2. Their decoding: boxes relative to a grid, to the power of two of a sigmoid, in rows."""
    maker, rows = Maker(), []
    columns = 5 + CLASSES + COEFFICIENTS
    for stride in (8, 16, 32):
        height, width = HEIGHT // stride, WIDTH // stride
        trunk = maker.conv("images", 8, 3, 0.0, stride)
        constant = np.tile([1.0] * 4 + [2.0] * (columns - 4), 3)
        cells = maker.reshape(maker.conv(trunk, 3 * columns, 8, constant), [1, 3, columns, height, width])
        cells = maker.add("Transpose", [cells], perm=[0, 1, 3, 4, 2])
        xy, wh, scores, mask = maker.add(
            "Split", [cells, maker.weight(np.array([2, 2, 1 + CLASSES, COEFFICIENTS], np.int64))], 4, axis=4)
        grid = np.stack(np.meshgrid(np.arange(width), np.arange(height)), -1).astype(np.float32) - 0.5
        two = maker.weight(np.array(2, np.float32))
        xy = maker.add("Add", [maker.add("Mul", [maker.add("Sigmoid", [xy]), two]),
                               maker.weight(np.tile(grid, (1, 3, 1, 1, 1)))])
        xy = maker.add("Mul", [xy, maker.weight(np.array(stride, np.float32))])
        wh = maker.add("Pow", [maker.add("Mul", [maker.add("Sigmoid", [wh]), two]), two])
        wh = maker.add("Mul", [wh, maker.weight(np.full((1, 3, height, width, 2), 10, np.float32))])
        found = maker.add("Concat", [xy, wh, maker.add("Sigmoid", [scores]), mask], axis=4)
        rows.append(maker.reshape(found, [1, 3 * height * width, columns]))
    maker.nodes.append(helper.make_node("Concat", rows, ["output0"], axis=1))
    maker.nodes.append(helper.make_node("Identity", [maker.conv("images", COEFFICIENTS, 3, 0.5, 4)],
                                        ["output1"]))
    return model_of(maker, {"output0": [1, 3 * CELLS, columns],
                            "output1": [1, COEFFICIENTS, HEIGHT // 4, WIDTH // 4]})


def model_of(maker, outputs, shape=(1, 3, HEIGHT, WIDTH)):
    value = helper.make_tensor_value_info
    graph = helper.make_graph(maker.nodes, "net", [value("images", TensorProto.FLOAT, shape)],
                              [value(name, TensorProto.FLOAT, of) for name, of in outputs.items()],
                              maker.weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], ir_version=8)
    helper.set_model_props(model, {"names": "{0: 'a', 1: 'b', 2: 'c'}"})
    return model


@unittest.skipIf(onnx is None, "python3-onnx is not installed")
class PrepareNetwork(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.source, self.target = self.folder / "in.onnx", self.folder / "out.onnx"

    def prepare(self):
        """(exit code, what is printed on stderr)"""
        with contextlib.redirect_stderr(io.StringIO()) as errors, \
                contextlib.redirect_stdout(io.StringIO()):
            code = prepare_network.main([str(self.source), str(self.target)])
        return code, errors.getvalue()

    def outputs(self):
        network = cv2.dnn.readNetFromONNX(str(self.target))
        network.setInput(np.zeros((1, 3, HEIGHT, WIDTH), np.float32))
        names = network.getUnconnectedOutLayersNames()
        return [output for _, output in sorted(zip(names, network.forward(names)),
                                               key=lambda pair: -pair[1].shape[2])]

    def expect_maps(self):
        prototypes, *maps = self.outputs()
        self.assertEqual(prototypes.shape, (1, COEFFICIENTS, HEIGHT // 4, WIDTH // 4))
        for stride, values in zip((8, 16, 32), maps):
            self.assertEqual(values.shape,
                             (1, 64 + CLASSES + COEFFICIENTS, HEIGHT // stride, WIDTH // stride))
            np.testing.assert_array_equal(
                values[0, :, 0, 0], [1.0] * 64 + [2.0] * CLASSES + [3.0] * COEFFICIENTS)

    def force_cut(self):
        """OpenCV runs these tiny networks, so it is said that it fails until they are cut."""
        real, self.calls = prepare_network.fault_of, 0

        def fail_first(model, image):
            self.calls += 1
            return "shape inference" if self.calls == 1 else real(model, image)
        prepare_network.fault_of = fail_first
        self.addCleanup(setattr, prepare_network, "fault_of", real)

    def test_cuts_all_exports_before_their_decoding(self):
        for joins_maps in (True, False):
            for attention in (True, False):
                with self.subTest(joins_maps=joins_maps, attention=attention):
                    onnx.save(yolo(joins_maps, attention), str(self.source))
                    self.force_cut()
                    self.assertEqual(self.prepare(), (0, ""))
                    self.expect_maps()
                    self.assertEqual(onnx.load(str(self.target)).metadata_props[0].key, "names")

    def test_cuts_yolo5_before_its_grid(self):
        onnx.save(yolo5(), str(self.source))
        self.force_cut()
        self.assertEqual(self.prepare(), (0, ""))
        prototypes, *maps = self.outputs()
        self.assertEqual(prototypes.shape, (1, COEFFICIENTS, HEIGHT // 4, WIDTH // 4))
        for stride, values in zip((8, 16, 32), maps):
            self.assertEqual(values.shape, (1, 3 * (5 + CLASSES + COEFFICIENTS), HEIGHT // stride, WIDTH // stride))
            np.testing.assert_array_equal(values[0, :6, 0, 0], [1.0] * 4 + [2.0] * 2)

    def test_open_sizes_and_batches_are_accepted(self):
        onnx.save(yolo(True, shape=("batch", 3, "height", "width")), str(self.source))
        self.force_cut()
        self.assertEqual(self.prepare(), (0, ""))
        self.expect_maps()

    def test_half_precision_and_weights_in_other_files_become_one_file(self):
        model = yolo(True)
        for tensor in model.graph.initializer:
            if tensor.data_type == TensorProto.FLOAT:
                tensor.CopyFrom(numpy_helper.from_array(
                    numpy_helper.to_array(tensor).astype(np.float16), tensor.name))
        for value in [*model.graph.input, *model.graph.output]:
            value.type.tensor_type.elem_type = TensorProto.FLOAT16
        onnx.save(model, str(self.source), save_as_external_data=True, location="weights.bin",
                  size_threshold=0)
        self.force_cut()
        self.assertEqual(self.prepare(), (0, ""))
        self.expect_maps()
        kinds = {tensor.data_type for tensor in onnx.load(str(self.target)).graph.initializer}
        self.assertNotIn(TensorProto.FLOAT16, kinds)
        (self.folder / "weights.bin").unlink()
        self.target.unlink()
        code, errors = self.prepare()
        self.assertEqual(code, 2)
        self.assertIn("weights.bin", errors)
        self.assertFalse(self.target.exists())

    def test_a_network_that_runs_stays_whole(self):
        maker = Maker()
        maker.nodes.append(helper.make_node("Identity", [maker.conv("images", 4, 3, 0.5, 4)], ["out"]))
        onnx.save(model_of(maker, {"out": [1, 4, HEIGHT // 4, WIDTH // 4]}), str(self.source))
        self.assertEqual(self.prepare(), (0, ""))
        self.assertEqual(len(self.outputs()), 1)

    def test_refuses_what_it_cannot_prepare(self):
        self.source.write_text("layers: 3\n")
        code, errors = self.prepare()
        self.assertEqual((code, errors.count("\n")), (2, 1))
        self.assertIn("is no network in ONNX", errors)
        maker = Maker()
        maker.nodes.append(helper.make_node("GlobalAveragePool", ["images"], ["out"]))
        onnx.save(model_of(maker, {"out": [1, 3, 1, 1]}), str(self.source))
        self.force_cut()
        code, errors = self.prepare()
        self.assertEqual(code, 2)
        self.assertIn("expected YOLOv8-seg", errors)
        self.source.unlink()
        self.assertEqual(self.prepare()[0], 2)
        self.assertFalse(self.target.exists())


if __name__ == "__main__":
    unittest.main()
