// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/session.h"

#include <gtest/gtest.h>

#include <vector>

namespace hullslam {
namespace {

TEST(Session, AFrameBelongsToTheLastSessionThatHadBegun) {
  const std::vector<Session> sessions = {{"a", FrameId(2)}, {"b", FrameId(5)}, {"c", FrameId(9)}};
  const std::vector<size_t> expected = {0, 0, 1, 1, 1, 2, 2, 2, 2, 3, 3};
  for (uint32_t frame = 0; frame < expected.size(); ++frame) {
    EXPECT_EQ(SessionNumber(sessions, FrameId(frame)), expected[frame]) << frame;
  }
  EXPECT_EQ(SessionNumber({}, FrameId(7)), 0u);
}

}  // namespace
}  // namespace hullslam
