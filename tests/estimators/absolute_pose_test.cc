// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/absolute_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

const PinholeCamera kCamera = SyntheticSensor().camera;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PointMeasurement Measure(const Eigen::Vector3d& pixel_and_disparity, bool has_depth) {
  return PointMeasurement::Create(pixel_and_disparity.head<2>(), 1.0,
                                  has_depth ? std::optional(pixel_and_disparity.z()) : std::nullopt,
                                  {.pixel_sigma = 1.0});
}

// Matches of random points. The first ones, a share of `outliers`, are wrong: they have a random
// pixel.
class Matches {
 public:
  explicit Matches(uint32_t seed) : random_(seed), pose_(random_.Pose(2.0, 5.0)) {}

  std::vector<PoseObservation> Make(size_t count, double outliers, double noise, bool has_depth) {
    std::vector<PoseObservation> matches;
    for (size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d in_cam(random_.Number(-1.5, 1.5), random_.Number(-1.2, 1.2),
                                   random_.Number(2.0, 6.0));
      Eigen::Vector3d measured =
          ProjectRgbd(kCamera, in_cam) + noise * Eigen::Vector3d(Normal(), Normal(), Normal());
      if (static_cast<double>(i) < outliers * static_cast<double>(count)) {
        measured = RandomPixel();
      }
      matches.push_back({Inverse(pose_) * in_cam, Measure(measured, has_depth)});
    }
    return matches;
  }
  Eigen::Vector3d RandomPixel() {
    const double u = random_.Number(0.0, 640.0);
    const double v = random_.Number(0.0, 480.0);
    return {u, v, random_.Number(5.0, 25.0)};
  }
  double Normal() { return std::normal_distribution<double>()(generator_); }

  RandomGeometry& random() { return random_; }
  const Rigid3& pose() const { return pose_; }

 private:
  RandomGeometry random_;
  std::mt19937 generator_{7};
  Rigid3 pose_;
};

std::vector<size_t> Count(size_t from, size_t to) {
  std::vector<size_t> indices(to - from);
  std::iota(indices.begin(), indices.end(), from);
  return indices;
}

TEST(AbsolutePose, ExactMatchesGiveTheExactPose) {
  for (const bool has_depth : {false, true}) {
    for (uint32_t seed = 0; seed < 50; ++seed) {
      Matches made(seed);
      const auto matches = made.Make(20, 0.0, 0.0, has_depth);
      const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {.seed = seed});
      ASSERT_TRUE(result.ok()) << result.failure;
      EXPECT_LT(Distance(result.cam_from_world, made.pose()), 1e-9);
      EXPECT_EQ(result.inliers, Count(0, 20));
      EXPECT_NEAR(result.score, 20.0, 1e-9);
      EXPECT_LE(result.iterations, 2);
    }
  }
}

TEST(AbsolutePose, FindsThePoseAmongSeventyPercentOfOutliers) {
  for (const bool has_depth : {false, true}) {
    for (uint32_t seed = 0; seed < 100; ++seed) {
      Matches made(seed);
      const auto matches = made.Make(100, 0.7, 1.0, has_depth);
      const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {.seed = seed});
      ASSERT_TRUE(result.ok()) << seed << ": " << result.failure;
      EXPECT_LT(Distance(result.cam_from_world, made.pose()), 0.1) << seed;
      // The bound leaves out one inlier of twenty.
      EXPECT_GE(result.inliers.size(), 22u);
      EXPECT_GE(result.inliers[1], 70u);
    }
  }
}

TEST(AbsolutePose, RandomMatchesGiveNoPose) {
  for (const bool has_depth : {false, true}) {
    size_t most = 0;
    for (uint32_t seed = 0; seed < 200; ++seed) {
      Matches made(seed);
      const auto matches = made.Make(100, 1.0, 0.0, has_depth);
      const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {.seed = seed});
      EXPECT_FALSE(result.ok());
      EXPECT_NE(result.failure.find("of 100 matches agree"), std::string::npos);
      most = std::max(most, result.inliers.size());
    }
    // Far from the ten that are needed.
    EXPECT_LE(most, 7u);
  }
}

TEST(AbsolutePose, DoesNotDependOnTheWorldFrame) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    Matches made(seed);
    auto matches = made.Make(80, 0.5, 0.5, true);
    const AbsolutePose before = EstimateAbsolutePose(kCamera, matches, {.seed = seed});
    const Rigid3 new_from_old = made.random().Pose(2.0, 20.0);
    for (PoseObservation& match : matches) {
      match.point = new_from_old * match.point;
    }
    const AbsolutePose after = EstimateAbsolutePose(kCamera, matches, {.seed = seed});
    EXPECT_EQ(after.inliers, before.inliers);
    EXPECT_LT(Distance(after.cam_from_world * new_from_old, before.cam_from_world), 1e-4);
  }
}

// Another order gives other samples, but the same pose, because it is fitted to the same inliers.
TEST(AbsolutePose, TheOrderOfTheMatchesHardlyMatters) {
  Matches made(3);
  auto matches = made.Make(100, 0.5, 0.5, false);
  const AbsolutePose before = EstimateAbsolutePose(kCamera, matches, {.seed = 1});
  std::reverse(matches.begin(), matches.end());
  AbsolutePose after = EstimateAbsolutePose(kCamera, matches, {.seed = 1});
  EXPECT_LT(Distance(after.cam_from_world, before.cam_from_world), 1e-3);
  for (size_t& index : after.inliers) {
    index = matches.size() - 1 - index;
  }
  std::reverse(after.inliers.begin(), after.inliers.end());
  EXPECT_EQ(after.inliers, before.inliers);
}

TEST(AbsolutePose, SameSeedGivesTheSameBits) {
  Matches made(4);
  const auto matches = made.Make(100, 0.6, 1.0, true);
  const AbsolutePose first = EstimateAbsolutePose(kCamera, matches, {.seed = 9});
  const AbsolutePose second = EstimateAbsolutePose(kCamera, matches, {.seed = 9});
  EXPECT_EQ(first.cam_from_world.rotation.coeffs(), second.cam_from_world.rotation.coeffs());
  EXPECT_EQ(first.cam_from_world.translation, second.cam_from_world.translation);
  EXPECT_EQ(first.inliers, second.inliers);
  EXPECT_EQ(first.score, second.score);
  EXPECT_EQ(first.iterations, second.iterations);
}

TEST(AbsolutePose, AWrongDepthAloneMakesAnOutlier) {
  Matches made(5);
  auto matches = made.Make(30, 0.0, 0.0, true);
  matches[4].measurement.measured.z() += 5.0;
  matches[6].measurement.measured.z() += 5.0;
  matches[6].measurement.inverse_sigma.z() = 0.0;  // its depth is unknown
  const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {});
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.inliers.size(), 29u);
  EXPECT_EQ(std::count(result.inliers.begin(), result.inliers.end(), 4u), 0);
}

TEST(AbsolutePose, ErrorsAreMeasuredInSigmas) {
  Matches made(6);
  auto matches = made.Make(60, 0.0, 0.0, false);
  matches[3].measurement.measured.x() += 4.0;
  matches[5].measurement.measured.x() += 4.0;
  matches[5].measurement.inverse_sigma *= 0.5;
  const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {});
  EXPECT_EQ(std::count(result.inliers.begin(), result.inliers.end(), 3u), 0);
  EXPECT_EQ(std::count(result.inliers.begin(), result.inliers.end(), 5u), 1);
}

TEST(AbsolutePose, SkipsMatchesThatAreNotFinite) {
  Matches made(7);
  auto matches = made.Make(24, 0.0, 0.0, true);
  matches[0].point.x() = kNan;
  matches[5].measurement.measured.y() = kNan;
  matches[9].measurement.inverse_sigma.x() = 0.0;
  matches[23].point.z() = std::numeric_limits<double>::infinity();
  const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {});
  ASSERT_TRUE(result.ok());
  EXPECT_LT(Distance(result.cam_from_world, made.pose()), 1e-9);
  EXPECT_EQ(result.inliers.size(), 20u);
  EXPECT_EQ(result.inliers.front(), 1u);
  EXPECT_EQ(result.inliers.back(), 22u);
  for (PoseObservation& match : matches) {
    match.point.x() = kNan;
  }
  EXPECT_EQ(EstimateAbsolutePose(kCamera, matches, {}).failure,
            "there are only 0 usable matches, expected at least 10");
}

TEST(AbsolutePose, PointsBehindTheCameraAreOutliers) {
  Matches made(8);
  auto matches = made.Make(30, 0.0, 0.0, false);
  // Points that are mirrored at the camera's centre have the same pixels.
  for (size_t i = 0; i < 10; ++i) {
    matches[i].point = Inverse(made.pose()) * Eigen::Vector3d(-(made.pose() * matches[i].point));
  }
  const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {});
  ASSERT_TRUE(result.ok());
  EXPECT_LT(Distance(result.cam_from_world, made.pose()), 1e-9);
  EXPECT_EQ(result.inliers, Count(10, 30));
}

TEST(AbsolutePose, FewMatchesAreAFailure) {
  Matches made(9);
  const auto matches = made.Make(12, 0.0, 0.0, false);
  for (const size_t count : {0, 1, 2, 3, 9}) {
    const AbsolutePose result = EstimateAbsolutePose(kCamera, std::span(matches).first(count), {});
    EXPECT_NE(result.failure.find("there are only " + std::to_string(count)), std::string::npos);
  }
  EXPECT_TRUE(EstimateAbsolutePose(kCamera, std::span(matches).first(4), {.min_inliers = 4}).ok());
}

TEST(AbsolutePose, DegeneratePointsAreAFailure) {
  Matches made(10);
  const auto points = made.Make(40, 0.0, 0.0, false);
  auto equal = points;
  std::fill(equal.begin(), equal.end(), points[0]);
  EXPECT_EQ(EstimateAbsolutePose(kCamera, equal, {}).failure,
            "no sample of the matches determines a model");
  auto line = points;
  for (size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d in_cam(-1.0 + 0.05 * static_cast<double>(i), 0.1,
                                 3.0 + 0.02 * static_cast<double>(i));
    line[i] = {Inverse(made.pose()) * in_cam, Measure(ProjectRgbd(kCamera, in_cam), false)};
  }
  EXPECT_EQ(EstimateAbsolutePose(kCamera, line, {}).failure,
            "no sample of the matches determines a model");
  // One wrong match beside the line makes all of them agree on a wrong rotation.
  line[7] = points[7];
  line[7].measurement.measured += Eigen::Vector3d(20.0, 10.0, 0.0);
  EXPECT_EQ(EstimateAbsolutePose(kCamera, line, {}).failure,
            "the matches do not determine the rotation: nearly all points are on one line");
  // Several right matches beside the line determine the rotation.
  std::copy(points.begin(), points.begin() + 4, line.begin() + 7);
  const AbsolutePose result = EstimateAbsolutePose(kCamera, line, {});
  ASSERT_TRUE(result.ok()) << result.failure;
  EXPECT_LT(Distance(result.cam_from_world, made.pose()), 1e-6);
}

TEST(AbsolutePose, PointsInAPlaneAreEnough) {
  Matches made(11);
  std::vector<PoseObservation> matches;
  for (int i = 0; i < 30; ++i) {
    const double x = made.random().Number(-1.0, 1.0);
    const double y = made.random().Number(-1.0, 1.0);
    const Eigen::Vector3d in_cam(x, y, 3.0 + 0.3 * x);
    matches.push_back(
        {Inverse(made.pose()) * in_cam, Measure(ProjectRgbd(kCamera, in_cam), false)});
  }
  const AbsolutePose result = EstimateAbsolutePose(kCamera, matches, {});
  ASSERT_TRUE(result.ok()) << result.failure;
  EXPECT_LT(Distance(result.cam_from_world, made.pose()), 1e-8);
}

}  // namespace
}  // namespace hullslam
