// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "files/text_rows.h"
#include "support/plane_sequence.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::json;

// The JSON that `evaluate objects` prints for a run, with the comparison with the true objects.
Json CompareWithTruth(const fs::path& sequence, const fs::path& run) {
  const ProgramResult result = RunProgram(
      "hullslam evaluate",
      {"objects", run, "--groundtruth", sequence / "groundtruth_objects.json", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return Json::parse(result.output);
}

TEST(MapObjects, EllipsoidsHaveTheTruePositionAndSize) {
  const TemporaryFolder folder;
  const fs::path desk = folder.path() / "desk";
  // All 300 frames are needed: the first 150 show the objects from one side only, which does not
  // constrain their height.
  ASSERT_EQ(RunProgram("make_synthetic", {desk, "--quiet"}).exit_code, 0);
  const fs::path run = folder.path() / "run";
  const ProgramResult result =
      RunProgram("hullslam map-objects", {desk, "--poses", desk / "groundtruth.txt", "--masks",
                                          desk / "masks", "--output", run, "--quiet", "--debug"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("debug: object 8 (apple): mapped from 3 keyframes"),
            std::string::npos)
      << result.errors.substr(0, 1000);

  const Json truth = CompareWithTruth(desk, run)["groundtruth"];
  std::set<std::string> found;
  for (const Json& object : truth["each"]) {
    if (object["shape"] != "ellipsoid" || object["mapped"].empty()) {
      continue;
    }
    SCOPED_TRACE(object["class"].get<std::string>());
    EXPECT_EQ(object["mapped"].size(), 1U) << "mapped twice";
    EXPECT_LE(object["mapped"][0]["center_share"], 0.03);
    for (const Json& ratio : object["mapped"][0]["axis_ratios"]) {
      EXPECT_NEAR(ratio.get<double>(), 1.0, 0.05);
    }
    found.insert(object["class"]);
  }
  EXPECT_EQ(found, (std::set<std::string>{"apple", "mouse", "orange"}));
  EXPECT_NEAR(truth["shapes"]["ellipsoid"]["axis_ratio_mean"].get<double>(), 1.0, 0.01);
}

// A sequence of four frames with masks. Each test gives other bad input, which must be refused.
class MapObjectsRefuses : public ::testing::Test {
 protected:
  MapObjectsRefuses() {
    folder_.Write("masks/00.txt", "41 0.25 0.25 0.5 0.25 0.5 0.5 0.25 0.5 0.9\n");
  }

  void Expect(const fs::path& poses, const std::vector<std::string>& more,
              const std::vector<std::string>& parts) const {
    std::vector<std::string> arguments = {sequence_.path(), "--output", folder_.path() / "out",
                                          "--poses", poses};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("hullslam map-objects", arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos)
          << "no '" << part << "' in: " << result.errors;
    }
    EXPECT_FALSE(fs::exists(folder_.path() / "out"))
        << "a refused run must not create its output folder";
  }

  TemporaryFolder folder_;
  PlaneSequence sequence_ = PlaneSequence(4);
  fs::path poses_ = sequence_.path() / "groundtruth.txt";
  std::string masks_ = folder_.path() / "masks";
};

TEST_F(MapObjectsRefuses, PosesThatAreMissingMalformedOrOfAnotherTime) {
  Expect(folder_.path() / "none.txt", {"--masks", masks_}, {"none.txt", "No such file"});
  Expect(folder_.Write("broken.txt", "1 0 0 0 0 0 0 1\n2 0 nan 0 0 0 0 1\n"), {"--masks", masks_},
         {"broken.txt:2: ", "'nan'"});
  const fs::path early = folder_.Write("early.txt", "1 0 0 0 0 0 0 1\n1.05 0 0 0 0 0 0 1\n");
  Expect(early, {"--masks", masks_}, {early, sequence_.path(), "no frame"});
}

TEST_F(MapObjectsRefuses, MasksThatAreMissingOrOfOtherFrames) {
  Expect(poses_, {}, {"--masks"});
  Expect(poses_, {"--masks", masks_ + "/none"}, {masks_ + "/none"});
  folder_.Write("others/1.5.txt", "41 0.25 0.25 0.5 0.25 0.5 0.5 0.25 0.5 0.9\n");
  // The message names one mask file and one frame, so that the user can compare the names.
  Expect(poses_, {"--masks", folder_.path() / "others"}, {"'1.5.txt'", "00"});
}

TEST_F(MapObjectsRefuses, BadSettings) {
  Expect(poses_, {"--masks", masks_, "--set", "objects.epsilon=3"},
         {"--set", "unknown key 'objects.epsilon'"});
  Expect(poses_, {"--masks", masks_, "--min-distance", "-1"}, {"--min-distance"});
  Expect(poses_, {"--masks", masks_, "--min-distance", "nan"}, {"--min-distance", "'nan'"});
  Expect(poses_, {"--masks", masks_, "--min-angle", "nan"}, {"--min-angle", "'nan'"});
}

}  // namespace
}  // namespace hullslam
