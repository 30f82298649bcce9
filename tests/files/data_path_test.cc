// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/data_path.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/expect_error.h"
#include "support/paths.h"

namespace hullslam {
namespace {

// That an installation which was moved finds its own data is shown by the test "consumer".
TEST(DataPath, IsInTheSourceTreeWithoutAnInstallation) {
  EXPECT_TRUE(std::filesystem::equivalent(FindData("config", ""), SourceFolder() / "config"));
}

TEST(DataPath, AnErrorNamesAllPlacesAndTheHint) {
  ExpectInputError([] { FindData("no_such_data", "give --data FILE"); },
                   {"share/hullslam/no_such_data", (SourceFolder() / "no_such_data").string(),
                    "give --data FILE"});
}

}  // namespace
}  // namespace hullslam
