// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/frame.h"

#include <gtest/gtest.h>

#include <vector>

namespace hullslam {
namespace {

TEST(Frame, IsNoFrameUntilItHasAnId) {
  const Frame frame;
  EXPECT_FALSE(frame.id.IsValid());
  EXPECT_EQ(frame.timestamp, 0.0);
  EXPECT_EQ(frame.features.size(), 0u);
}

TEST(FrameWords, AreFoundOnceWhenTheyAreAskedFor) {
  EXPECT_TRUE(FrameWords().is_absent());
  EXPECT_TRUE(FrameWords(std::vector<WordId>()).is_absent());
  int calls = 0;
  const FrameWords words([&calls] {
    ++calls;
    return std::vector{WordId(3), WordId(4)};
  });
  const FrameWords copy = words;
  EXPECT_FALSE(words.is_absent());
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(copy.get(), (std::vector{WordId(3), WordId(4)}));
  EXPECT_EQ(words.get(), copy.get());
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace hullslam
