// SPDX-License-Identifier: GPL-3.0-or-later
// A desk is visited twice. Between the visits some objects were moved, taken away or added.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "hullslam/map_files/map_file.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;
using Json = nlohmann::json;

class RgbdChanges : public ::testing::Test {
 protected:
  void Render(const fs::path& sequence, const Arguments& more) const {
    Arguments arguments = {sequence, "--scene", "desk", "--frames", "60", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("make_synthetic", arguments);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }
  // Returns what the run prints.
  std::string Run(const fs::path& sequence, const Arguments& more) const {
    Arguments arguments = {sequence, "--masks", sequence / "masks", "--output", output_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("rgbd_tum", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output;
  }
  Json Objects() const { return Json::parse(ReadFile(output_ / "objects.json")); }
  Json Counts() const {
    return Json::parse(ReadFile(output_ / "summary.json"))["objects"]["changes"];
  }

  TemporaryFolder folder_;
  fs::path before_ = folder_.path() / "before";
  fs::path after_ = folder_.path() / "after";
  fs::path map_ = folder_.path() / "desk.map";
  fs::path output_ = folder_.path() / "out";
};

TEST_F(RgbdChanges, ASecondSessionListsWhatWasMovedTakenAndAdded) {
  Render(before_, {});
  Render(after_, {"--rearranged", "1"});
  const std::string first = Run(before_, {"--save-map", map_});
  EXPECT_EQ(first.find("seen again"), std::string::npos);
  EXPECT_TRUE(Objects()["changes"].is_null());
  EXPECT_TRUE(Counts().is_null());

  const std::string second = Run(after_, {"--load-map", map_, "--save-map", map_});
  EXPECT_NE(second.find("seen again"), std::string::npos) << second;
  EXPECT_EQ(Json::parse(ReadFile(output_ / "summary.json"))["provenance"]["loaded_map"],
            map_.string());
  EXPECT_NE(second.find("gone:  orange"), std::string::npos) << second;
  const size_t gone = Counts()["gone"];
  const size_t moved = Counts()["moved"];
  EXPECT_GE(Counts()["seen_again"], 9);
  const ProgramResult evaluation = RunProgram(
      "hullslam evaluate", {"objects", output_, "--groundtruth",
                            after_ / "groundtruth_objects.json", "--min-masks", "10", "--json"});
  ASSERT_EQ(evaluation.exit_code, 0) << evaluation.errors;
  const Json truth = Json::parse(evaluation.output)["groundtruth"]["changes"];
  EXPECT_EQ(truth["places_left"]["in_truth"], 6);
  EXPECT_EQ(truth["places_left"]["reported"], gone + moved);
  EXPECT_GE(truth["places_left"]["right"], 5);
  EXPECT_GE(truth["gone"]["right"], 2);
  EXPECT_GE(truth["moved"]["right"], 1);

  // An object that is gone is removed from the map, so a third session would not report it again.
  const StoredMap stored = ReadMap(map_);
  for (const auto& [id, object] : stored.map.objects()) {
    EXPECT_NE(object.Label(), "orange") << id.value;
  }
  Run(after_, {"--load-map", map_, "--localization"});
  EXPECT_TRUE(Objects()["changes"].is_null());
}

}  // namespace
}  // namespace hullslam
