// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relocalisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include "objects/made_room.h"

namespace hullslam {
namespace {

TEST(ChooseQueries, EachFrameIsChosenAtMostOnceAndTheSeedDecides) {
  std::vector<size_t> frames(100);
  std::iota(frames.begin(), frames.end(), 50);
  const std::vector<size_t> chosen = ChooseQueries(frames, 20, 7);
  EXPECT_EQ(std::set<size_t>(chosen.begin(), chosen.end()).size(), 20U);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(ChooseQueries(frames, 20, 7), chosen);
  EXPECT_NE(ChooseQueries(frames, 20, 8), chosen);
  EXPECT_EQ(ChooseQueries(frames, 1000, 7), frames);
}

TEST(SummarizeQueries, SharesAreThoseOfAllQueries) {
  const auto found = [](RelocalisationMethod method, double error, double milliseconds) {
    QueryResult result{.found = RelocalisedPose(), .error = error, .milliseconds = milliseconds};
    result.found->method = method;
    return result;
  };
  const std::vector<QueryResult> results = {
      found(RelocalisationMethod::kWords, 0.01, 1.0),
      found(RelocalisationMethod::kWords, 0.07, 2.0),
      found(RelocalisationMethod::kObjects, 0.5, 9.0),
      QueryResult{.found = std::nullopt, .error = 0.0, .milliseconds = 4.0}};
  const std::vector<QuerySummary> lines = SummarizeQueries(results);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0].queries, 2U);
  EXPECT_EQ(lines[0].near_percent, 25.0);
  EXPECT_EQ(lines[0].far_percent, 50.0);
  EXPECT_EQ(lines[1].wrong, 1U);
  EXPECT_EQ(lines[2].name, "not found");
  EXPECT_EQ(lines[2].max_ms, 4.0);
  EXPECT_EQ(lines[3].queries, 4U);
  EXPECT_EQ(lines[3].max_ms, 9.0);
}

TEST(DescribeQueries, HasALineForEachOutcomeAndOneForEachAngle) {
  const RelocalisedPose pose;
  const std::vector<QueryResult> results = {
      {.found = std::nullopt, .view_angle = 3.0, .milliseconds = 4.0},
      {.found = pose, .error = 0.09, .turn_error = 4.0, .view_angle = 9.9},
      {.found = pose, .error = 0.09, .turn_error = 6.0, .view_angle = 31.0},
      {.found = pose, .error = 0.2, .turn_error = 1.0, .view_angle = 32.0},
      {.found = pose, .error = 0.01, .turn_error = 0.0, .view_angle = 33.0}};
  EXPECT_EQ(DescribeQuery(results[0]), "not found, 4.0 ms\n");
  const std::string text = DescribeQueries(results);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 8);
  EXPECT_TRUE(
      text.ends_with("\n  0 to  10        2    50.0 %     0.0 %\n"
                     " 30 to  40        3    33.3 %    66.7 %\n"))
      << text;
}

// A straight way says nothing of the turn about itself.
TEST(AlignWithRotations, TheRotationsDecideTheTurnAboutAStraightWay) {
  const Rigid3 truth_from_map(ExpSo3({0.7, 0.2, -0.1}), {1.0, 2.0, 3.0});
  constexpr double kScale = 2.0;
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 5; ++i) {
    const Rigid3 pose(ExpSo3({0.0, 0.1 * i, 0.0}), {0.1 * i, 0.0, 0.0});
    estimate.push_back({0.03 * i, pose});
    truth.push_back({0.03 * i, truth_from_map * Rigid3(pose.rotation, kScale * pose.translation)});
  }
  PointAlignment by_points;
  by_points.scale = kScale;
  const PointAlignment found = AlignWithRotations(truth, estimate, by_points);
  EXPECT_EQ(found.scale, kScale);
  EXPECT_LT((found.target_from_source.translation - truth_from_map.translation).norm(), 1e-9);
  EXPECT_LT(AngularDistance(found.target_from_source.rotation, truth_from_map.rotation), 1e-7);
}

TEST(Relocalise, ComparesTheFrameWithTheTruthAndTheViewsOfTheMap) {
  const Sensor sensor = MakeObjectSensor();
  const std::vector<MadeObject> room = MakeRoom();
  Map map;
  AddRoom(map, sensor, room);
  SystemOptions options;
  options.camera = sensor.camera;
  const Relocaliser relocaliser(options, std::make_shared<const Map>(map.Snapshot()));
  const Rigid3 cam_from_world = CameraOnCircle(0.4, 1.9, 0.7);
  constexpr double kTurn = 0.1;
  const Rigid3 wrong = Inverse(cam_from_world) * Rigid3(ExpSo3({0.0, kTurn, 0.0}), {0.3, 0.0, 0.0});
  const QueryResult result =
      Relocalise(relocaliser, map, SeeRoom(sensor, room, cam_from_world), PointAlignment(), wrong);
  ASSERT_TRUE(result.found);
  EXPECT_NEAR(result.error, 0.3, 0.02);
  EXPECT_NEAR(result.turn_error, kTurn * 180.0 / std::numbers::pi, 0.5);
  double nearest = 180.0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const double cosine = (keyframe.cam_from_world.rotation.conjugate() * Eigen::Vector3d(0, 0, 1))
                              .dot(wrong.rotation * Eigen::Vector3d(0, 0, 1));
    nearest = std::min(nearest, std::acos(cosine) * 180.0 / std::numbers::pi);
  }
  EXPECT_NEAR(result.view_angle, nearest, 1e-6);
}

}  // namespace
}  // namespace hullslam
