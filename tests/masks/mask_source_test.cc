// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/masks/mask_source.h"

#include <gtest/gtest.h>

#include <string>

#include "masks/mask_fixture.h"

namespace hullslam {
namespace {

const char* const kMaskOfSource = "41 0.25 0.25 0.5 0.25 0.25 0.75 0.9\n";

// Masks whose format is detected.
class MaskSourceTest : public MaskFixture {
 protected:
  MaskSourceTest() : MaskFixture("") {}
};

TEST(MaskFrames, HaveTheStemsAndNumbersOfTheImages) {
  ImageSequence sequence;
  sequence.frames = {{1.5, "a/rgb/1.500000.png", "", 3}, {2.5, "/b/rgb/0007.JPG", "", 4}};
  const std::vector<MaskFrame> frames = MaskFrames(sequence);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].stem, "1.500000");
  EXPECT_EQ(frames[0].number, 3U);
  EXPECT_EQ(frames[1].stem, "0007");
}

TEST_F(MaskSourceTest, FramesWithoutMasksAreCounted) {
  Write("1.5.txt", "");
  Write("3.5.txt", kMaskOfSource);
  frames_ = {{"1.5", 0}, {"2.5", 1}, {"3.5", 2}};
  const MaskCounts counts = CheckMasks(*Open(), frames_);
  EXPECT_EQ(counts.missing, 1U);
  EXPECT_EQ(counts.without_masks, 2U) << "one has no file, the other an empty one";
}

}  // namespace
}  // namespace hullslam
