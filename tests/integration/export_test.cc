// SPDX-License-Identifier: GPL-3.0-or-later
// The program export, on a run of a rendered desk. What other programs think of the files is tested
// where they are installed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <stdexcept>
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

// A run with depth, masks and a saved map, which all tests share.
struct DeskRun {
  RenderedDesk desk{20};
  TemporaryFolder folder;
  fs::path run = folder.path() / "run";
  fs::path map = folder.path() / "desk.map";

  DeskRun() {
    const ProgramResult result =
        RunProgram("rgbd_tum", {desk.path(), "--masks", desk.path() / "masks", "--output", run,
                                "--save-map", map, "--quiet"});
    if (result.exit_code != 0) {
      throw std::runtime_error(result.errors);
    }
  }
  Json Summary() const { return Json::parse(ReadFile(run / "summary.json")); }
};

class Export : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { desk_run_ = std::make_unique<DeskRun>(); }
  static void TearDownTestSuite() { desk_run_.reset(); }

  const fs::path& run() const { return desk_run_->run; }
  const fs::path& map() const { return desk_run_->map; }
  fs::path Out(const std::string& name) const { return out_.path() / name; }

  // The output of an export that must not fail.
  std::string ExportTo(const std::string& format, const fs::path& output,
                       std::vector<std::string> more = {}, const fs::path& input = {}) const {
    std::vector<std::string> arguments = {input.empty() ? run() : input, "--to", format, "--output",
                                          output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunProgram("hullslam export", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output + result.errors;
  }
  // Expects exit code 2, one line on stderr with all parts, and no output.
  void ExpectRefused(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& parts) const {
    const ProgramResult result = RunProgram("hullslam export", arguments);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    }
    EXPECT_TRUE(fs::is_empty(out_.path()));
  }

  static std::unique_ptr<DeskRun> desk_run_;
  TemporaryFolder out_;
};
std::unique_ptr<DeskRun> Export::desk_run_;

size_t CountLines(const fs::path& file) {
  const std::string text = ReadFile(file);
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

size_t CountFiles(const fs::path& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder), {}));
}

TEST_F(Export, ColmapHasAnImagePerKeyframe) {
  const std::string output = ExportTo("colmap", Out("colmap"), {"--text"});
  EXPECT_NE(output.find("points with tracks"), std::string::npos) << output;
  EXPECT_EQ(output.find("note:"), std::string::npos) << output;
  const size_t keyframes = desk_run_->Summary()["map"]["keyframes"].get<size_t>();
  EXPECT_EQ(CountFiles(Out("colmap") / "images"), keyframes);
  const std::string images = ReadFile(Out("colmap") / "sparse/0/images.txt");
  for (const fs::directory_entry& image : fs::directory_iterator(Out("colmap") / "images")) {
    EXPECT_NE(images.find(" " + image.path().filename().string() + "\n"), std::string::npos);
  }
  // Points have colours of the images, not the grey of points without an image.
  const std::string points = ReadFile(Out("colmap") / "sparse/0/points3D.txt");
  const std::regex grey(" 128 128 128 ");
  EXPECT_LT(std::distance(std::sregex_iterator(points.begin(), points.end(), grey), {}), 10);
}

TEST_F(Export, ColmapReadsAndAdjustsTheModel) {
  if (RunShell("command -v colmap >/dev/null") != 0) {
    GTEST_SKIP() << "the Debian package colmap is not installed";
  }
  const std::string setup = "QT_QPA_PLATFORM=offscreen ";
  const std::string log = Out("log.txt");
  for (const std::string form : {"binary", "text"}) {
    const fs::path model = Out(form);
    ExportTo("colmap", model,
             form == "text" ? std::vector<std::string>{"--text"} : std::vector<std::string>{});
    ASSERT_EQ(RunShell(setup + "colmap model_analyzer --path '" + (model / "sparse/0").string() +
                       "' > '" + log + "' 2>&1"),
              0);
    const std::string text = ReadFile(log);
    std::smatch error;
    ASSERT_TRUE(std::regex_search(text, error, std::regex("reprojection error: ([0-9.]+)px")))
        << text;
    EXPECT_LT(std::stod(error[1]), 1.0);
    EXPECT_GT(std::stod(error[1]), 0.01);
  }
  const fs::path adjusted = Out("adjusted");
  fs::create_directory(adjusted);
  EXPECT_EQ(RunShell(setup + "colmap bundle_adjuster --input_path '" +
                     (Out("binary") / "sparse/0").string() + "' --output_path '" +
                     adjusted.string() + "' > '" + log + "' 2>&1"),
            0)
      << ReadFile(log);
  EXPECT_TRUE(fs::exists(adjusted / "points3D.bin"));
}

TEST_F(Export, NerfstudioHasImagesAndDepths) {
  const fs::path out = Out("nerf");
  ExportTo("nerfstudio", out);
  const Json json = Json::parse(ReadFile(out / "transforms.json"));
  EXPECT_EQ(json["frames"].size(), desk_run_->Summary()["map"]["keyframes"].get<size_t>());
  EXPECT_TRUE(fs::exists(out / json["ply_file_path"].get<std::string>()));
  for (const Json& frame : json["frames"]) {
    const cv::Mat image = cv::imread(out / frame["file_path"].get<std::string>());
    const cv::Mat depth =
        cv::imread(out / frame["depth_file_path"].get<std::string>(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(image.cols, json["w"].get<int>());
    EXPECT_EQ(image.size(), depth.size());
    ASSERT_EQ(depth.type(), CV_16UC1);
    // The desk is 0.5 to 5 m away.
    const double millimetres = cv::mean(depth)[0];
    EXPECT_GT(millimetres, 500.0);
    EXPECT_LT(millimetres, 5000.0);
  }
  EXPECT_FALSE(fs::exists(out / "masks")) << "nobody is at the desk";
}

TEST_F(Export, NerfstudioMasksTheClassesThatAreAskedFor) {
  const fs::path out = Out("nerf");
  ExportTo("nerfstudio", out, {"--masked-classes", "keyboard, person"});
  const Json json = Json::parse(ReadFile(out / "transforms.json"));
  double darkest = 255.0;
  for (const Json& frame : json["frames"]) {
    const cv::Mat mask =
        cv::imread(out / frame["mask_path"].get<std::string>(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(mask.cols, json["w"].get<int>());
    ASSERT_EQ(mask.type(), CV_8UC1);
    darkest = std::min(darkest, cv::mean(mask)[0]);
  }
  EXPECT_LT(darkest, 254.0) << "the keyboard is left out";
  EXPECT_GT(darkest, 128.0) << "most of the image is used";
}

TEST_F(Export, PosesHaveALineEach) {
  const size_t poses = CountLines(run() / "trajectory.txt") - 1;
  ExportTo("kitti", Out("poses.txt"));
  EXPECT_EQ(CountLines(Out("poses.txt")), poses);
  ExportTo("euroc", Out("poses.csv"));
  EXPECT_EQ(CountLines(Out("poses.csv")), poses + 1);
  ExportTo("kitti", Out("keyframes.txt"), {}, map());
  EXPECT_EQ(CountLines(Out("keyframes.txt")),
            desk_run_->Summary()["map"]["keyframes"].get<size_t>());
}

TEST_F(Export, GraphAndPlyAreMadeOfRunAndMap) {
  ExportTo("g2o", Out("run.g2o"));
  ExportTo("g2o", Out("map.g2o"), {}, map());
  EXPECT_EQ(ReadFile(Out("run.g2o")), ReadFile(Out("map.g2o")));
  EXPECT_NE(ReadFile(Out("run.g2o")).find("EDGE_SE3:QUAT"), std::string::npos);
  const std::string of_run = ExportTo("ply", Out("run.ply"));
  const std::string of_map = ExportTo("ply", Out("map.ply"), {}, map());
  EXPECT_EQ(of_run.find("note:"), std::string::npos) << of_run;
  EXPECT_NE(of_map.find("the points have no colours"), std::string::npos) << of_map;
  EXPECT_EQ(fs::file_size(Out("run.ply")), fs::file_size(Out("map.ply")));
}

TEST_F(Export, OfARunWithoutItsMapHasGreyPoints) {
  const std::string output =
      ExportTo("gltf", Out("a.glb"), {"--map", map(), "--sequence", desk_run_->desk.path()});
  EXPECT_EQ(output.find("note:"), std::string::npos) << output;
  const TemporaryFolder moved;
  fs::copy(run(), moved.path() / "run");
  Json summary = desk_run_->Summary();
  summary["provenance"]["map"] = nullptr;
  moved.Write("run/summary.json", summary.dump());
  const std::string grey = ExportTo("ply", Out("grey.ply"), {}, moved.path() / "run");
  EXPECT_NE(grey.find("the run has not saved its map"), std::string::npos) << grey;
  EXPECT_GT(fs::file_size(Out("grey.ply")), 1000U);
  fs::remove_all(Out("a.glb"));
  fs::remove_all(Out("grey.ply"));
  ExpectRefused({moved.path() / "run", "--to", "colmap", "--output", Out("x")}, {"--save-map"});
  summary["provenance"]["map"] = map().string();
  summary["provenance"]["sequence"] = "nowhere";
  moved.Write("run/summary.json", summary.dump());
  ExpectRefused({moved.path() / "run", "--to", "colmap", "--output", Out("x")},
                {"nowhere", "--sequence"});
  summary["map"]["keyframes"] = 1234;
  moved.Write("run/summary.json", summary.dump());
  ExpectRefused({moved.path() / "run", "--to", "g2o", "--output", Out("x")}, {"1234", "desk.map"});
}

TEST_F(Export, BadUsageAndInputIsRefused) {
  ExpectRefused({run(), "--to", "obj", "--output", Out("x")}, {"--to", "colmap"});
  ExpectRefused({run(), "--to", "ply"}, {"--output"});
  ExpectRefused({Out("none"), "--to", "ply", "--output", Out("x")}, {"does not exist"});
  ExpectRefused({run(), "--to", "gltf", "--output", Out("x"), "--objects-as", "cones"},
                {"--objects-as", "boxes"});
  ExpectRefused({map(), "--to", "colmap", "--output", Out("x")}, {"desk.map", "images"});
  ExpectRefused({run(), "--to", "colmap", "--output", run() / "colmap"}, {"run/colmap"});
  ExpectRefused({desk_run_->desk.path(), "--to", "ply", "--output", Out("x")}, {"summary.json"});
  const TemporaryFolder broken;
  ExpectRefused({broken.Write("wrong.map", "no map"), "--to", "ply", "--output", Out("x")},
                {"wrong.map"});
  broken.Write("run/summary.json", "{\"provenance\": 3}");
  ExpectRefused({broken.path() / "run", "--to", "ply", "--output", Out("x")}, {"summary.json"});
}

TEST_F(Export, ReplacesFilesOnlyWithForce) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("poses.txt", "mine");
  ExpectRefused({run(), "--to", "kitti", "--output", file}, {"poses.txt", "--force"});
  ExpectRefused({run(), "--to", "colmap", "--output", folder.path()}, {"--force"});
  EXPECT_EQ(ReadFile(file), "mine");
  ExportTo("kitti", file, {"--force"});
  EXPECT_GT(CountLines(file), 10U);
  ExportTo("colmap", folder.path(), {"--force"});
  EXPECT_TRUE(fs::exists(folder.path() / "sparse/0/cameras.bin"));
  EXPECT_TRUE(fs::exists(file));
}

}  // namespace
}  // namespace hullslam
