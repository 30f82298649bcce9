// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/valid_ids.h"

#include <gtest/gtest.h>

#include <vector>

#include "hullslam/util/id.h"

namespace hullslam {
namespace {

TEST(IndicesOfValid, LeavesOutInvalidIds) {
  const std::vector<LandmarkId> ids = {LandmarkId(), LandmarkId(7), LandmarkId(), LandmarkId(0)};
  EXPECT_EQ(IndicesOfValid(ids), (std::vector<uint32_t>{1, 3}));
  EXPECT_TRUE(IndicesOfValid(std::vector<ObjectId>{ObjectId()}).empty());
}

}  // namespace
}  // namespace hullslam
