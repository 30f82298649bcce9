// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_rle.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>
#include <string>

#include "frame/detection/mask_outline.h"

namespace hullslam {
namespace {

// COCO's compressed form, implemented from its description. Numbers are in groups of five bits, the
// lowest first, plus 48. The bit with value 32 means that more groups follow. In the last group,
// the bit with value 16 is the sign.
std::string Compress(const MaskRuns& runs) {
  std::string text;
  for (size_t i = 0; i < runs.size(); ++i) {
    int64_t rest = int64_t{runs[i]} - (i > 2 ? int64_t{runs[i - 2]} : 0);
    bool has_more = true;
    while (has_more) {
      const int64_t group = rest & 31;
      rest >>= 5;
      has_more = (group & 16) != 0 ? rest != -1 : rest != 0;
      text += static_cast<char>(48 + group + (has_more ? 32 : 0));
    }
  }
  return text;
}

MaskRuns RunsOf(const cv::Mat& mask) {
  MaskRuns runs = {0};
  bool is_inside = false;
  for (int x = 0; x < mask.cols; ++x) {
    for (int y = 0; y < mask.rows; ++y) {
      if ((mask.at<uint8_t>(y, x) != 0) != is_inside) {
        runs.push_back(0);
        is_inside = !is_inside;
      }
      ++runs.back();
    }
  }
  return runs;
}

TEST(MaskRle, DecodesAsComputedByHand) {
  EXPECT_EQ(DecodeRuns("5"), MaskRuns({5}));
  EXPECT_EQ(DecodeRuns("d0"), MaskRuns({20}));  // 20 = 10100b needs a second group for the sign
  EXPECT_EQ(DecodeRuns("5325"), MaskRuns({5, 3, 2, 8}));  // the fourth run is 5 + the second
  EXPECT_EQ(DecodeRuns("532N"), MaskRuns({5, 3, 2, 1}));  // 2 less than the second: 11110b
  EXPECT_EQ(DecodeRuns(""), MaskRuns());
}

TEST(MaskRle, DecodingInvertsCompression) {
  std::mt19937 random(1);
  std::uniform_int_distribution<uint32_t> bits(0, 31);
  for (int repeat = 0; repeat < 200; ++repeat) {
    MaskRuns runs;
    for (int i = 0; i < 20; ++i) {
      runs.push_back(random() >> bits(random));
    }
    ASSERT_EQ(DecodeRuns(Compress(runs)), runs);
  }
}

TEST(MaskRle, RefusesInvalidNumbers) {
  EXPECT_FALSE(DecodeRuns("5 3").has_value());
  EXPECT_FALSE(DecodeRuns("5\x90").has_value());
  EXPECT_FALSE(DecodeRuns("5d").has_value());  // incomplete: more characters should follow
  EXPECT_FALSE(DecodeRuns("oooooooooooooo0").has_value());  // 70 bits
  EXPECT_FALSE(DecodeRuns("532M").has_value() && CountPixels(*DecodeRuns("532M")) != 10);
  EXPECT_FALSE(DecodeRuns("533L").has_value());  // 3 - 4 is negative
  EXPECT_FALSE(DecodeRuns(Compress({1, 2, 3, 0xffffffff}) + Compress({1, 2, 3, 0xffffffff}))
                   .has_value());  // more than 32 bits
}

TEST(MaskRle, OutlinesAreTheOutlinesOfTheMask) {
  cv::Mat mask(60, 80, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(10, 20, 30, 25)).setTo(1);
  mask(cv::Rect(30, 5, 9, 50)).setTo(1);
  mask(cv::Rect(60, 0, 20, 60)).setTo(1);  // runs over whole columns, to the last pixel
  const MaskRuns runs = RunsOf(mask);
  EXPECT_EQ(CountPixels(runs), 80U * 60U);
  EXPECT_EQ(OutlineRuns(runs, 80, 60), FindMaskOutlines(mask));
  EXPECT_TRUE(OutlineRuns({4800}, 80, 60).empty());
  EXPECT_TRUE(OutlineRuns({4800, 0}, 80, 60).empty());
}

}  // namespace
}  // namespace hullslam
