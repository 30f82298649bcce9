// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/plane_sequence.h"
#include "support/run_program.h"

namespace hullslam {
namespace {

class Relocalise : public ::testing::Test {
 protected:
  ProgramResult Run(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {sequence_.path(), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram("hullslam relocalise", arguments);
  }
  void ExpectRefused(const std::vector<std::string>& more, const std::string& part) const {
    const ProgramResult result = Run(more);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }
  PlaneSequence sequence_ = PlaneSequence(12);
};

TEST_F(Relocalise, FindsFramesByWordsAndNoneWithoutThem) {
  const std::vector<std::string> frames = {"--map-frames", ":8", "--query-frames", "3:8", "--list",
                                           "--queries",    "4"};
  const ProgramResult found = Run(frames);
  ASSERT_EQ(found.exit_code, 0) << found.errors;
  EXPECT_NE(found.output.find("map of frames 0 to 8: "), std::string::npos) << found.output;
  EXPECT_NE(found.output.find(": by words, error 0.0"), std::string::npos) << found.output;
  EXPECT_NE(found.output.find("\nwords            4   100.0 %    100.0 %      0  "),
            std::string::npos)
      << found.output;
  std::vector<std::string> without = frames;
  without.insert(without.end(), {"--query-set", "tracking.relocalise_by_words=false"});
  const ProgramResult lost = Run(without);
  ASSERT_EQ(lost.exit_code, 0) << lost.errors;
  EXPECT_NE(lost.output.find("\nnot found        4     0.0 %"), std::string::npos) << lost.output;
}

TEST_F(Relocalise, RefusesFramesThatTheSequenceDoesNotHave) {
  for (const char* const range : {"3", "5:3", "0:12", "a:", ":-1", "1:2:3"}) {
    ExpectRefused({"--map-frames", range},
                  "--map-frames: '" + std::string(range) + "', expected FIRST:LAST");
    ExpectRefused({"--query-frames", range}, "--query-frames: '");
  }
  ExpectRefused({"--queries", "0"}, "--queries");
}

TEST_F(Relocalise, RefusesASequenceWithoutTruePoses) {
  std::filesystem::remove(sequence_.path() / "groundtruth.txt");
  ExpectRefused({}, "groundtruth.txt");
}

TEST_F(Relocalise, RefusesBadSettings) {
  ExpectRefused({"--query-set", "tracking.none=1"}, "unknown key 'tracking.none'");
}

}  // namespace
}  // namespace hullslam
