// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_output.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "support/expect_error.h"
#include "support/made_live.h"

namespace hullslam {
namespace {

TEST(LiveOutput, DoesNothingWithoutARun) {
  LiveOutput live;
  EXPECT_FALSE(live.IsOn());
  EXPECT_EQ(live.url(), "");
  live.NoteFrame({});
  live.BeginFinishing();
}

TEST(LiveOutput, HasTheAddressOfItsView) {
  const SyntheticWorld world;
  const LiveOutput live({.address = {.port = 0}, .run = MadeLiveRun(world)});
  EXPECT_TRUE(live.IsOn());
  EXPECT_EQ(live.url().find("http://127.0.0.1:"), 0U);
  ExpectInputError(
      [&] { const LiveOutput bad({.address = {.address = "nowhere"}, .run = MadeLiveRun(world)}); },
      {"nowhere"});
}

}  // namespace
}  // namespace hullslam
