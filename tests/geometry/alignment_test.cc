// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/alignment.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;

Points3 RandomPoints(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Points3 points(count);
  for (Eigen::Vector3d& point : points) {
    point = {normal(generator), normal(generator), normal(generator)};
  }
  return points;
}

double SquaredError(const PointAlignment& alignment, const Points3& source, const Points3& target) {
  double sum = 0.0;
  for (size_t i = 0; i < source.size(); ++i) {
    sum += (alignment * source[i] - target[i]).squaredNorm();
  }
  return sum;
}

PointAlignment Similarity(double scale, const Eigen::Vector3d& turn, const Eigen::Vector3d& shift) {
  PointAlignment alignment;
  alignment.scale = scale;
  alignment.target_from_source = {ExpSo3(turn), shift};
  return alignment;
}

Points3 Apply(const PointAlignment& alignment, const Points3& points) {
  Points3 moved;
  for (const Eigen::Vector3d& point : points) {
    moved.push_back(alignment * point);
  }
  return moved;
}

TEST(Alignment, RecoversARigidMotion) {
  const PointAlignment truth = Similarity(1.0, {0.3, -2.0, 1.0}, {5.0, -1.0, 100.0});
  const Points3 source = RandomPoints(20, 1);
  for (const AlignmentKind kind : {AlignmentKind::kSe3, AlignmentKind::kSim3}) {
    const PointAlignment found = AlignPoints(source, Apply(truth, source), kind);
    ASSERT_TRUE(found.ok()) << found.failure;
    EXPECT_NEAR(found.scale, 1.0, 1e-12);
    EXPECT_LT(AngularDistance(found.target_from_source.rotation, truth.target_from_source.rotation),
              1e-7);
    EXPECT_LT(SquaredError(found, source, Apply(truth, source)), 1e-20);
  }
}

TEST(Alignment, RecoversTheScaleOnlyForSim3) {
  const PointAlignment truth = Similarity(2.5, {0.1, 0.2, -0.3}, {1.0, 2.0, 3.0});
  const Points3 source = RandomPoints(20, 2);
  const Points3 target = Apply(truth, source);
  EXPECT_NEAR(AlignPoints(source, target, AlignmentKind::kSim3).scale, 2.5, 1e-12);
  EXPECT_EQ(AlignPoints(source, target, AlignmentKind::kSe3).scale, 1.0);
}

TEST(Alignment, NeverMirrors) {
  const Points3 source = RandomPoints(10, 3);
  Points3 mirrored = source;
  for (Eigen::Vector3d& point : mirrored) {
    point.x() = -point.x();
  }
  const PointAlignment found = AlignPoints(source, mirrored, AlignmentKind::kSe3);
  ASSERT_TRUE(found.ok());
  EXPECT_NEAR(found.target_from_source.rotation.toRotationMatrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(SquaredError(found, source, mirrored), 0.1);
}

TEST(Alignment, NoSmallChangeIsBetter) {
  const Points3 source = RandomPoints(30, 4);
  const Points3 target = RandomPoints(30, 5);
  const PointAlignment best = AlignPoints(source, target, AlignmentKind::kSim3);
  const double least = SquaredError(best, source, target);
  for (int i = 0; i < 6; ++i) {
    for (const double step : {-1e-3, 1e-3}) {
      PointAlignment changed = best;
      changed.target_from_source =
          Retract(best.target_from_source, step * Eigen::Matrix<double, 6, 1>::Unit(i));
      EXPECT_GT(SquaredError(changed, source, target), least) << i;
      changed = best;
      changed.scale += step;
      EXPECT_GT(SquaredError(changed, source, target), least);
    }
  }
}

TEST(Alignment, NoneLeavesThePointsWhereTheyAre) {
  const Points3 source = RandomPoints(1, 6);
  const PointAlignment found = AlignPoints(source, source, AlignmentKind::kNone);
  EXPECT_TRUE(found.ok());
  EXPECT_EQ(found * source[0], source[0]);
}

TEST(Alignment, PointsOnALineAreAlignedWithoutError) {
  const Points3 source = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0}};
  const Points3 target = {{5, 0, 0}, {5, 1, 0}, {5, 3, 0}, {5, 4, 0}};
  const PointAlignment found = AlignPoints(source, target, AlignmentKind::kSim3);
  ASSERT_TRUE(found.ok());
  EXPECT_LT(SquaredError(found, source, target), 1e-20);
}

TEST(Alignment, FailsWithAReason) {
  const Points3 two = RandomPoints(2, 7);
  const PointAlignment few = AlignPoints(two, two, AlignmentKind::kSe3);
  EXPECT_FALSE(few.ok());
  EXPECT_NE(few.failure.find("at least 3 pairs, there are 2"), std::string::npos);
  const Points3 same(5, Eigen::Vector3d(1.0, 2.0, 3.0));
  const Points3 spread = RandomPoints(5, 8);
  EXPECT_FALSE(AlignPoints(same, spread, AlignmentKind::kSim3).ok());
  EXPECT_FALSE(AlignPoints(spread, same, AlignmentKind::kSim3).ok());
  EXPECT_TRUE(AlignPoints(same, spread, AlignmentKind::kSe3).ok());
  EXPECT_THROW(AlignPoints(two, spread, AlignmentKind::kSe3), CheckError);
}

// ---- Poses

std::vector<Rigid3> RandomPoses(int count, unsigned seed) {
  const Points3 values = RandomPoints(2 * count, seed);
  std::vector<Rigid3> poses;
  for (size_t i = 0; i < values.size(); i += 2) {
    poses.emplace_back(ExpSo3(values[i]), values[i + 1]);
  }
  return poses;
}

std::vector<Rigid3> Apply(const Rigid3& motion, const std::vector<Rigid3>& poses) {
  std::vector<Rigid3> moved;
  for (const Rigid3& pose : poses) {
    moved.push_back(motion * pose);
  }
  return moved;
}

TEST(AlignPoses, RecoversAMotionEvenFromOnePose) {
  const Rigid3 truth(ExpSo3({0.3, -2.0, 1.0}), {5.0, -1.0, 100.0});
  for (const int count : {1, 2, 20}) {
    const std::vector<Rigid3> source = RandomPoses(count, 1);
    const Rigid3 found = AlignPoses(source, Apply(truth, source), 2.0);
    EXPECT_LT(AngularDistance(found.rotation, truth.rotation), 1e-7) << count;
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-9) << count;
  }
}

// Positions alone do not determine the rotation of a camera that moves by the noise only.
TEST(AlignPoses, OrientationsDetermineTheRotationOfAnAlmostStillCamera) {
  const Points3 noise = RandomPoints(30, 2);
  std::vector<Rigid3> source;
  for (const Eigen::Vector3d& error : noise) {
    source.emplace_back(Eigen::Quaterniond::Identity(), 1e-3 * error);
  }
  const std::vector<Rigid3> target(source.size());
  EXPECT_LT(
      AngularDistance(AlignPoses(source, target, 1.0).rotation, Eigen::Quaterniond::Identity()),
      1e-3);
}

// With a short lever positions count more, with a long one orientations.
TEST(AlignPoses, TheLeverWeighsOrientationsAgainstPositions) {
  const std::vector<Rigid3> source = RandomPoses(10, 3);
  const Rigid3 of_positions(ExpSo3({0.0, 0.0, 0.2}), Eigen::Vector3d::Zero());
  std::vector<Rigid3> target = source;  // the orientations do not turn
  for (Rigid3& pose : target) {
    pose.translation = of_positions * pose.translation;
  }
  const auto angle = [&](double lever) {
    return AngularDistance(AlignPoses(source, target, lever).rotation,
                           Eigen::Quaterniond::Identity());
  };
  EXPECT_NEAR(angle(1e-3), 0.2, 1e-3);
  EXPECT_NEAR(angle(1e3), 0.0, 1e-3);
  EXPECT_GT(angle(0.5), angle(2.0));
}

TEST(AlignPoses, NothingToAlignIsRefused) {
  const std::vector<Rigid3> poses(2);
  EXPECT_THROW(AlignPoses({}, {}, 1.0), CheckError);
  EXPECT_THROW(AlignPoses(poses, RandomPoses(3, 1), 1.0), CheckError);
  EXPECT_THROW(AlignPoses(poses, poses, 0.0), CheckError);
}

}  // namespace
}  // namespace hullslam
