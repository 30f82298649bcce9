// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of runs: --report, and the program view. tests/scripts/report_page_test.py opens them in
// a browser.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "support/rendered_desk.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// One rendered sequence for all tests of this file, and a run of it with a report.
class ReportTest : public ::testing::Test {
 protected:
  static const RenderedDesk& Desk() {
    static const RenderedDesk desk(30);
    return desk;
  }
  ProgramResult Run(const std::vector<std::string>& more, const std::string& setup = "") const {
    std::vector<std::string> arguments = {Desk().path(), "--masks", Desk().path() / "masks",
                                          "--output", output_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunProgram("rgbd_tum", arguments, setup);
  }
  // The parts of the data in a report.
  static Json PartsOf(const fs::path& report) {
    const std::string page = ReadFile(report);
    const std::string begin = "id=\"hullslam-data\">";
    const size_t at = page.find(begin) + begin.size();
    return Json::parse(page.substr(at, page.find("</script>", at) - at))["set"];
  }

  TemporaryFolder folder_;
  fs::path output_ = folder_.path() / "out";
};

TEST_F(ReportTest, HasWhatTheFilesOfTheRunDoNotHave) {
  const fs::path map = folder_.path() / "desk.map";
  const ProgramResult run =
      Run({"--report", "--save-map", map, "--set", "objects.start.min_views=4"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("the report is in " + (output_ / "report.html").string()),
            std::string::npos)
      << run.output;
  const Json parts = PartsOf(output_ / "report.html");
  EXPECT_EQ(parts["run"]["notes"], Json::array());
  EXPECT_TRUE(parts["landmarks"].contains("colour"));
  EXPECT_TRUE(parts["landmarks"].contains("age"));
  EXPECT_FALSE(parts["images"].empty());
  EXPECT_EQ(parts["settings"]["changed"][0]["key"], "objects.start.min_views");
  EXPECT_EQ(parts["settings"]["changed"][0]["value"], "4");
  const Json objects = Json::parse(ReadFile(output_ / "objects.json"))["objects"];
  ASSERT_EQ(parts["objects"].size(), objects.size());
  EXPECT_EQ(parts["objects"][0]["id"], objects[0]["id"]);

  // The report of the run has more than its files tell, so it stays. The next run replaces it.
  const std::string own = ReadFile(output_ / "report.html");
  const ProgramResult kept = RunProgram("hullslam view", {output_, "--report"});
  EXPECT_EQ(kept.exit_code, 0) << kept.errors;
  EXPECT_NE(kept.output.find("it stays (--output FILE"), std::string::npos) << kept.output;
  EXPECT_EQ(ReadFile(output_ / "report.html"), own);
  const fs::path beside = folder_.path() / "later.html";
  const ProgramResult again =
      RunProgram("hullslam view", {output_, "--report", "--quiet", "--output", beside});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  const Json later = PartsOf(beside);
  EXPECT_EQ(later["objects"].size(), objects.size());
  EXPECT_TRUE(later["landmarks"].contains("age"));
  EXPECT_FALSE(later["images"].empty());

  // A surface that was made since is added to it.
  const fs::path mesh = output_ / "mesh.ply";
  const ProgramResult made =
      RunProgram("hullslam mesh", {output_, "--output", mesh, "--voxel", "0.04", "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  for (int i = 0; i < 2; ++i) {  // the second one has nothing to do
    EXPECT_EQ(RunProgram("hullslam view", {output_, "--report", "--quiet"}).exit_code, 0);
    const Json with_surface = PartsOf(output_ / "report.html");
    EXPECT_EQ(with_surface["landmarks"], parts["landmarks"]);
    EXPECT_TRUE(with_surface["surface"].contains("triangle"));
  }
  fs::remove(mesh);
  EXPECT_EQ(RunProgram("hullslam view", {output_, "--report", "--quiet"}).exit_code, 0);
  EXPECT_EQ(ReadFile(output_ / "report.html"), own);

  fs::remove(output_ / "report.html");
  for (int i = 0; i < 2; ++i) {  // a report of the files may be replaced by another one
    EXPECT_EQ(RunProgram("hullslam view", {output_, "--report", "--quiet"}).exit_code, 0);
    EXPECT_TRUE(fs::exists(output_ / "report.html"));
    std::ofstream(output_ / "report.html", std::ios::app) << "changed";
  }
  EXPECT_FALSE(ReadFile(output_ / "report.html").ends_with("changedchanged"));
  folder_.Write("out/mesh.ply", "broken");
  const ProgramResult broken = RunProgram("hullslam view", {output_, "--report", "--quiet"});
  EXPECT_EQ(broken.exit_code, 0);
  EXPECT_NE(broken.errors.find("surface left out: "), std::string::npos) << broken.errors;

  const ProgramResult of_map = RunProgram("hullslam view", {map, "--report"});
  EXPECT_EQ(of_map.exit_code, 0) << of_map.errors;
  EXPECT_EQ(PartsOf(folder_.path() / "desk.html")["landmarks"]["total"],
            parts["landmarks"]["total"]);

  EXPECT_EQ(Run({"--quiet"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(output_ / "report.html"));
  EXPECT_FALSE(fs::exists(mesh));
}

// The page alone is larger than the largest file that may be written here, 800 blocks of 1 kB (or
// of 512 bytes); the results are smaller.
TEST_F(ReportTest, ResultsAreCompleteIfItCannotBeWritten) {
  const ProgramResult run = Run({"--report", "--last", "5", "--quiet"}, "ulimit -f 800;");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("error: the report could not be written: "), std::string::npos)
      << run.errors;
  EXPECT_TRUE(fs::exists(output_ / "summary.json"));
  EXPECT_TRUE(fs::exists(output_ / "objects.json"));
  EXPECT_FALSE(fs::exists(output_ / "report.html"));
}

TEST_F(ReportTest, OtherFoldersAndFilesAreRefused) {
  const auto expect_refusal = [](const fs::path& input, const std::string& part) {
    const ProgramResult result = RunProgram("hullslam view", {input, "--report"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  };
  expect_refusal(folder_.path() / "missing", "does not exist");
  expect_refusal(folder_.path(), "summary.json");
  expect_refusal(folder_.Write("a.map", "no map"), "a.map");
  EXPECT_FALSE(fs::exists(folder_.path() / "report.html"));
  EXPECT_FALSE(fs::exists(folder_.path() / "a.html"));
}

}  // namespace
}  // namespace hullslam
