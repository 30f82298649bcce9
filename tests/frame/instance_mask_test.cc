// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/instance_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/expect_error.h"

namespace hullslam {
namespace {

TEST(InstanceMask, IsAContourWithScoreOneByDefault) {
  const InstanceMask mask;
  EXPECT_EQ(mask.shape, MaskShape::kContour);
  EXPECT_EQ(mask.score, 1.0);
  EXPECT_TRUE(mask.outlines.empty());
}

constexpr int kMaskWidth = 640;
constexpr int kMaskHeight = 480;

InstanceMask GoodMask() {
  return {.label = "cup", .score = 0.5, .outlines = {{{-1.0, 0.0}, {640.0, 0.0}, {320.0, 480.0}}}};
}

void ExpectRefusal(const InstanceMask& mask, const std::vector<std::string>& parts) {
  const std::vector<InstanceMask> masks = {GoodMask(), mask};
  ExpectInputError([&] { ValidateMasks(masks, kMaskWidth, kMaskHeight); }, parts);
}

TEST(InstanceMask, GoodMasksAreAccepted) {
  const std::vector<InstanceMask> masks = {
      GoodMask(), {.label = "box", .score = 0.0, .shape = MaskShape::kBox, .outlines = {}}};
  EXPECT_NO_THROW(ValidateMasks(masks, kMaskWidth, kMaskHeight));
}

TEST(InstanceMask, AMaskThatCannotBeUsedIsRefusedWithItsNumber) {
  InstanceMask mask = GoodMask();
  mask.label = "";
  ExpectRefusal(mask, {"mask 1", "label is empty"});
  for (const double score : {7.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    mask = GoodMask();
    mask.score = score;
    ExpectRefusal(mask, {"mask 1 ('cup')", "score", "from 0 to 1"});
  }
  for (const size_t points : {0U, 1U, 2U}) {
    mask = GoodMask();
    mask.outlines.emplace_back(points, Eigen::Vector2d(1.0, 1.0));
    ExpectRefusal(mask,
                  {"mask 1 ('cup')", std::to_string(points) + " point", "expected 3 to 100000"});
  }
  for (const double value : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e9, -641.0, 1281.0}) {
    mask = GoodMask();
    mask.outlines[0][1].x() = value;
    ExpectRefusal(mask, {"mask 1 ('cup')", "point", "640x480"});
    mask = GoodMask();
    mask.outlines[0][1].y() = value;
    ExpectRefusal(mask, {"mask 1 ('cup')", "point", "640x480"});
  }
}

TEST(InstanceMask, SharesOfTheImageAreRefused) {
  const InstanceMask shares{.label = "cup", .outlines = {{{0.2, 0.3}, {0.6, 0.3}, {0.4, 0.9}}}};
  const std::vector<InstanceMask> masks = {shares, shares};
  ExpectInputError([&] { ValidateMasks(masks, kMaskWidth, kMaskHeight); },
                   {"mask 0 ('cup')", "from 0 to 1", "expected pixels of the 640x480 image"});
  const std::vector<InstanceMask> mixed = {shares, GoodMask()};
  EXPECT_NO_THROW(ValidateMasks(mixed, kMaskWidth, kMaskHeight)) << "one may be a pixel";
}

TEST(InstanceMask, AnEmbeddingNeedsADirection) {
  InstanceMask mask = GoodMask();
  mask.embedding = {300.0F, -0.5F};
  EXPECT_NO_THROW(ValidateMasks({&mask, 1}, kMaskWidth, kMaskHeight)) << "any length will do";
  mask.embedding = {0.0F, 0.0F, 0.0F};
  ExpectRefusal(mask, {"mask 1 ('cup')", "embedding of 3 numbers", "direction"});
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    mask.embedding = {1.0F, value};
    ExpectRefusal(mask, {"mask 1 ('cup')", "embedding of 2 numbers", "not finite"});
  }
}

// Filling it would take minutes; nothing would interrupt it.
TEST(InstanceMask, AnOutlineThatGoesUpAndDownForEverIsRefused) {
  const auto zigzag = [](size_t points) {
    InstanceMask mask{.label = "cup", .outlines = {{}}};
    for (size_t i = 0; i < points; ++i) {
      mask.outlines[0].emplace_back(640.0 * static_cast<double>(i) / static_cast<double>(points),
                                    i % 2 == 0 ? 0.0 : 479.0);
    }
    return mask;
  };
  ExpectRefusal(zigzag(16'000), {"mask 1 ('cup')", "16000 points", "up and down"});
  ExpectRefusal(zigzag(100'001), {"100001 point(s)", "3 to 100000"});
  const std::vector<InstanceMask> few(20, zigzag(200));
  EXPECT_NO_THROW(ValidateMasks(few, kMaskWidth, kMaskHeight));
  const std::vector<InstanceMask> many(1'000, zigzag(200));
  ExpectInputError([&] { ValidateMasks(many, kMaskWidth, kMaskHeight); }, {"up and down"});
}

}  // namespace
}  // namespace hullslam
