// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/network_layout.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace hullslam {
namespace {

const cv::Size kInput(640, 480);
constexpr int kCells = 80 * 60 + 40 * 30 + 20 * 15;

NetworkOutput Output(const std::string& name, const std::vector<int>& shape) {
  return {name, cv::Mat(static_cast<int>(shape.size()), shape.data(), CV_32F, cv::Scalar(0))};
}

std::vector<NetworkOutput> Maps(int channels, int coefficients) {
  std::vector<NetworkOutput> outputs;
  for (const int stride : {32, 8, 16}) {  // in any order
    outputs.push_back(
        Output("m" + std::to_string(stride), {1, channels, 480 / stride, 640 / stride}));
  }
  if (coefficients > 0) {
    outputs.push_back(Output("prototypes", {1, coefficients, 120, 160}));
  }
  return outputs;
}

TEST(NetworkLayout, IsKnownByTheShapesOfTheOutputs) {
  const NetworkLayout maps = RecogniseLayout(Maps(64 + 80 + 32, 32), kInput, {});
  EXPECT_EQ(maps.decode, &DecodeCells);
  EXPECT_EQ(maps.class_count, 80);
  EXPECT_EQ(maps.coefficient_count, 32);
  EXPECT_EQ(maps.heads, (std::vector<size_t>{1, 2, 0}));  // strides 8, 16, 32
  EXPECT_EQ(maps.prototypes, 3U);

  const std::vector<NetworkOutput> columns = {Output("output0", {1, 4 + 80 + 32, kCells}),
                                              Output("output1", {1, 32, 120, 160})};
  EXPECT_EQ(RecogniseLayout(columns, kInput, {}).decode, &DecodeColumns);
  EXPECT_EQ(RecogniseLayout(columns, kInput, {}).class_count, 80);

  const std::vector<NetworkOutput> rows = {Output("output0", {1, 3 * kCells, 5 + 7 + 32}),
                                           Output("output1", {1, 32, 120, 160})};
  EXPECT_EQ(RecogniseLayout(rows, kInput, {}).decode, &DecodeRows);
  EXPECT_EQ(RecogniseLayout(rows, kInput, {}).class_count, 7);

  const NetworkLayout boxes = RecogniseLayout(Maps(64 + 80, 0), kInput, 80);
  EXPECT_EQ(boxes.coefficient_count, 0);
  EXPECT_FALSE(boxes.prototypes);
}

// 3 * (5 + 80 + 32) = 351 channels could also be 255 classes of YOLOv8.
TEST(NetworkLayout, TheNumberOfClassesDecidesWhereShapesFitTwoLayouts) {
  const std::vector<NetworkOutput> outputs = Maps(351, 32);
  EXPECT_EQ(RecogniseLayout(outputs, kInput, 80).decode, &DecodeAnchors);
  EXPECT_EQ(RecogniseLayout(outputs, kInput, 255).decode, &DecodeCells);
  ExpectInputError([&] { RecogniseLayout(outputs, kInput, {}); },
                   {"255 classes", "80 classes", "--names"});
  ExpectInputError([&] { RecogniseLayout(outputs, kInput, 12); }, {"12 names of classes"});
}

TEST(NetworkLayout, OtherOutputsAreRefusedWithTheirShapes) {
  ExpectInputError(
      [&] {
        RecogniseLayout(std::vector{Output("probs", {1, 1000})}, kInput, {});
      },
      {"probs 1x1000", "classify whole images"});
  ExpectInputError(
      [&] {
        RecogniseLayout(std::vector{Output("map", {1, 19, 480, 640})}, kInput, {});
      },
      {"map 1x19x480x640", "640x480", "expected YOLOv8-seg"});
  ExpectInputError([&] { RecogniseLayout(Maps(64, 32), kInput, {}); }, {"1x64x60x80"});
}

}  // namespace
}  // namespace hullslam
