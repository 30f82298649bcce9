// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/for_triangulation.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "geometry/triangulation.h"
#include "matching/made_features.h"
#include "support/synthetic_world.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

const Eigen::Vector2d kFarEpipole(1e6, 1e6);

// Two cameras side by side: the epipolar line of a pixel is its row.
Eigen::Matrix3d SideBySide() {
  return EssentialFromPose({Eigen::Quaterniond::Identity(), {-1.0, 0.0, 0.0}});
}

std::vector<Match> MatchAll(const FrameFeatures& a, const FrameFeatures& b,
                            const Eigen::Matrix3d& fundamental,
                            const Eigen::Vector2d& epipole = kFarEpipole,
                            const PinholeCamera& camera = {},
                            const TriangulationSearch& search = {}) {
  return MatchForTriangulation(a, All(a), b, All(b), fundamental, epipole,
                               ScaleLevels::Create(8, 1.2), camera, search);
}

// The keypoint of b that matches the keypoint of a at (300, 100), whose descriptor is zero; -1 if
// there is none.
int FoundOnLine(const std::vector<MadeKeypoint>& b, const TriangulationSearch& search = {}) {
  const auto matches = MatchAll(MakeFeatures({{.pixel = {300.0f, 100.0f}}}), MakeFeatures(b),
                                SideBySide(), kFarEpipole, PinholeCamera(), search);
  return matches.empty() ? -1 : static_cast<int>(matches[0].keypoint);
}

TEST(MatchForTriangulation, TakesTheMostSimilarDescriptorOnTheLine) {
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 100.0f}, .bits = 20},
                         {.pixel = {200.0f, 101.0f}, .bits = 10},
                         {.pixel = {200.0f, 103.0f}, .bits = 0}}),
            1);
}

TEST(MatchForTriangulation, TheLimitOfTheDistanceIsInclusive) {
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 100.0f}, .bits = 50}}), 0);
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 100.0f}, .bits = 51}}), -1);
}

// sqrt(3.84) is 1.96 standard deviations.
TEST(MatchForTriangulation, DistanceToTheLineIsInSigmasOfTheLevel) {
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 101.9f}}}), 0);
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 102.0f}}}), -1);
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 98.1f}}}), 0);
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 102.0f}, .level = 1}}), 0);
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 102.4f}, .level = 1}}), -1);
  EXPECT_EQ(FoundOnLine({{.pixel = {100.0f, 103.0f}}}, {.max_epipolar_chi2 = 9.1}), 0);
}

TEST(MatchForTriangulation, WithoutDepthLeavesOutKeypointsNearTheEpipole) {
  const Eigen::Vector2d epipole(305.0, 100.0);
  const auto count = [&](float depth_of_a, const MadeKeypoint& b) {
    const FrameFeatures a = MakeFeatures({{.pixel = {300.0f, 100.0f}, .depth = depth_of_a}});
    return MatchAll(a, MakeFeatures({b}), SideBySide(), epipole).size();
  };
  EXPECT_EQ(count(0.0f, {.pixel = {296.0f, 100.0f}}), 0u);
  EXPECT_EQ(count(0.0f, {.pixel = {294.0f, 100.0f}}), 1u);
  EXPECT_EQ(count(0.0f, {.pixel = {296.0f, 100.0f}, .depth = 2.0f}), 1u);
  EXPECT_EQ(count(2.0f, {.pixel = {296.0f, 100.0f}}), 1u);
}

// A keypoint at level 5 is 2.49 times less precise than one at level 0.
TEST(MatchForTriangulation, TheDistanceToTheEpipoleGrowsWithTheScale) {
  const auto count = [](float x) {
    return MatchAll(MakeFeatures({{.pixel = {300.0f, 100.0f}}}),
                    MakeFeatures({{.pixel = {x, 100.0f}, .level = 5}}), SideBySide(),
                    Eigen::Vector2d(305.0, 100.0))
        .size();
  };
  EXPECT_EQ(count(305.0f - 24.8f), 0u);
  EXPECT_EQ(count(305.0f - 25.0f), 1u);
}

TEST(MatchForTriangulation, AKeypointIsMatchedToTheMostSimilarQuery) {
  const FrameFeatures a = MakeFeatures({{.pixel = {300.0f, 100.0f}, .bits = 8},
                                        {.pixel = {310.0f, 100.0f}, .bits = 2},
                                        {.pixel = {320.0f, 100.0f}, .bits = 2}});
  const auto matches = MatchAll(a, MakeFeatures({{.pixel = {200.0f, 100.0f}}}), SideBySide());
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 1u);
  EXPECT_EQ(matches[0].distance, 2);
}

TEST(MatchForTriangulation, SearchesOnlyTheGivenIndices) {
  const FrameFeatures a = MakeFeatures({{.pixel = {300.0f, 100.0f}}, {.pixel = {300.0f, 200.0f}}});
  const FrameFeatures b = MakeFeatures({{.pixel = {200.0f, 100.0f}, .bits = 0},
                                        {.pixel = {210.0f, 100.0f}, .bits = 9},
                                        {.pixel = {200.0f, 200.0f}, .bits = 0}});
  const std::vector<uint32_t> a_indices = {0};
  const std::vector<uint32_t> b_indices = {1, 2};
  const auto matches = MatchForTriangulation(a, a_indices, b, b_indices, SideBySide(), kFarEpipole,
                                             ScaleLevels::Create(8, 1.2), PinholeCamera());
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].query, 0u);
  EXPECT_EQ(matches[0].keypoint, 1u);
}

// Without a baseline there is no epipolar line, and nothing can be triangulated.
TEST(MatchForTriangulation, WithoutABaselineThereAreNoMatches) {
  const FrameFeatures features = MakeFeatures({{.pixel = {300.0f, 100.0f}}});
  EXPECT_TRUE(MatchAll(features, features, Eigen::Matrix3d::Zero()).empty());
}

class MatchForTriangulationWith : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(MatchForTriangulationWith);

TEST_P(MatchForTriangulationWith, FindsAllAndOnlyTrueMatchesInTwoViews) {
  const SyntheticWorld world({.pixel_noise = 0.7, .depth_share = 0.0, .flipped_bits = 10},
                             GetParam().sensor);
  const PinholeCamera& camera = world.sensor().camera;
  const SyntheticView a = world.Observe(0);
  const SyntheticView b = world.Observe(20);
  const Eigen::Matrix3d k = camera.Matrix();
  const Rigid3 b_from_a =
      SyntheticWorld::CamFromWorld(20) * Inverse(SyntheticWorld::CamFromWorld(0));
  const auto matches = MatchAll(a.frame->features, b.frame->features,
                                FundamentalFromPose(b_from_a, k, k), kFarEpipole, camera);
  EXPECT_GT(matches.size(), 200u);
  for (const Match& match : matches) {
    EXPECT_EQ(a.points[match.query], b.points[match.keypoint]);
  }
}

TEST(MatchForTriangulation, EmptyInputGivesNoMatches) {
  EXPECT_TRUE(MatchAll(MakeFeatures({}), MakeFeatures({}), SideBySide()).empty());
}

// 1.9 raw px from the line at the rim of a fisheye are many undistorted ones.
TEST(MatchForTriangulation, DistancesAreThoseOfTheRawImageWithAFisheye) {
  const PinholeCamera camera = FisheyeCamera();
  const Eigen::Vector2d on_line = camera.Project({3.0, 0.5, 1.0});
  const auto count = [&](double raw_offset) {
    const Eigen::Vector2d raw = camera.Distort(on_line) + Eigen::Vector2d(0.0, raw_offset);
    const FrameFeatures a = MakeFeatures({{.pixel = {300.0f, static_cast<float>(on_line.y())}}});
    const FrameFeatures b = MakeFeatures({{.pixel = camera.Undistort(raw).cast<float>()}});
    return MatchAll(a, b, SideBySide(), kFarEpipole, camera).size();
  };
  EXPECT_EQ(count(0.0), 1u);
  // The line of this row is slanted in the raw image.
  EXPECT_EQ(count(1.9), 1u);
  EXPECT_EQ(count(-1.9), 1u);
  EXPECT_EQ(count(3.5), 0u);
  EXPECT_EQ(count(-3.5), 0u);
}

TEST(MatchForTriangulation, TheDistanceToTheEpipoleIsThatOfTheRawImageWithAFisheye) {
  const PinholeCamera camera = FisheyeCamera();
  const auto count = [&](double x) {
    const Eigen::Vector2d pixel = camera.Project({x, 0.0, 1.0});
    const FrameFeatures a = MakeFeatures({{.pixel = {300.0f, static_cast<float>(pixel.y())}}});
    const FrameFeatures b = MakeFeatures({{.pixel = pixel.cast<float>()}});
    return MatchAll(a, b, SideBySide(), camera.Project({3.0, 0.0, 1.0}), camera).size();
  };
  EXPECT_EQ(count(2.8), 0u) << "49 undistorted px, but 5 raw px";
  EXPECT_EQ(count(1.5), 1u);
}

}  // namespace
}  // namespace hullslam
