// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "segmentation/onnx_file.h"
#include "support/expect_error.h"
#include "support/made_network.h"

namespace hullslam {
namespace {

using Attributes = std::map<std::string, std::vector<int64_t>>;

ProtobufMessage Weights(const std::string& name, const std::vector<int>& shape) {
  ProtobufMessage tensor;
  size_t count = 1;
  for (const int side : shape) {
    tensor.Number(1, static_cast<uint64_t>(side));
    count *= static_cast<size_t>(side);
  }
  return tensor.Number(2, 1).Text(8, name).Text(9, std::string(4 * count, 'x'));
}

// A node; an attribute of one integer is no list.
ProtobufMessage Node(const std::string& kind, const Attributes& attributes,
                     const std::vector<std::string>& inputs = {"images", "w", "b"}) {
  ProtobufMessage node;
  for (const std::string& input : inputs) {
    node.Text(1, input);
  }
  node.Text(3, "odd").Text(4, kind);
  for (const auto& [name, values] : attributes) {
    ProtobufMessage attribute;
    attribute.Text(1, name);
    for (const int64_t value : values) {
      attribute.Number(values.size() == 1 ? 3 : 8, static_cast<uint64_t>(value));
    }
    node.Message(5, attribute);
  }
  return node;
}

// A graph with a convolution from 4 to 6 channels.
ProtobufMessage Graph(const ProtobufMessage& node) {
  return ProtobufMessage()
      .Message(1, node)
      .Message(5, Weights("w", {6, 4, 3, 3}))
      .Message(5, Weights("b", {6}));
}

void Check(const ProtobufMessage& graph) {
  std::set<std::string> files;
  CheckGraph(graph.bytes(), files);
  EXPECT_TRUE(files.empty());
}

TEST(OnnxGraph, NodesAsTheyShouldBeAreAccepted) {
  for (const ProtobufMessage& node :
       {Node("Conv", {{"group", {1}},
                      {"kernel_shape", {3, 3}},
                      {"strides", {2, 2}},
                      {"dilations", {1, 1}},
                      {"pads", {1, 1, 0, 0}}}),
        Node("Conv", {}), Node("Conv", {}, {"images", "w"}), Node("Conv", {}, {"images"}),
        Node("Conv", {{"group", {3}}}), Node("Gather", {{"axis", {-1}}}),
        Node("Pad", {{"pads", {0, 0, -1, -1, 0, 0, -1, -1}}}),
        Node("Transpose", {{"perm", {0, 2, 3, 1}}}), Node("Unknown", {{"anything", {1 << 30}}})}) {
    Check(Graph(node));
  }
}

TEST(OnnxGraph, AttributesOutOfRangeAreRefused) {
  for (const auto& [kind, attributes, part] :
       std::vector<std::tuple<std::string, Attributes, std::string>>{
           {"Conv", {{"group", {0}}}, "group is 0"},
           {"Conv", {{"group", {-1}}}, "group is -1"},
           {"Conv", {{"group", {4}}}, "a divisor of 6"},
           {"Conv", {{"strides", {0, 0}}}, "strides is 0"},
           {"Conv", {{"strides", {1, -1}}}, "strides is -1"},
           {"Conv", {{"dilations", {0, 1}}}, "dilations is 0"},
           {"Conv", {{"kernel_shape", {0, 3}}}, "kernel_shape is 0"},
           {"Conv", {{"kernel_shape", {1 << 30, 3}}}, "kernel_shape is"},
           {"Conv", {{"kernel_shape", {5, 5}}}, "that of its weights"},
           {"Conv", {{"pads", {0, 0, -1, 0}}}, "pads is -1"},
           {"MaxPool", {{"pads", {0, 0, 1 << 30, 0}}}, "pads is"},
           {"Pad", {{"pads", {1 << 30, 0}}}, "pads is"},
           {"Gather", {{"axis", {77}}}, "axis is 77"},
           {"Concat", {{"axis", {-9}}}, "axis is -9"},
           {"Squeeze", {{"axes", {1, 99}}}, "axes is 99"},
           {"Transpose", {{"perm", {0, 0, 1, 2}}}, "permutation"},
           {"Transpose", {{"perm", {1, 2, 3, 4}}}, "permutation"},
           {"DepthToSpace", {{"blocksize", {0}}}, "blocksize is 0"},
           {"LRN", {{"size", {0}}}, "size is 0"},
           {"Split", {{"split", {-1, 4}}}, "split is -1"}}) {
    ExpectInputError([&, graph = Graph(Node(kind, attributes))] { Check(graph); },
                     {"'odd' (" + kind + ")", part});
  }
}

TEST(OnnxGraph, WeightsThatDoNotFitTheirConvolutionAreRefused) {
  const ProtobufMessage node = Node("Conv", {});
  ExpectInputError(
      [&] {
        Check(ProtobufMessage().Message(1, node).Message(5, Weights("w", {6, 4})));
      },
      {"'odd'", "2 sides"});
  ExpectInputError(
      [&] {
        Check(ProtobufMessage()
                  .Message(1, node)
                  .Message(5, Weights("w", {6, 4, 3, 3}))
                  .Message(5, Weights("b", {1})));
      },
      {"'odd'", "6 values"});
}

TEST(OnnxGraph, TensorsOfAttributesAndGraphsInsideOthersAreChecked) {
  const auto inside = [](const ProtobufMessage& graph) {
    return ProtobufMessage().Message(
        1, ProtobufMessage().Text(4, "If").Message(
               5, ProtobufMessage().Text(1, "then_branch").Message(6, graph)));
  };
  const ProtobufMessage bad = Graph(Node("Conv", {{"group", {0}}}));
  ExpectInputError([&] { Check(inside(inside(bad))); }, {"group is 0"});
  const ProtobufMessage constant = ProtobufMessage().Message(
      1, ProtobufMessage()
             .Text(4, "Constant")
             .Message(
                 5, ProtobufMessage().Text(1, "value").Message(5, Weights("c", {2}).Number(1, 9))));
  ExpectInputError([&] { Check(inside(constant)); }, {"'c'", "expected 18"});
  ProtobufMessage deep = Graph(Node("Conv", {}));
  for (int i = 0; i < 100; ++i) {
    deep = inside(deep);
  }
  ExpectInputError([&] { Check(deep); }, {"inside each other"});
}

TEST(OnnxGraph, FilesOfValuesAreNamed) {
  const ProtobufMessage elsewhere = ProtobufMessage().Number(1, 2).Number(2, 1).Message(
      13, ProtobufMessage().Text(1, "location").Text(2, "w.bin"));
  std::set<std::string> files;
  CheckGraph(ProtobufMessage()
                 .Message(5, elsewhere)
                 .Message(1, ProtobufMessage().Message(
                                 5, ProtobufMessage().Text(1, "value").Message(5, elsewhere)))
                 .bytes(),
             files);
  EXPECT_EQ(files, (std::set<std::string>{"w.bin"}));
}

}  // namespace
}  // namespace hullslam
