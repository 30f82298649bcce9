// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace hullslam {

// A message of protobuf, field by field.
class MadeMessage {
 public:
  MadeMessage& Number(uint64_t field, uint64_t value) {
    PutVarint(field << 3U);
    PutVarint(value);
    return *this;
  }
  MadeMessage& Text(uint64_t field, const std::string& value) {
    PutVarint(field << 3U | 2U);
    PutVarint(value.size());
    bytes_ += value;
    return *this;
  }
  MadeMessage& Message(uint64_t field, const MadeMessage& value) {
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

  std::string Bytes() const {
    MadeMessage graph;
    graph.Text(2, "blobs");
    graph.Message(11, Value("images", {1, 3, size[0], size[1]}));
    if (is_classifier) {
      AddClassifier(graph);
    } else {
      AddHeads(graph);
    }
    MadeMessage model;
    model.Number(1, 8).Message(7, graph).Message(8, MadeMessage().Text(1, "").Number(2, 12));
    if (!names.empty()) {
      model.Message(14, MadeMessage().Text(1, "names").Text(2, names));
    }
    return model.bytes();
  }

 private:
  static constexpr int kClasses = 2;
  static constexpr int kSides = 64;

  // The sides are an open number if they are 0.
  static MadeMessage Value(const std::string& name, const std::vector<int>& shape) {
    MadeMessage sides;
    for (const int side : shape) {
      sides.Message(1, side > 0 ? MadeMessage().Number(1, static_cast<uint64_t>(side))
                                : MadeMessage().Text(2, "any"));
    }
    return MadeMessage().Text(1, name).Message(
        2, MadeMessage().Message(1, MadeMessage().Number(1, 1).Message(2, sides)));
  }

  void AddWeights(const std::string& name, const std::vector<int>& shape,
                  const std::vector<float>& values, MadeMessage& graph) const {
    MadeMessage tensor;
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
      tensor.Message(13, MadeMessage().Text(1, "location").Text(2, weights_file)).Number(14, 1);
    }
    graph.Message(5, tensor);
  }

  static MadeMessage Integers(const std::string& name, const std::vector<int>& values) {
    MadeMessage attribute;
    attribute.Text(1, name);
    for (const int value : values) {
      attribute.Number(8, static_cast<uint64_t>(value));
    }
    return attribute.Number(20, 7);
  }

  static void AddNode(const std::string& kind, const std::vector<std::string>& inputs,
                      const std::string& output, const std::vector<MadeMessage>& attributes,
                      MadeMessage& graph) {
    MadeMessage node;
    for (const std::string& input : inputs) {
      node.Text(1, input);
    }
    node.Text(2, output).Text(3, output).Text(4, kind);
    for (const MadeMessage& attribute : attributes) {
      node.Message(5, attribute);
    }
    graph.Message(1, node);
  }

  // The mean colour of squares, and a linear function of it: `rows` has red, green, blue and the
  // constant of each channel.
  void AddColourMap(const std::string& name, int stride,
                    const std::vector<std::array<float, 4>>& rows, MadeMessage& graph) const {
    std::vector<float> factors;
    std::vector<float> constants;
    for (const std::array<float, 4>& row : rows) {
      factors.insert(factors.end(), row.begin(), row.begin() + 3);
      constants.push_back(row[3]);
    }
    const int channels = static_cast<int>(rows.size());
    AddWeights(name + ".weight", {channels, 3, 1, 1}, factors, graph);
    AddWeights(name + ".bias", {channels}, constants, graph);
    AddNode("AveragePool", {"images"}, name + ".mean",
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
    rows.push_back({gain, -gain / 2, -gain / 2, constant});
    rows.push_back({-gain / 2, -gain / 2, gain, constant});
    if (has_masks) {
      // The prototype of the cell's own colour counts.
      rows.push_back({2.0F, -2.0F, 0.0F, bias});
      rows.push_back({0.0F, -2.0F, 2.0F, bias});
    }
    return rows;
  }

  void AddHeads(MadeMessage& graph) const {
    AddColourMap("head0", 8, HeadRows(false), graph);
    AddColourMap("head1", 16, HeadRows(false), graph);
    AddColourMap("head2", 32, HeadRows(true), graph);
    if (has_masks) {
      AddColourMap("prototypes", 4,
                   {{20.0F, -10.0F, -10.0F, -10.0F}, {-10.0F, -10.0F, 20.0F, -10.0F}}, graph);
    }
  }

  void AddClassifier(MadeMessage& graph) const {
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
