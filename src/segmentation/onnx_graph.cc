// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "files/protobuf_reader.h"
#include "hullslam/util/error.h"
#include "segmentation/onnx_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr int64_t kMostSides = 8;  // of a tensor: networks for images have up to 6
constexpr int64_t kMostPixels = 100'000;

// The values that an attribute of integers may have, in the nodes of the kinds; without kinds, in
// all nodes.
struct AttributeRange {
  std::string_view name;
  int64_t least;
  int64_t most;
  std::vector<std::string_view> kinds = {};
};

const std::vector<AttributeRange>& Ranges() {
  static const std::vector<std::string_view> kWindows = {"Conv", "ConvTranspose", "MaxPool",
                                                         "AveragePool", "LpPool"};
  static const std::vector<AttributeRange> kRanges = {
      {"group", 1, kMostPixels},
      {"kernel_shape", 1, kMostPixels},
      {"strides", 1, kMostPixels},
      {"dilations", 1, kMostPixels},
      {"pads", 0, kMostPixels, kWindows},
      {"pads", -kMostPixels, kMostPixels},
      {"output_padding", 0, kMostPixels},
      {"axis", -kMostSides, kMostSides - 1},
      {"axes", -kMostSides, kMostSides - 1},
      {"perm", 0, kMostSides - 1},
      {"split", 0, kMostPixels * kMostPixels},
      {"blocksize", 1, kMostPixels},
      {"size", 1, kMostPixels},
      {"pooled_shape", 1, kMostPixels},
      {"hidden_size", 1, kMostPixels},
  };
  return kRanges;
}

struct Node {
  std::string name;
  std::string kind;
  std::vector<std::string> inputs;
  std::map<std::string, std::vector<int64_t>> integers;  // attributes
};

[[noreturn]] void Fail(const Node& node, const std::string& fault) {
  throw InputError(
      fmt::format("the node '{}' ({}): {}", Printable(node.name), Printable(node.kind), fault));
}

void CheckRange(const Node& node, const std::string& name, const std::vector<int64_t>& values) {
  const auto range = std::ranges::find_if(Ranges(), [&](const AttributeRange& candidate) {
    return candidate.name == name &&
           (candidate.kinds.empty() ||
            std::ranges::find(candidate.kinds, node.kind) != candidate.kinds.end());
  });
  if (range == Ranges().end()) {
    return;
  }
  for (const int64_t value : values) {
    if (value < range->least || value > range->most) {
      Fail(node,
           fmt::format("{} is {}, expected {} to {}", name, value, range->least, range->most));
    }
  }
}

// A permutation has each index once.
void CheckPermutation(const Node& node, std::vector<int64_t> values) {
  std::ranges::sort(values);
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i] != static_cast<int64_t>(i)) {
      Fail(node, "perm is no permutation of the sides");
    }
  }
}

// The sides of a convolution's weights that its attributes repeat.
void CheckConvolution(const Node& node, const std::map<std::string, OnnxTensor>& weights) {
  const auto find = [&](size_t input) {
    return input < node.inputs.size() ? weights.find(node.inputs[input]) : weights.end();
  };
  const auto kernel = find(1);
  if (kernel == weights.end()) {
    return;
  }
  const std::vector<int64_t>& shape = kernel->second.shape;
  if (shape.size() < 3) {
    Fail(node, fmt::format("its weights have {} sides, expected 3 or more", shape.size()));
  }
  const auto window = node.integers.find("kernel_shape");
  if (window != node.integers.end() &&
      !std::ranges::equal(window->second, std::span(shape).subspan(2))) {
    Fail(node, "kernel_shape is not that of its weights");
  }
  if (const auto bias = find(2); bias != weights.end() && node.kind == "Conv" &&
                                 bias->second.shape != std::vector<int64_t>{shape[0]}) {
    Fail(node, fmt::format("its bias does not have {} values", shape[0]));
  }
  const auto group = node.integers.find("group");
  if (group != node.integers.end() && shape[0] % group->second.front() != 0) {
    Fail(node,
         fmt::format("group is {}, expected a divisor of {}", group->second.front(), shape[0]));
  }
}

// Goes through a graph and those inside it.
class Checker {
 public:
  explicit Checker(std::set<std::string>& weight_files) : weight_files_(weight_files) {}

  void CheckGraph(std::string_view graph, int depth) {
    constexpr int kMostDepth = 16;
    if (depth > kMostDepth) {
      throw InputError(fmt::format("more than {} graphs are inside each other", kMostDepth));
    }
    std::map<std::string, OnnxTensor> weights;
    for (ProtobufReader fields(graph, kOnnxName); fields.Next();) {
      if (fields.field() == 5) {
        OnnxTensor tensor = CheckTensor(fields.bytes());
        weights.insert_or_assign(tensor.name, std::move(tensor));
      }
    }
    for (ProtobufReader fields(graph, kOnnxName); fields.Next();) {
      if (fields.field() == 1) {
        CheckNode(fields.bytes(), weights, depth);
      }
    }
  }

 private:
  OnnxTensor CheckTensor(std::string_view message) {
    OnnxTensor tensor = ReadTensor(message);
    if (tensor.file) {
      weight_files_.insert(*tensor.file);
    }
    return tensor;
  }

  // NodeProto.
  void CheckNode(std::string_view message, const std::map<std::string, OnnxTensor>& weights,
                 int depth) {
    Node node;
    for (ProtobufReader fields(message, kOnnxName); fields.Next();) {
      if (fields.field() == 1) {
        node.inputs.emplace_back(fields.bytes());
      } else if (fields.field() == 3) {
        node.name = fields.bytes();
      } else if (fields.field() == 4) {
        node.kind = fields.bytes();
      } else if (fields.field() == 5) {
        ReadAttribute(fields.bytes(), depth, node);
      }
    }
    for (const auto& [name, values] : node.integers) {
      CheckRange(node, name, values);
    }
    if (const auto perm = node.integers.find("perm"); perm != node.integers.end()) {
      CheckPermutation(node, perm->second);
    }
    if (node.kind == "Conv" || node.kind == "ConvTranspose") {
      CheckConvolution(node, weights);
    }
  }

  // AttributeProto.
  void ReadAttribute(std::string_view message, int depth, Node& node) {
    std::string name;
    std::vector<int64_t> values = ReadIntegers(message, 8);
    for (ProtobufReader fields(message, kOnnxName); fields.Next();) {
      if (fields.field() == 1) {
        name = fields.bytes();
      } else if (fields.field() == 3) {
        values.push_back(static_cast<int64_t>(fields.number()));
      } else if (fields.field() == 5 || fields.field() == 10) {
        CheckTensor(fields.bytes());
      } else if (fields.field() == 6 || fields.field() == 11) {
        CheckGraph(fields.bytes(), depth + 1);
      }
    }
    if (!values.empty()) {
      node.integers.insert_or_assign(std::move(name), std::move(values));
    }
  }

  std::set<std::string>& weight_files_;
};

}  // namespace

void CheckGraph(std::string_view graph, std::set<std::string>& weight_files) {
  Checker(weight_files).CheckGraph(graph, 0);
}

}  // namespace hullslam
