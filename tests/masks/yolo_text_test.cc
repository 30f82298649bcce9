// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/yolo_text.h"

#include <gtest/gtest.h>

#include "hullslam/masks/open_masks.h"
#include "support/comma_locale.h"
#include "support/square_mask.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::vector<std::string> kClasses = {"cup", "tv"};

// The masks of a folder with this text as its only file.
std::vector<InstanceMask> ReadBack(const std::string& text, const std::string& format) {
  const TemporaryFolder folder;
  folder.Write("000000.txt", text);
  folder.Write("classes.txt", "cup\ntv\n");
  const std::vector<MaskFrame> frames = {{.stem = "000000", .number = 0}};
  const auto source = OpenMasks({folder.path(), "", 640, 480}, frames);
  EXPECT_EQ(source->format(), format);
  return source->Read(frames.front()).masks;
}

TEST(YoloText, ReadersGiveTheSameMasks) {
  InstanceMask first = Square("tv", 20.5, 30.5, 100.0);
  first.score = 0.8765;
  const std::vector<InstanceMask> masks = {first, Square("cup", 300.0, 200.0, 10.0)};
  const std::vector<InstanceMask> read =
      ReadBack(YoloText(masks, kClasses, {640, 480}), "yolo-seg");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].label, "tv");
  EXPECT_EQ(read[1].label, "cup");
  EXPECT_NEAR(read[0].score, 0.8765, 1e-4);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(read[0].outlines[0][i].isApprox(first.outlines[0][i], 1e-5));
  }
}

TEST(YoloText, MasksAreRoundedAsTheirTextAlsoWithADecimalComma) {
  std::vector<InstanceMask> masks = {Square("tv", 20.3, 30.7, 100.1)};
  masks[0].score = 0.87654;
  std::vector<InstanceMask> rounded = masks;
  RoundAsYoloText({640, 480}, rounded);
  const CommaLocale comma;
  const std::vector<InstanceMask> read =
      ReadBack(YoloText(masks, kClasses, {640, 480}), "yolo-seg");
  RoundAsYoloText({640, 480}, masks);
  ASSERT_EQ(read.size(), 1U);
  for (const InstanceMask& other : {masks[0], read[0]}) {
    EXPECT_EQ(other.score, 0.8765);
    EXPECT_EQ(other.outlines, rounded[0].outlines);
  }
}

TEST(YoloText, AnOutlineAtTheBorderStaysInsideTheImage) {
  const std::vector<InstanceMask> masks = {Square("cup", -0.5, -0.5, 480.0)};
  const std::string text = YoloText(masks, kClasses, {640, 480});
  EXPECT_EQ(text, "0 0 0 0.749219 0 0.749219 0.998958 0 0.998958 1.0000\n");
}

TEST(YoloText, BoxesComeBackAsTheyWere) {
  InstanceMask box = Square("tv", 19.5, 29.5, 100.0);
  box.shape = MaskShape::kBox;
  box.score = 0.5;
  const std::vector<InstanceMask> read =
      ReadBack(YoloText({&box, 1}, kClasses, {640, 480}), "boxes");
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].shape, MaskShape::kBox);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(read[0].outlines[0][i].isApprox(box.outlines[0][i], 1e-4))
        << read[0].outlines[0][i].transpose();
  }
}

}  // namespace
}  // namespace hullslam
