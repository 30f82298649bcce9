// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/network_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "hullslam/util/error.h"
#include "segmentation/onnx_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

// YOLO looks at an image in cells of these sizes, px.
constexpr std::array kStrides = {8, 16, 32};

constexpr int kPrototypeStride = 4;  // px of the input per pixel of a prototype

std::vector<int64_t> ShapeOf(const cv::Mat& values) {
  return {values.size.p, values.size.p + values.dims};
}

int CellsOf(const cv::Size& input) {
  int cells = 0;
  for (const int stride : kStrides) {
    cells += (input.width / stride) * (input.height / stride);
  }
  return cells;
}

bool HasStride(const cv::Mat& values, const cv::Size& input, int stride) {
  return values.dims == 4 && values.size[0] == 1 && values.size[2] * stride == input.height &&
         values.size[3] * stride == input.width;
}

// A network whose outputs may fit, before it is known how many classes it has.
struct Layouts {
  std::span<const NetworkOutput> outputs;
  cv::Size input;
  std::optional<size_t> prototypes;
  int coefficients = 0;
  std::vector<NetworkLayout> found = {};

  // Adds the layout if there is a positive number of classes.
  void Add(const char* name, NetworkLayout::Decoder decode, int classes,
           std::vector<size_t> heads) {
    if (classes >= 1) {
      found.push_back({.name = name,
                       .decode = decode,
                       .input = input,
                       .class_count = classes,
                       .coefficient_count = coefficients,
                       .heads = std::move(heads),
                       .prototypes = prototypes});
    }
  }
};

void FindPrototypes(Layouts& layouts) {
  for (size_t i = 0; i < layouts.outputs.size(); ++i) {
    const cv::Mat& values = layouts.outputs[i].values;
    if (HasStride(values, layouts.input, kPrototypeStride)) {
      layouts.prototypes = i;
      layouts.coefficients = values.size[1];
    }
  }
}

// One output with a row or column for each cell: the exporter has added the decoding.
void AddDecoded(Layouts& layouts) {
  const int cells = CellsOf(layouts.input);
  for (size_t i = 0; i < layouts.outputs.size(); ++i) {
    const cv::Mat& values = layouts.outputs[i].values;
    if (values.dims != 3 || values.size[0] != 1) {
      continue;
    }
    if (values.size[2] == cells) {
      layouts.Add("YOLOv8 or YOLO11, decoded", DecodeColumns,
                  values.size[1] - 4 - layouts.coefficients, {i});
    }
    if (values.size[1] == kAnchorsPerCell * cells) {
      layouts.Add("YOLOv5, decoded", DecodeRows, values.size[2] - 5 - layouts.coefficients, {i});
    }
  }
}

// Three maps with the strides 8, 16 and 32 and equally many channels: without the decoding.
void AddMaps(Layouts& layouts) {
  std::vector<size_t> heads;
  int channels = 0;
  for (const int stride : kStrides) {
    for (size_t i = 0; i < layouts.outputs.size(); ++i) {
      const cv::Mat& values = layouts.outputs[i].values;
      if (HasStride(values, layouts.input, stride) &&
          (heads.empty() || values.size[1] == channels)) {
        channels = values.size[1];
        heads.push_back(i);
        break;
      }
    }
  }
  if (heads.size() != kStrides.size()) {
    return;
  }
  layouts.Add("YOLOv8 or YOLO11 before its decoding", DecodeCells,
              channels - kBoxChannels - layouts.coefficients, heads);
  if (channels % kAnchorsPerCell == 0) {
    layouts.Add("YOLOv5 before its decoding", DecodeAnchors,
                channels / kAnchorsPerCell - 5 - layouts.coefficients, heads);
  }
}

// What the outputs seem to be, for the message.
std::string Guess(std::span<const NetworkOutput> outputs) {
  const bool is_classifier = outputs.size() == 1 && outputs[0].values.dims == 2;
  return is_classifier ? "it seems to classify whole images" : "no known layout has these shapes";
}

}  // namespace

std::string DescribeOutputs(std::span<const NetworkOutput> outputs) {
  std::string text;
  for (const NetworkOutput& output : outputs) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", Printable(output.name),
                        DescribeShape(ShapeOf(output.values)));
  }
  return text;
}

NetworkLayout RecogniseLayout(std::span<const NetworkOutput> outputs, const cv::Size& input,
                              std::optional<size_t> known_classes) {
  Layouts layouts{.outputs = outputs, .input = input, .prototypes = {}};
  FindPrototypes(layouts);
  AddDecoded(layouts);
  AddMaps(layouts);
  std::vector<NetworkLayout>& found = layouts.found;
  const auto describe = [&] {
    return fmt::format("the outputs for an input of {}x{} px are {}", input.width, input.height,
                       DescribeOutputs(outputs));
  };
  if (found.empty()) {
    throw InputError(fmt::format("{}: {}, expected YOLOv8-seg, YOLO11-seg or YOLOv5-seg",
                                 describe(), Guess(outputs)));
  }
  const std::vector<NetworkLayout> all = found;
  if (known_classes) {
    std::erase_if(found, [&](const NetworkLayout& layout) {
      return static_cast<size_t>(layout.class_count) != *known_classes;
    });
  }
  if (found.size() == 1) {
    return found.front();
  }
  std::string fitting;
  for (const NetworkLayout& layout : all) {
    fitting += fmt::format("{}{} with {} classes", fitting.empty() ? "" : ", or ", layout.name,
                           layout.class_count);
  }
  throw InputError(fmt::format(
      "{}: that fits {}, {}", describe(), fitting,
      known_classes ? fmt::format("but there are {} names of classes", *known_classes)
                    : std::string("expected --names FILE, whose number of classes decides")));
}

}  // namespace hullslam
