// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

TEST(ObjectsOfSequence, PrintsTheMappedObjects) {
  const TemporaryFolder folder;
  const std::string desk = folder.path() / "desk";
  ASSERT_EQ(RunProgram("make_synthetic", {desk, "--frames", "60", "--quiet"}).exit_code, 0);
  const ProgramResult result =
      RunProgram("objects_of_sequence", {desk, desk + "/camera.yaml", desk + "/masks"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("mapped objects are in view\n"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("\nobject "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("\n  seen at "), std::string::npos) << result.output;
}

TEST(ObjectsOfSequence, RefusesBadUsageAndInput) {
  EXPECT_EQ(RunProgram("objects_of_sequence", {}).exit_code, 2);
  const ProgramResult result = RunProgram("objects_of_sequence", {"none", "none.yaml", "none"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("error: none.yaml"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace hullslam
