// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/interrupted_desk.h"
#include "support/mono_program.h"

namespace hullslam {
namespace {

class MonoIslands : public MonoProgram {
 protected:
  MonoIslands() : MonoProgram("mono_tum") {}
};

TEST_F(MonoIslands, AnIslandIsJoinedWhenItsPlaceIsSeenAgain) {
  const InterruptedDesk::Options options;
  const InterruptedDesk desk(options);
  const ProgramResult result = Run({desk.path()});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  ExpectParts(result.output, {"the map was begun 2 times; 1 of its parts were joined"});
  const Json summary = Summary();
  EXPECT_EQ(summary["islands"]["begun"], 2);
  EXPECT_EQ(summary["islands"]["joined"], 1);
  EXPECT_EQ(summary["islands"]["at_end"].size(), 1u);
  EXPECT_EQ(summary["trajectory"]["tracked"], desk.size() - options.blank);
  EXPECT_EQ(Poses().size(), static_cast<size_t>(desk.size() - options.blank));
  EXPECT_LE(Ate(), 0.005);
  // The report says where frames were lost, why, and what to do.
  ExpectParts(result.output, {"lost: frames 30 to 37 (8; 101.000 to 101.233 s): too few features",
                              "more light", "docs/my-run-fails.md"});
  ASSERT_EQ(summary["trajectory"]["losses"].size(), 1u);
  EXPECT_EQ(summary["trajectory"]["losses"][0]["first_frame"], 30);
}

}  // namespace
}  // namespace hullslam
