#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prepares a network for `hullslam segment`: YOLOv8-seg, YOLO11-seg or YOLOv5-seg, as Ultralytics
exports it to ONNX.

    scripts/prepare_network.py yolov8n-seg.onnx network.onnx

The exporter adds layers that decode boxes. OpenCV 4.6 (Debian 12) loads them but cannot run them, so
the network is cut before them; HullSLAM decodes the boxes itself. A network that OpenCV runs as it is
stays whole. Half precision becomes single precision, weights in files of their own are joined to the
network, and a batch becomes one image. OUT is only written if OpenCV runs it.

Exit codes: 0 done, 1 failed, 2 bad usage or input.
"""

import os
import pathlib
import sys

from support import exit_code, InputError, one_line, parser_of, reachable, require, write

STRIDES = (8, 16, 32)  # px of the input per cell of a map that YOLO decodes
DEFAULT_SIZE = 640  # px, where the file leaves the size of the input open


# ---- reading


def load(path):
    import warnings
    import google.protobuf.message
    import onnx
    from onnx import external_data_helper
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of bytes behind the first message; the error follows
            model = onnx.load(str(path), load_external_data=False)
    except (google.protobuf.message.DecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: is no network in ONNX: {one_line(error)}") from error
    if not model.graph.node or not model.graph.output:
        raise InputError(f"{path}: is no network in ONNX, or is empty")
    for tensor in model.graph.initializer:
        for entry in tensor.external_data:
            if entry.key == "location" and not (path.parent / entry.value).is_file():
                raise InputError(f"{path}: the file {path.parent / entry.value} with its weights is "
                                 "missing, expected it beside the network")
    external_data_helper.load_external_data_for_model(model, str(path.parent))
    return model


def input_of(path, model):
    """The input of the network: 1x3xHxW."""
    weights = {tensor.name for tensor in model.graph.initializer}
    inputs = [value for value in model.graph.input if value.name not in weights]
    if len(inputs) != 1 or len(inputs[0].type.tensor_type.shape.dim) != 4:
        raise InputError(f"{path}: has {len(inputs)} inputs ({', '.join(v.name for v in inputs)}), "
                         "expected one of 1x3xHxW, an image")
    return inputs[0]


def use_single_precision(model):
    """Turns all half precision into single precision."""
    import numpy as np
    import onnx
    from onnx import TensorProto, numpy_helper

    def widen(tensor):
        if tensor.data_type == TensorProto.FLOAT16:
            array = numpy_helper.to_array(tensor).astype(np.float32)
            tensor.CopyFrom(numpy_helper.from_array(array, tensor.name))
    for tensor in model.graph.initializer:
        widen(tensor)
    for node in model.graph.node:
        for attribute in node.attribute:
            if attribute.type == onnx.AttributeProto.TENSOR:
                widen(attribute.t)
            elif node.op_type == "Cast" and attribute.i == TensorProto.FLOAT16:
                attribute.i = TensorProto.FLOAT
    for value in [*model.graph.input, *model.graph.output, *model.graph.value_info]:
        if value.type.tensor_type.elem_type == TensorProto.FLOAT16:
            value.type.tensor_type.elem_type = TensorProto.FLOAT


# ---- the graph


class Graph:
    """Who makes and who uses each tensor, and the shapes for an input of a known size."""

    def __init__(self, model, image):
        import onnx
        from onnx import shape_inference
        copy = onnx.ModelProto()
        copy.CopyFrom(model)
        for axis, dimension in enumerate(next(value for value in copy.graph.input
                                              if value.name == image.name)
                                         .type.tensor_type.shape.dim):
            if dimension.dim_value <= 0:
                dimension.dim_value = (1, 3, DEFAULT_SIZE, DEFAULT_SIZE)[axis]
        del copy.graph.value_info[:]  # these shapes are those of the exporter's size
        for value in copy.graph.output:
            value.type.tensor_type.ClearField("shape")
        shaped = shape_inference.infer_shapes(copy, data_prop=True).graph
        self.shapes = {value.name: [d.dim_value for d in value.type.tensor_type.shape.dim]
                       for value in [*shaped.input, *shaped.value_info, *shaped.output]}
        self.maker = {name: node for node in model.graph.node for name in node.output}
        self.users = {}
        for node in model.graph.node:
            for name in node.input:
                self.users.setdefault(name, []).append(node)
        self.size = self.shapes[image.name][2:]

    def stride(self, name):
        """The stride of a tensor that is a map of cells; None if it is none."""
        shape = self.shapes.get(name, [])
        return next((stride for stride in STRIDES
                     if len(shape) == 4 and [side * stride for side in shape[2:]] == self.size), None)

    def inputs(self, name):
        """The tensors that a tensor is made from."""
        return self.maker[name].input if name in self.maker else []

    def maps_before(self, name):
        """The last maps of cells on all ways to a tensor: what the decoding begins with."""
        before = reachable([name], lambda tensor: [] if self.stride(tensor) else self.inputs(tensor))
        return [tensor for tensor in before if tensor in self.maker and self.stride(tensor)]

    def part(self, name):
        """The place of a map in a cell: first the sides of the box, whose distribution goes through a
        softmax, then the classes, whose scores go through a sigmoid, then the coefficients."""
        after = reachable([name], lambda tensor: [output for node in self.users.get(tensor, [])
                                                  for output in node.output])
        kinds = {node.op_type for tensor in after for node in self.users.get(tensor, [])}
        return 0 if "Softmax" in kinds else 1 if "Sigmoid" in kinds else 2


def cut(path, model, image):
    """Makes the maps before the decoding the outputs, together with the prototypes of the masks."""
    from onnx import TensorProto, helper
    graph = Graph(model, image)
    prototypes = [value for value in model.graph.output
                  if len(graph.shapes.get(value.name, [])) == 4 and not graph.stride(value.name)]
    decoded = [value.name for value in model.graph.output if value not in prototypes]
    maps = list(dict.fromkeys(name for output in decoded for name in graph.maps_before(output)))
    heads = []
    for stride in STRIDES:
        parts = sorted((name for name in maps if graph.stride(name) == stride), key=graph.part)
        if not parts:
            shapes = ", ".join(f"{value.name} {graph.shapes.get(value.name)}" for value in model.graph.output)
            raise InputError(f"{path}: no map of cells of {stride} px leads to the outputs ({shapes}), "
                             "expected YOLOv8-seg, YOLO11-seg or YOLOv5-seg, exported with dynamic=False")
        if len({graph.part(name) for name in parts}) < len(parts):
            raise InputError(f"{path}: the maps {', '.join(parts)} have the same meaning, expected one "
                             "each for boxes, classes and coefficients")
        name = parts[0]
        if len(parts) > 1:
            name = f"head{len(heads)}"
            model.graph.node.append(helper.make_node("Concat", parts, [name], axis=1))
            graph.maker[name] = model.graph.node[-1]
            graph.shapes[name] = graph.shapes[parts[0]][:]
            graph.shapes[name][1] = sum(graph.shapes[part][1] for part in parts)
        heads.append(helper.make_tensor_value_info(name, TensorProto.FLOAT, graph.shapes[name]))
    outputs = [*heads, *prototypes]
    needed = set(reachable([value.name for value in outputs], graph.inputs))
    model.graph.CopyFrom(helper.make_graph(
        [node for node in model.graph.node if needed & set(node.output)], model.graph.name,
        model.graph.input, outputs, [tensor for tensor in model.graph.initializer if tensor.name in needed]))


# ---- the result


def fault_of(model, image):
    """Why OpenCV cannot run a network; None if it can."""
    import cv2
    import numpy as np
    height, width = (dimension.dim_value if dimension.dim_value > 0 else DEFAULT_SIZE
                     for dimension in image.type.tensor_type.shape.dim[2:])
    try:
        network = cv2.dnn.readNetFromONNX(np.frombuffer(model.SerializeToString(), np.uint8))
        network.setInput(np.full((1, 3, height, width), 114 / 255, np.float32))
        outputs = network.forward(network.getUnconnectedOutLayersNames())
    except cv2.error as error:
        return one_line(error)
    wrong = [output for output in outputs if not np.isfinite(output).all()]
    return "its outputs are not finite" if wrong else None


def prepare(arguments):
    path = arguments.input
    if not path.is_file():
        raise InputError(f"{path}: does not exist, expected a network in ONNX")
    model = load(path)
    image = input_of(path, model)
    image.type.tensor_type.shape.dim[0].dim_value = 1
    use_single_precision(model)
    is_whole = fault_of(model, image) is None
    if not is_whole:
        cut(path, model, image)
        fault = fault_of(model, image)
        if fault:
            raise InputError(f"{path}: OpenCV cannot run it, even without its decoding: {fault}")
    write(arguments.output, model.SerializeToString())
    print(f"{arguments.output}: {'the whole network' if is_whole else 'the network before its decoding'}, "
          f"outputs {', '.join(value.name for value in model.graph.output)}")


def main(words=None):
    os.environ.setdefault("OPENCV_LOG_LEVEL", "SILENT")  # it also prints its exceptions
    parser = parser_of(__doc__)
    parser.add_argument("input", type=pathlib.Path, metavar="IN.onnx")
    parser.add_argument("output", type=pathlib.Path, metavar="OUT.onnx")
    arguments = parser.parse_args(words)
    require("onnx", "cv2", "numpy")
    return exit_code(prepare, arguments)


if __name__ == "__main__":
    sys.exit(main())
