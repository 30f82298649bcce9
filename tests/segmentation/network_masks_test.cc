// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/segmentation/network_masks.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "hullslam/sequences/image_stream.h"
#include "support/made_network.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(NetworkMasks, AreThoseOfEveryNthImageOfTheSelection) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "images");
  for (int i = 0; i < 8; ++i) {  // the blob moves by a cell
    cv::Mat image = GreyImage(128, 96);
    PaintBlob({4 + 32 * (i % 4), 4 + 32 * (i / 4), 24, 24}, true, image);
    cv::imwrite((folder.path() / "images" / (std::to_string(i) + ".png")).string(), image);
  }
  const ImageSequence sequence =
      OpenImageStream(folder.path() / "images", {.selection = {.first = 1}}).images;
  const PinholeCamera camera = {.width = 128, .height = 96};
  const auto network = folder.Write("network.onnx", MadeNetwork().Bytes());
  const NetworkMasks masks(network, {}, 3, sequence, camera);
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  ASSERT_EQ(frames.size(), 7U);
  for (size_t i = 0; i < frames.size(); ++i) {
    const FrameMasks found = masks.Read(frames[i]);
    EXPECT_EQ(masks.IsRead(i), i % 3 == 0);
    EXPECT_EQ(found.is_missing, i % 3 != 0);
    ASSERT_EQ(found.masks.size(), i % 3 == 0 ? 1U : 0U);
    if (i % 3 == 0) {
      const size_t cell = (i + 1) % 4;
      EXPECT_NEAR(found.masks[0].outlines[0].front().x(), 16.0 + 32.0 * static_cast<double>(cell),
                  13.0);
    }
    EXPECT_EQ(masks.Make(masks.LoadImage(i)).value().size(), 1U);
  }
  EXPECT_FALSE(NetworkMasks(network, {}, 0, sequence, camera).IsRead(0));
}

TEST(NetworkMasks, AnImageThatTheNetworkFailsOnHasNoneAndIsCounted) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "images");
  for (int i = 0; i < 4; ++i) {
    cv::Mat image = GreyImage(128, 96);
    PaintBlob({4, 4, 24, 24}, true, image);
    if (i % 2 == 1) {
      image(cv::Rect(64, 32, 32, 32)).setTo(cv::Scalar::all(255));
    }
    cv::imwrite((folder.path() / "images" / (std::to_string(i) + ".png")).string(), image);
  }
  const ImageSequence sequence = OpenImageStream(folder.path() / "images").images;
  const auto network =
      folder.Write("network.onnx", MadeNetwork{.overflows_on_white = true}.Bytes());
  const NetworkMasks masks(network, {}, 1, sequence, {.width = 128, .height = 96});
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  for (size_t i = 0; i < frames.size(); ++i) {
    const FrameMasks found = masks.Read(frames[i]);
    EXPECT_EQ(found.is_missing, i % 2 == 1);
    EXPECT_EQ(found.masks.size(), i % 2 == 0 ? 1U : 0U);
  }
  EXPECT_EQ(masks.work().failures, 2U);
  EXPECT_NE(masks.work().first_failure.find("'head0' has values that are not finite"),
            std::string::npos);
}

}  // namespace
}  // namespace hullslam
