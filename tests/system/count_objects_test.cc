// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/count_objects.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(CountObjects, EachReasonOfMasksAndObjectsHasANameOfItsOwn) {
  DetectionCounts masks;
  masks.detections = 7;
  masks.frames_with_masks = 3;
  std::map<ObjectRejection, size_t> rejections;
  size_t expected = 0;
  for (int i = 0; i < kDetectionRejectionCount; ++i) {
    masks.rejections[static_cast<DetectionRejection>(i)] = static_cast<size_t>(i) + 1;
    expected += static_cast<size_t>(i) + 1;
  }
  for (int i = 0; i < kObjectRejectionCount; ++i) {
    rejections[static_cast<ObjectRejection>(i)] = static_cast<size_t>(i) + 10;
    expected += static_cast<size_t>(i) + 10;
  }
  const ObjectCounts counts = CountObjects(masks, 10, rejections);
  EXPECT_EQ(counts.detections, 7u);
  EXPECT_EQ(counts.frames_with_masks, 3u);
  EXPECT_EQ(counts.frames_without_masks, 7u);
  EXPECT_EQ(counts.rejections.size(),
            static_cast<size_t>(kDetectionRejectionCount + kObjectRejectionCount));
  size_t sum = 0;
  for (const auto& [reason, count] : counts.rejections) {
    sum += count;
  }
  EXPECT_EQ(sum, expected);
  EXPECT_EQ(counts.rejections.at("mask_low_score"), 1u);
  EXPECT_EQ(counts.rejections.at("few_views"), 10u);
}

}  // namespace
}  // namespace hullslam
