// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/p3p.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/pose_distance.h"
#include "support/random_geometry.h"

namespace hullslam {
namespace {

using Points = std::array<Eigen::Vector3d, 3>;

// Points in front of a camera, and their rays.
struct Seen {
  Rigid3 cam_from_world;
  Points rays;
  Points points;
};

Seen RandomView(RandomGeometry& random) {
  Seen seen;
  seen.cam_from_world = random.Pose(3.0, 10.0);
  for (size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d in_cam(random.Number(-2.0, 2.0), random.Number(-2.0, 2.0),
                                 random.Number(1.0, 6.0));
    seen.rays[i] = random.Number(0.1, 10.0) * in_cam;
    seen.points[i] = Inverse(seen.cam_from_world) * in_cam;
  }
  return seen;
}

double NearestDistance(const P3pPoses& poses, const Rigid3& pose) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < poses.count; ++i) {
    nearest = std::min(nearest, Distance(poses.cam_from_world[i], pose));
  }
  return nearest;
}

TEST(P3p, OneOfThePosesIsTheTrueOne) {
  RandomGeometry random(1);
  int missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const Seen seen = RandomView(random);
    missed += SpansTriangle(seen.points) &&
                      NearestDistance(SolveP3p(seen.rays, seen.points), seen.cam_from_world) > 1e-5
                  ? 1
                  : 0;
  }
  // Near a double solution, rounding may make it complex.
  EXPECT_LE(missed, 2);
}

TEST(P3p, AllPosesSeeThePointsAlongTheRays) {
  RandomGeometry random(2);
  size_t most = 0;
  for (int i = 0; i < 5000; ++i) {
    const Seen seen = RandomView(random);
    const P3pPoses poses = SolveP3p(seen.rays, seen.points);
    most = std::max(most, poses.count);
    for (size_t k = 0; k < poses.count; ++k) {
      const Rigid3& pose = poses.cam_from_world[k];
      EXPECT_NEAR(pose.rotation.norm(), 1.0, 1e-12);
      for (size_t p = 0; p < 3; ++p) {
        const Eigen::Vector3d direction = (pose * seen.points[p]).normalized();
        EXPECT_LT((direction - seen.rays[p].normalized()).norm(), 1e-5);
      }
    }
  }
  EXPECT_EQ(most, 4u);
}

// Seen from the tip of a pyramid over a triangle of equal sides, the four solutions are known: the
// tip, and three in which one corner is nearer (Fischler and Bolles 1981, figure 5).
TEST(P3p, FindsTheFourPosesOfARegularPyramid) {
  const double root3 = std::sqrt(3.0);
  const Points points = {Eigen::Vector3d(-root3, -1.0, 0.0), {root3, -1.0, 0.0}, {0.0, 2.0, 0.0}};
  // Distance 4 from all corners; the cosine between two rays is (16 + 16 - 12) / 32 = 5 / 8.
  const Rigid3 cam_from_world(Eigen::Quaterniond::Identity(), {0.0, 0.0, std::sqrt(12.0)});
  const Points rays = {cam_from_world * points[0], cam_from_world * points[1],
                       cam_from_world * points[2]};
  const P3pPoses poses = SolveP3p(rays, points);
  ASSERT_EQ(poses.count, 4u);
  int apex = 0;
  for (const Rigid3& pose : poses.cam_from_world) {
    Eigen::Vector3d distances((pose * points[0]).norm(), (pose * points[1]).norm(),
                              (pose * points[2]).norm());
    std::sort(distances.begin(), distances.end());
    EXPECT_NEAR(distances[1], 4.0, 1e-6);
    EXPECT_NEAR(distances[2], 4.0, 1e-6);
    // d^2 + 16 - 2 * 5 / 8 * 4 d = 12 has the solutions 4 and 1.
    apex += distances[0] > 2.0 ? 1 : 0;
    EXPECT_NEAR(distances[0], distances[0] > 2.0 ? 4.0 : 1.0, 1e-6);
  }
  EXPECT_EQ(apex, 1);
}

TEST(P3p, DoesNotDependOnTheWorldOrTheUnitOfLength) {
  RandomGeometry random(3);
  for (int i = 0; i < 200; ++i) {
    const Seen seen = RandomView(random);
    const P3pPoses poses = SolveP3p(seen.rays, seen.points);
    const Rigid3 new_from_old = random.Pose(3.0, 5.0);
    const double scale = random.Number(0.01, 100.0);
    Points moved;
    std::transform(seen.points.begin(), seen.points.end(), moved.begin(),
                   [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
                     return scale * (new_from_old * point);
                   });
    const P3pPoses moved_poses = SolveP3p(seen.rays, moved);
    Rigid3 expected = seen.cam_from_world * Inverse(new_from_old);
    expected.translation *= scale;
    if (NearestDistance(poses, seen.cam_from_world) < 1e-9) {
      EXPECT_LT(NearestDistance(moved_poses, expected), 1e-4 * std::max(1.0, scale));
    }
  }
}

TEST(P3p, HasNoPoseForDegenerateInput) {
  const Points rays = {Eigen::Vector3d(0.0, 0.0, 1.0), {0.1, 0.0, 1.0}, {0.0, 0.1, 1.0}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d point(1.0, 2.0, 3.0);
  EXPECT_EQ(SolveP3p(rays, {point, point, point}).count, 0u);
  EXPECT_EQ(SolveP3p(rays, {point, 2.0 * point, 3.0 * point}).count, 0u);
  EXPECT_EQ(SolveP3p(rays, {point, point, -point}).count, 0u);
  EXPECT_EQ(SolveP3p(rays, {point, {nan, 0.0, 0.0}, -point}).count, 0u);
  EXPECT_EQ(SolveP3p(rays, {point, {inf, 0.0, 0.0}, -point}).count, 0u);
  const Points triangle = {Eigen::Vector3d(0.0, 0.0, 0.0), {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  EXPECT_EQ(SolveP3p({rays[0], rays[0], rays[0]}, triangle).count, 0u);
  EXPECT_EQ(SolveP3p({rays[0], {nan, nan, 1.0}, rays[2]}, triangle).count, 0u);
}

TEST(SpansTriangle, ByTheHeightOverTheLongestSide) {
  const auto spans = [](double height) {
    return SpansTriangle(
        {Eigen::Vector3d(0.0, 0.0, 5.0), {0.0, 2.0, 5.0}, {0.0, 1.0, 5.0 + height}});
  };
  EXPECT_TRUE(spans(0.021));
  EXPECT_FALSE(spans(0.019));
  EXPECT_FALSE(spans(0.0));
}

}  // namespace
}  // namespace hullslam
