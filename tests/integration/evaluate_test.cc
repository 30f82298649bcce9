// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/read_file.h"
#include "files/staged_file.h"
#include "hullslam/results/trajectory_file.h"
#include "results/object_file.h"
#include "results/scene_file.h"
#include "results/summary.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace hullslam {
namespace {

Trajectory Curve(double scale) {
  Trajectory trajectory;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back(
        {t, Rigid3(ExpSo3({0.0, 0.0, t}), {scale * std::cos(t), scale * std::sin(t), scale * t})});
  }
  return trajectory;
}

class Evaluate : public ::testing::Test {
 protected:
  Evaluate() {
    WriteFileAtomically(truth_, FormatTrajectory(Curve(1.0)));
    WriteFileAtomically(half_, FormatTrajectory(Curve(0.5)));
  }

  // Expects exit code 2, nothing on stdout, and one line on stderr that contains `part`.
  static void ExpectRefusal(const std::vector<std::string>& arguments, const std::string& part) {
    const ProgramResult result = RunProgram("hullslam evaluate", arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(result.errors.starts_with("error: ")) << result.errors;
    EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
  }

  TemporaryFolder folder_;
  std::string truth_ = folder_.path() / "truth.txt";
  std::string half_ = folder_.path() / "half.txt";
};

TEST_F(Evaluate, StatesErrorsPairsAlignmentAndScale) {
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"trajectory", truth_, half_, "--align", "sim3"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  for (const char* const part :
       {"ATE", "RPE 1 s", "60 of the estimate", "60 of the ground truth",
        "tum's rule within 0.02 s", "coverage 100.0 %", "sim3", "scale 2.000000", "scale drift"}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
  }
}

TEST_F(Evaluate, JsonHasTheSameNumbers) {
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"trajectory", truth_, half_, "--json", "--tool", "evo",
                                       "--align", "none", "--max-diff", "0.05"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["pairs"], 60);
  EXPECT_EQ(json["pairing"], "evo");
  EXPECT_EQ(json["alignment"], "none");
  EXPECT_EQ(json["max_difference_s"], 0.05);
  EXPECT_EQ(json["coverage"], 1.0);
  // The error is largest at the last pose, at 5.9 s, where it is half of (cos t, sin t, t).
  EXPECT_NEAR(json["ate_m"]["max"].get<double>(), 0.5 * std::hypot(1.0, 5.9), 1e-6);
  EXPECT_GT(json["rpe"]["translation_m"]["rmse"].get<double>(), 0.1);
}

TEST_F(Evaluate, BadInputIsRefusedWithOneLine) {
  const std::string broken =
      folder_.Write("broken.txt", "1.0 nan 0 0 0 0 0 1\n2.0 nan 0 0 0 0 0 1\n");
  const std::string late = folder_.Write("late.txt", "100 0 0 0 0 0 0 1\n");
  ExpectRefusal({"trajectory", truth_, broken}, "broken.txt:1: tx is 'nan'");
  ExpectRefusal({"trajectory", broken, half_}, "broken.txt:1:");
  ExpectRefusal({"trajectory", truth_, folder_.path() / "none.txt"}, "none.txt: No such file");
  ExpectRefusal({"trajectory", truth_, late}, "no pose of the estimate has a partner");
}

TEST_F(Evaluate, BadUsageIsRefusedWithOneLine) {
  ExpectRefusal({}, "subcommand");
  ExpectRefusal({"trajectory", truth_}, "ESTIMATE");
  ExpectRefusal({"trajectory", truth_, half_, "--align", "affine"}, "affine");
  ExpectRefusal({"trajectory", truth_, half_, "--max-diff", "0"}, "--max-diff");
  ExpectRefusal({"trajectory", truth_, half_, "--max-diff", "nan"}, "--max-diff");
  ExpectRefusal({"trajectory", truth_, half_, "--no-such"}, "--no-such");
}

// A run on a synthetic sequence of 40 frames along a curve. One sphere has a perfect mask and is
// mapped 1 % too large; another one is not mapped.
class EvaluateObjects : public Evaluate {
 protected:
  EvaluateObjects() {
    report_.camera.fx = 500.0;
    report_.camera.fy = 500.0;
    report_.camera.cx = 320.0;
    report_.camera.cy = 240.0;
    report_.candidates = 2;
    const Ellipsoid truth = {Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0}),
                             Eigen::Vector3d::Constant(0.1)};
    const Ellipse outline = ProjectEllipsoid(report_.camera.Matrix(), {}, truth).value();
    ObjectResult object;
    object.id = ObjectId(3);
    object.state = ObjectState::kMapped;
    object.label = "cup";
    object.ellipsoid = {truth.world_from_object, 1.01 * truth.half_axes};
    ObservationResult view;
    view.keyframe = KeyframeId(0);
    view.hull = view.contour = outline.Polygon(100);
    view.lines = {{{Eigen::Vector2d::UnitX(), -outline.Bounds().max().x()}, false}};
    object.observations = {view};
    report_.objects = {object};
    WriteRun();
    WriteSequence();
  }

  void WriteRun() {
    folder_.Write("run/objects.json", FormatObjects(report_));
    folder_.Write("run/objects_observations.json", FormatObservations(report_));
  }

  // Writes the same run as if it were monocular, with a map whose unit of length is `unit` metres.
  void WriteMonocularRun(double unit) {
    Ellipsoid& ellipsoid = report_.objects[0].ellipsoid;
    ellipsoid.world_from_object.translation /= unit;
    ellipsoid.half_axes /= unit;
    WriteRun();
    Trajectory trajectory = ReadTrajectory(folder_.path() / "run" / "trajectory.txt");
    for (StampedPose& pose : trajectory) {
      pose.world_from_cam.translation /= unit;
    }
    WriteFileAtomically(folder_.path() / "run" / "trajectory.txt", FormatTrajectory(trajectory));
    RunSummary summary;
    summary.trajectory.alignment = "sim3";
    folder_.Write("run/summary.json", FormatSummary(summary));
  }

  // Writes the sequence. Its world frame and that of the run differ by a rotation and a
  // translation.
  void WriteSequence() {
    const Rigid3 truth_from_map(ExpSo3({0.0, 0.0, 0.3}), {1.0, 2.0, 3.0});
    Trajectory truth;
    Trajectory run;
    std::string images;
    for (int i = 0; i < 40; ++i) {
      const double t = 0.1 * i;
      const Rigid3 pose(Eigen::Quaterniond::Identity(),
                        {0.1 * std::sin(t), 0.1 * std::cos(t), 0.02 * t});
      run.push_back({t, pose});
      truth.push_back({t, truth_from_map * pose});
      const std::string number = std::to_string(i);
      images += std::to_string(t) + " images/" + number + ".png\n";
      folder_.Write("images/" + number + ".png", "");
      // A square of 60 px around the middle, where the sphere is.
      folder_.Write("masks/" + number + ".txt",
                    "41 0.453 0.438 0.547 0.438 0.547 0.562 0.453 0.562 1\n");
    }
    folder_.Write("rgb.txt", images);
    folder_.Write("depth.txt", images);
    WriteFileAtomically(folder_.path() / "groundtruth.txt", FormatTrajectory(truth));
    WriteFileAtomically(folder_.path() / "run" / "trajectory.txt", FormatTrajectory(run));
    const Eigen::Vector3d center = truth_from_map * Eigen::Vector3d(0.0, 0.0, 2.0);
    const auto entry = [](int id, const Eigen::Vector3d& at) {
      return nlohmann::json{{"id", id},
                            {"class", "cup"},
                            {"shape", "ellipsoid"},
                            {"dynamic", false},
                            {"world_from_object", {at.x(), at.y(), at.z(), 0, 0, 0, 1}},
                            {"half_extents", {0.1, 0.1, 0.1}}};
    };
    const nlohmann::json objects = {entry(0, center), entry(1, {9.0, 9.0, 9.0})};
    truth_file_ =
        folder_.Write("groundtruth_objects.json", nlohmann::json{{"objects", objects}}.dump());
  }

  ObjectResults report_;
  std::string run_ = folder_.path() / "run";
  std::string truth_file_;
};

TEST_F(EvaluateObjects, MeasuresTheFinishedRunAgain) {
  const ProgramResult result = RunProgram("hullslam evaluate", {"objects", run_, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["count"], 1);
  EXPECT_EQ(json["candidates"], 2);
  EXPECT_EQ(json["observations"], 1);
  EXPECT_EQ(json["lines"], 1);
  EXPECT_NEAR(json["siou_mean"].get<double>(), 1.0 / (1.01 * 1.01), 1e-3);
  EXPECT_NEAR(json["siou_mask_mean"].get<double>(), 1.0 / (1.01 * 1.01), 1e-3);
  EXPECT_NEAR(json["tangent_mean_px"].get<double>(), 0.01 * 500.0 * 0.1 / 2.0, 0.01);
  // The expected value is (1.01 r)^2 - r^2 with the radius r = 0.1 m of the sphere.
  EXPECT_NEAR(json["mtd_mean_m2"].get<double>(), 2.01e-4, 2e-6);
  EXPECT_EQ(json["each"][0]["id"], 3);
  EXPECT_TRUE(json["groundtruth"].is_null());
}

TEST_F(EvaluateObjects, ComparesWithTheTruth) {
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"objects", run_, "--groundtruth", truth_file_, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto truth = nlohmann::json::parse(result.output)["groundtruth"];
  EXPECT_EQ(truth["alignment"], "se3");
  EXPECT_EQ(truth["scale"], 1.0);
  EXPECT_EQ(truth["visible"], 1);
  EXPECT_EQ(truth["once"], 1);
  EXPECT_EQ(truth["never"], 0);
  EXPECT_EQ(truth["each"][0]["masks"], 40);
  EXPECT_EQ(truth["each"][1]["masks"], 0);
  EXPECT_LT(truth["each"][0]["mapped"][0]["center_share"].get<double>(), 1e-6);
  EXPECT_NEAR(truth["shapes"]["ellipsoid"]["axis_ratio_mean"].get<double>(), 1.01, 1e-9);
  EXPECT_NEAR(truth["shapes"]["ellipsoid"]["siou_mean"].get<double>(), 1.0 / (1.01 * 1.01), 1e-3);
  EXPECT_EQ(truth["without_truth"].size(), 0U);
}

TEST_F(EvaluateObjects, AMonocularRunIsComparedInMetres) {
  WriteMonocularRun(2.5);
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"objects", run_, "--groundtruth", truth_file_, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto truth = nlohmann::json::parse(result.output)["groundtruth"];
  EXPECT_EQ(truth["alignment"], "sim3");
  EXPECT_NEAR(truth["scale"].get<double>(), 2.5, 1e-6);
  EXPECT_LT(truth["ate_rmse_m"].get<double>(), 1e-6);
  EXPECT_EQ(truth["once"], 1);
  EXPECT_LT(truth["each"][0]["mapped"][0]["center_m"].get<double>(), 1e-6);
  EXPECT_NEAR(truth["shapes"]["ellipsoid"]["axis_ratio_mean"].get<double>(), 1.01, 1e-6);
}

TEST_F(EvaluateObjects, NamesTheAlignmentAndTheUnit) {
  const std::vector<std::string> arguments = {"objects", run_, "--groundtruth", truth_file_};
  const ProgramResult with_depth = RunProgram("hullslam evaluate", arguments);
  EXPECT_NE(with_depth.output.find("half axes m\n"), std::string::npos) << with_depth.output;
  EXPECT_NE(with_depth.output.find("after se3 alignment of the poses with scale 1.000000 (ATE"),
            std::string::npos)
      << with_depth.output;
  WriteMonocularRun(2.5);
  const ProgramResult monocular = RunProgram("hullslam evaluate", arguments);
  for (const char* const part :
       {"half axes u\n", "MTD u2", " u2; mean tangent", "u is the unit of length of the map",
        "after sim3 alignment of the poses with scale 2.50000", "1 mapped once"}) {
    EXPECT_NE(monocular.output.find(part), std::string::npos) << part << " in\n"
                                                              << monocular.output;
  }
}

TEST_F(EvaluateObjects, TheAlignmentCanBeGiven) {
  WriteMonocularRun(2.5);
  // If --align is given, summary.json is not read. This one would be refused.
  folder_.Write("run/summary.json", "{}");
  std::vector<std::string> arguments = {"objects", run_,      "--groundtruth", truth_file_,
                                        "--json",  "--align", "sim3"};
  const auto counts = [&] {
    const ProgramResult result = RunProgram("hullslam evaluate", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return nlohmann::json::parse(result.output)["groundtruth"];
  };
  EXPECT_EQ(counts()["once"], 1);
  arguments.back() = "se3";
  EXPECT_EQ(counts()["never"], 1);
  arguments.back() = "none";
  ExpectRefusal(arguments, "--align");
}

// The camera of a short run moves by less than the error of its positions. An alignment by
// positions alone would turn the world by any angle.
TEST_F(EvaluateObjects, AShortRunIsAlignedByItsOrientationsToo) {
  Trajectory run;
  Trajectory truth;
  const Rigid3 truth_from_map(ExpSo3({0.0, 0.0, 0.3}), {1.0, 2.0, 3.0});
  for (int i = 0; i < 40; ++i) {
    const double t = 0.1 * i;
    const Eigen::Vector3d true_position(1e-3 * std::sin(t), 0.0, 0.0);
    const Eigen::Vector3d error(0.0, 1e-3 * std::cos(2.0 * t), 1e-3 * std::sin(t));
    run.push_back({t, Rigid3(Eigen::Quaterniond::Identity(), true_position + error)});
    truth.push_back({t, truth_from_map * Rigid3(Eigen::Quaterniond::Identity(), true_position)});
  }
  WriteFileAtomically(folder_.path() / "groundtruth.txt", FormatTrajectory(truth));
  WriteFileAtomically(folder_.path() / "run" / "trajectory.txt", FormatTrajectory(run));
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"objects", run_, "--groundtruth", truth_file_, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto mapped = nlohmann::json::parse(result.output)["groundtruth"]["each"][0]["mapped"];
  ASSERT_EQ(mapped.size(), 1U);
  EXPECT_LT(mapped[0]["center_m"].get<double>(), 0.002);
}

TEST_F(EvaluateObjects, PrintsTables) {
  const ProgramResult result = RunProgram(
      "hullslam evaluate", {"objects", run_, "--groundtruth", truth_file_, "--min-masks", "41"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* const part :
       {"1 mapped, 2 not mapped; 1 observations and 1 lines", "mean SIoU 0.98",
        "0 visible (in 41 masks or more)", "ellipsoid    1 mapped: mean centre error 0.0 %"}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
  }
}

TEST_F(EvaluateObjects, ARunWithoutObjectsHasNoMeans) {
  report_.objects.clear();
  WriteRun();
  const ProgramResult result = RunProgram("hullslam evaluate", {"objects", run_});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("mean SIoU - with hulls, - with masks"), std::string::npos)
      << result.output;
}

// The sphere of 0.1 m is mapped 1 % too large, and its tight box with it.
TEST_F(EvaluateObjects, MeasuresTrueBodies) {
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"objects", run_, "--truth", truth_file_, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto truth = nlohmann::json::parse(result.output)["truth"];
  EXPECT_EQ(truth["alignment"], "se3");
  EXPECT_EQ(truth["boxes"]["25"]["truths"], 2);
  EXPECT_EQ(truth["boxes"]["50"]["ar"], 0.5);
  EXPECT_EQ(truth["boxes_of_class"]["50"]["ap"], 0.5);
  EXPECT_EQ(truth["solids"]["50"]["precision"], 1.0);
  EXPECT_EQ(truth["missed"], nlohmann::json({1}));
  ASSERT_EQ(truth["each"].size(), 1U);
  EXPECT_EQ(truth["each"][0]["object"], 3);
  EXPECT_NEAR(truth["each"][0]["solid_iou"].get<double>(), 1.0 / std::pow(1.01, 3), 0.005);
  EXPECT_NEAR(truth["shapes"]["ellipsoid"]["longest"].get<double>(), 0.01, 1e-6);
  EXPECT_LT(truth["errors"]["center_m"].get<double>(), 1e-6);
  EXPECT_TRUE(truth["errors"]["turn_rad"].is_null()) << "a sphere";
}

TEST_F(EvaluateObjects, TrueBodiesOfAMonocularRunAreMeasuredInMetres) {
  WriteMonocularRun(2.5);
  const std::string file = folder_.path() / "errors.json";
  const ProgramResult result =
      RunProgram("hullslam evaluate", {"objects", run_, "--truth", truth_file_, "--json", file});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto truth = nlohmann::json::parse(ReadFile(file))["truth"];
  EXPECT_NEAR(truth["scale"].get<double>(), 2.5, 1e-6);
  EXPECT_NEAR(truth["errors"]["axes_mean"].get<double>(), 0.01, 1e-6);
  for (const char* const part :
       {"after sim3 alignment with scale 2.5", "AP25", "boxes of one class",
        "2 of 2 bodies count: 1 mapped, 1 missed", "ellipsoid        1"}) {
    EXPECT_NE(result.output.find(part), std::string::npos) << part << " in\n" << result.output;
  }
}

// The map is in another frame than the truth, so nothing is found there. Then it is aligned by
// another file of the trajectory.
TEST_F(EvaluateObjects, TheTrajectoryOfTrueBodiesCanBeGiven) {
  const auto found = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"objects", run_, "--truth", truth_file_, "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = RunProgram("hullslam evaluate", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return nlohmann::json::parse(result.output)["truth"]["boxes"]["25"]["right"];
  };
  EXPECT_EQ(found({"--given-poses"}), 0);
  EXPECT_EQ(found({"--align", "none"}), 0);
  const std::string moved = folder_.path() / "poses.txt";
  std::filesystem::rename(folder_.path() / "groundtruth.txt", moved);
  EXPECT_EQ(found({"--groundtruth", moved}), 1);
  EXPECT_EQ(found({"--groundtruth", moved, "--min-masks", "0"}), 1);
  ExpectRefusal({"objects", run_, "--truth", truth_file_, "--align", "se3"}, "summary.json");
}

TEST_F(EvaluateObjects, TheUprightBoxesCanBeMeasured) {
  Scene scene;
  SceneObject object;
  object.id = ObjectId(3);
  object.label = "cup";
  object.ellipsoid = report_.objects[0].ellipsoid;
  object.shares = {{"cup", 1.0}};
  object.box = UprightBox{object.ellipsoid.world_from_object, {0.1, 0.1, 0.2}};
  scene.objects = {object};
  folder_.Write("run/scene.json", FormatScene(scene));
  const ProgramResult result = RunProgram(
      "hullslam evaluate", {"objects", run_, "--truth", truth_file_, "--upright", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto each = nlohmann::json::parse(result.output)["truth"]["each"];
  EXPECT_NEAR(each[0]["sorted_axes"][0].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(each[0]["sorted_axes"][1].get<double>(), 0.0, 1e-6);
}

TEST_F(EvaluateObjects, TrueBodiesThatMatchNothingAreSaid) {
  const std::string other =
      folder_.Write("other.json", R"({"objects": [{"id": 1, "class": "Cup", "kind": "box",
          "world_from_object": [0, 0, 2, 0, 0, 0, 1], "half_axes": [0.1, 0.1, 0.1]}]})");
  ProgramResult result = RunProgram("hullslam evaluate",
                                    {"objects", run_, "--truth", other, "--given-poses", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("other.json: has no class of a mapped object"), std::string::npos);
  auto truth = nlohmann::json::parse(result.output)["truth"];
  EXPECT_EQ(truth["boxes"]["50"]["ar"], 1.0);
  EXPECT_EQ(truth["boxes_of_class"]["50"]["ar"], 0.0);
  report_.objects.clear();
  WriteRun();
  result = RunProgram("hullslam evaluate",
                      {"objects", run_, "--truth", other, "--given-poses", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("has no mapped objects"), std::string::npos) << result.errors;
  truth = nlohmann::json::parse(result.output)["truth"];
  EXPECT_EQ(truth["boxes"]["25"]["ap"], 0.0);
  EXPECT_TRUE(truth["boxes"]["25"]["precision"].is_null());
}

TEST_F(EvaluateObjects, BadInputIsRefusedWithOneLine) {
  ExpectRefusal({"objects", run_, "--align", "none"}, "need --truth FILE");
  ExpectRefusal({"objects", run_, "--truth", folder_.path() / "none.json"}, "none.json");
  ExpectRefusal({"objects", run_, "--truth", folder_.Write("empty.json", R"({"objects": []})")},
                "empty.json: has no object");
  ExpectRefusal({"objects", run_, "--truth", truth_file_, "--groundtruth", truth_file_},
                "groundtruth_objects.json");
  ExpectRefusal({"objects"}, "RUN_DIR");
  ExpectRefusal({"objects", folder_.path() / "none"}, "objects.json: No such file");
  ExpectRefusal({"objects", run_, "--min-masks", "-1"}, "--min-masks");
  ExpectRefusal({"objects", run_, "--groundtruth", folder_.path() / "none.json"}, "none.json");
  folder_.Write("masks/7.txt", "41 0.4 nan 0.5 0.4 0.5 0.5 1\n");
  ExpectRefusal({"objects", run_, "--groundtruth", truth_file_}, "7.txt:1");
  folder_.Write("run/trajectory.txt", "900 0 0 0 0 0 0 1\n");
  ExpectRefusal({"objects", run_, "--groundtruth", truth_file_}, "run/trajectory.txt: no pose");
  folder_.Write("run/summary.json", R"({"trajectory": {"alignment": "left"}})");
  ExpectRefusal({"objects", run_}, "run/summary.json: trajectory.alignment is \"left\"");
  folder_.Write("run/objects.json", "{\"version\": 2}");
  ExpectRefusal({"objects", run_}, "objects.json: \"sequence\" is missing");
}

TEST_F(Evaluate, HelpIsNoError) {
  const ProgramResult result = RunProgram("hullslam evaluate", {"trajectory", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("--max-diff"), std::string::npos);
}

TEST(EvaluateData, PrintsAGoldenValue) {
  const auto truth = FindTestData("fr1_xyz/groundtruth.txt");
  const auto estimate = FindTestData("golden/freiburg1_xyz-rgbdslam.txt");
  if (!truth || !estimate) {
    GTEST_SKIP() << "the golden trajectories are not on this machine; set HULLSLAM_DATA";
  }
  const ProgramResult result = RunProgram("hullslam evaluate", {"trajectory", *truth, *estimate});
  EXPECT_NE(result.output.find("rmse 0.013473"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("786 (tum's rule"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace hullslam
