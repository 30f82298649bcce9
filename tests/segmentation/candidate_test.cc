// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/candidate.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

Candidate Box(double left, double right, double score, int class_number = 0) {
  return {.least = {left, 0.0},
          .greatest = {right, 10.0},
          .score = score,
          .class_number = class_number};
}

TEST(SuppressOverlaps, KeepsTheBestOfBoxesThatShowTheSame) {
  // 0 to 10 and 1 to 11 overlap by 9 / 11, and 0 to 10 and 2 to 12 by 8 / 12.
  const auto kept = SuppressOverlaps(
      {Box(1.0, 11.0, 0.5), Box(0.0, 10.0, 0.9), Box(2.0, 12.0, 0.4), Box(0.0, 10.0, 0.3, 1)});
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].score, 0.9);
  EXPECT_EQ(kept[1].score, 0.4);
  EXPECT_EQ(kept[2].class_number, 1);
}

TEST(SuppressOverlaps, TenThousandDetectionsBecomeAsManyAsAnImageMayHave) {
  std::vector<Candidate> candidates;
  for (int i = 0; i < 10'000; ++i) {
    candidates.push_back(Box(20.0 * i, 20.0 * i + 10.0, 0.5 + 1e-5 * (i % 100)));
  }
  const auto kept = SuppressOverlaps(candidates);
  EXPECT_EQ(kept.size(), kMostInstances);
  EXPECT_EQ(kept.front().least.x(), 20.0 * 99);  // ties go to the first
  EXPECT_GE(kept.front().score, kept.back().score);
}

}  // namespace

}  // namespace hullslam
