// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/frame.h"

#include <gtest/gtest.h>

namespace hullslam {
namespace {

TEST(Frame, IsNoFrameUntilItHasAnId) {
  const Frame frame;
  EXPECT_FALSE(frame.id.IsValid());
  EXPECT_EQ(frame.timestamp, 0.0);
  EXPECT_EQ(frame.features.size(), 0u);
}

}  // namespace
}  // namespace hullslam
