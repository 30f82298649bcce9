// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/built_frame.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(DetectionCounts, AddsEachCount) {
  DetectionCounts sum = {
      .detections = 2, .frames_with_masks = 1, .rejections = {{DetectionRejection::kTooSmall, 3}}};
  sum.Add(
      {.detections = 5,
       .frames_with_masks = 1,
       .rejections = {{DetectionRejection::kTooSmall, 1}, {DetectionRejection::kDuplicate, 4}}});
  EXPECT_EQ(sum.detections, 7u);
  EXPECT_EQ(sum.frames_with_masks, 2u);
  EXPECT_EQ(sum.rejections,
            (std::map<DetectionRejection, size_t>{{DetectionRejection::kTooSmall, 4},
                                                  {DetectionRejection::kDuplicate, 4}}));
}

}  // namespace
}  // namespace hullslam
