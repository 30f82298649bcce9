// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/onnx_file.h"

#include <gtest/gtest.h>

#include "hullslam/util/error.h"
#include "support/made_network.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(OnnxFile, HasTheInputsOutputsAndMetadata) {
  const TemporaryFolder folder;
  const OnnxFile file = ReadOnnx(folder.Write("a.onnx", MadeNetwork{.size = {96, 0}}.Bytes()));
  ASSERT_EQ(file.inputs.size(), 1U);
  EXPECT_EQ(file.inputs[0].name, "images");
  EXPECT_EQ(file.inputs[0].type, 1);
  EXPECT_EQ(DescribeShape(file.inputs[0].shape), "1x3x96x?");
  ASSERT_EQ(file.outputs.size(), 4U);
  EXPECT_EQ(file.outputs[3].name, "prototypes");
  EXPECT_EQ(file.metadata.at("names"), "{0: 'red', 1: 'blue'}");
}

TEST(OnnxFile, NoBytesCrashTheReader) {
  const TemporaryFolder folder;
  const std::string bytes = MadeNetwork().Bytes();
  size_t refused = 0;
  for (size_t size = 0; size < bytes.size(); size += 389) {
    std::string flipped = bytes;
    flipped[size] = static_cast<char>(~flipped[size]);
    for (const std::string& content : {bytes.substr(0, size), flipped}) {
      try {
        ReadOnnx(folder.Write("b.onnx", content));
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GE(refused, bytes.size() / 389);  // all that are cut off
}

}  // namespace
}  // namespace hullslam
