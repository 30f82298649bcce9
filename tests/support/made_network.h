// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

namespace hullslam {

// A message of protobuf, field by field.
class ProtobufMessage {
 public:
  ProtobufMessage& Number(uint64_t field, uint64_t value) {
    PutVarint(field << 3U);
    PutVarint(value);
    return *this;
  }
  ProtobufMessage& Text(uint64_t field, const std::string& value) {
    PutVarint(field << 3U | 2U);
    PutVarint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtobufMessage& Message(uint64_t field, const ProtobufMessage& value) {
    return Text(field, value.bytes());
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void PutVarint(uint64_t value) {
    for (; value >= 0x80; value >>= 7U) {
      bytes_ += static_cast<char>(value | 0x80U);
    }
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

// A network in ONNX that finds red and blue blobs, laid out as YOLOv8-seg before its decoding. A
// cell of 32 px of which a fifth is red (or blue) is an instance with a box of 64 px around its
// middle; smaller cells find nothing. The logit of a mask is 10 where 4x4 px are red (or blue), and
// -10 where they are grey, so the outline runs where the colour ends.
struct MadeNetwork {
  std::string names = "{0: 'red', 1: 'blue'}";  // empty: none
  std::array<int, 2> size = {96, 128};          // height and width; 0: open
  bool has_masks = true;                        // else a network that finds boxes
  bool is_classifier = false;
  float bias = 0.0F;              // of the coefficients
  std::string weights_file = {};  // where the weights are said to be; empty: in the network
  // The axis of a node Gather in front of all others; absent: there is none.
  std::optional<int> gather_axis = {};
  bool overflows_on_white = false;  // values are not finite where 8x8 px are white

  std::string Bytes() const {
    ProtobufMessage graph;
    graph.Text(2, "blobs");
    graph.Message(11, Value("images", {1, 3, size[0], size[1]}));
    if (gather_axis) {
      AddGather(graph);
    }
    if (is_classifier) {
      AddClassifier(graph);
    } else {
      AddHeads(graph);
    }
    ProtobufMessage model;
    model.Number(1, 8).Message(7, graph).Message(8, ProtobufMessage().Text(1, "").Number(2, 12));
    if (!names.empty()) {
      model.Message(14, ProtobufMessage().Text(1, "names").Text(2, names));
    }
    return model.bytes();
  }

 private:
  static constexpr int kClasses = 2;
  static constexpr int kSides = 64;

  // The sides are an open number if they are 0.
  static ProtobufMessage Value(const std::string& name, const std::vector<int>& shape) {
    ProtobufMessage sides;
    for (const int side : shape) {
      sides.Message(1, side > 0 ? ProtobufMessage().Number(1, static_cast<uint64_t>(side))
                                : ProtobufMessage().Text(2, "any"));
    }
    return ProtobufMessage().Text(1, name).Message(
        2, ProtobufMessage().Message(1, ProtobufMessage().Number(1, 1).Message(2, sides)));
  }

  void AddWeights(const std::string& name, const std::vector<int>& shape,
                  const std::vector<float>& values, ProtobufMessage& graph) const {
    ProtobufMessage tensor;
    for (const int side : shape) {
      tensor.Number(1, static_cast<uint64_t>(side));
    }
    std::string raw;
    for (const float value : values) {
      const auto bytes = std::bit_cast<std::array<char, 4>>(value);
      raw.append(bytes.data(), bytes.size());
    }
    tensor.Number(2, 1).Text(8, name);
    if (weights_file.empty()) {
      tensor.Text(9, raw);
    } else {
      tensor.Message(13, ProtobufMessage().Text(1, "location").Text(2, weights_file)).Number(14, 1);
    }
    graph.Message(5, tensor);
  }

  static ProtobufMessage Integers(const std::string& name, const std::vector<int>& values) {
    ProtobufMessage attribute;
    attribute.Text(1, name);
    for (const int value : values) {
      attribute.Number(8, static_cast<uint64_t>(value));
    }
    return attribute.Number(20, 7);
  }

  static void AddNode(const std::string& kind, const std::vector<std::string>& inputs,
                      const std::string& output, const std::vector<ProtobufMessage>& attributes,
                      ProtobufMessage& graph) {
    ProtobufMessage node;
    for (const std::string& input : inputs) {
      node.Text(1, input);
    }
    node.Text(2, output).Text(3, output).Text(4, kind);
    for (const ProtobufMessage& attribute : attributes) {
      node.Message(5, attribute);
    }
    graph.Message(1, node);
  }

  void AddGather(ProtobufMessage& graph) const {
    graph.Message(5, ProtobufMessage().Number(1, 1).Number(2, 7).Text(8, "index").Number(7, 0));
    const ProtobufMessage axis = ProtobufMessage()
                                     .Text(1, "axis")
                                     .Number(3, static_cast<uint64_t>(int64_t{*gather_axis}))
                                     .Number(20, 2);
    AddNode("Gather", {"images", "index"}, "gathered", {axis}, graph);
  }

  // The mean colour of squares, and a linear function of it: `rows` has red, green, blue and the
  // constant of each channel.
  void AddColourMap(const std::string& name, int stride,
                    const std::vector<std::array<float, 4>>& rows, ProtobufMessage& graph) const {
    std::vector<float> factors;
    std::vector<float> constants;
    for (const std::array<float, 4>& row : rows) {
      factors.insert(factors.end(), row.begin(), row.begin() + 3);
      constants.push_back(row[3]);
    }
    const int channels = static_cast<int>(rows.size());
    AddWeights(name + ".weight", {channels, 3, 1, 1}, factors, graph);
    AddWeights(name + ".bias", {channels}, constants, graph);
    AddNode("AveragePool", {gather_axis ? "gathered" : "images"}, name + ".mean",
            {Integers("kernel_shape", {stride, stride}), Integers("strides", {stride, stride})},
            graph);
    AddNode("Conv", {name + ".mean", name + ".weight", name + ".bias"}, name,
            {Integers("kernel_shape", {1, 1})}, graph);
    graph.Message(12, Value(name, {1, channels, size[0] / stride, size[1] / stride}));
  }

  std::vector<std::array<float, 4>> HeadRows(bool finds) const {
    std::vector<std::array<float, 4>> rows(kSides, {0.0F, 0.0F, 0.0F, 0.0F});
    for (size_t side = 0; side < 4; ++side) {
      rows[side * 16 + 1][3] = 30.0F;  // all sides are one stride from the middle
    }
    const float gain = finds ? 20.0F : 0.0F;
    const float constant = finds ? -5.0F : -20.0F;
    if (!finds && overflows_on_white) {
      rows[0] = {1.4e38F, 1.4e38F, 1.4e38F, 0.0F};
    }
    rows.push_back({gain, -gain / 2, -gain / 2, constant});
    rows.push_back({-gain / 2, -gain / 2, gain, constant});
    if (has_masks) {
      // The prototype of the cell's own colour counts.
      rows.push_back({2.0F, -2.0F, 0.0F, bias});
      rows.push_back({0.0F, -2.0F, 2.0F, bias});
    }
    return rows;
  }

  void AddHeads(ProtobufMessage& graph) const {
    AddColourMap("head0", 8, HeadRows(false), graph);
    AddColourMap("head1", 16, HeadRows(false), graph);
    AddColourMap("head2", 32, HeadRows(true), graph);
    if (has_masks) {
      AddColourMap("prototypes", 4,
                   {{20.0F, -10.0F, -10.0F, -10.0F}, {-10.0F, -10.0F, 20.0F, -10.0F}}, graph);
    }
  }

  void AddClassifier(ProtobufMessage& graph) const {
    AddNode("GlobalAveragePool", {"images"}, "mean", {}, graph);
    AddNode("Flatten", {"mean"}, "classes", {}, graph);
    graph.Message(12, Value("classes", {1, 3}));
  }
};

// A grey image (blue first) with blobs: their colour is red or blue.
inline cv::Mat GreyImage(int width, int height) {
  return cv::Mat(height, width, CV_8UC3, cv::Scalar::all(128));
}
inline void PaintBlob(const cv::Rect& blob, bool is_red, cv::Mat& image) {
  image(blob).setTo(is_red ? cv::Scalar(0, 0, 255) : cv::Scalar(255, 0, 0));
}

}  // namespace hullslam
