// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/up_direction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "objects/made_objects.h"

namespace hullslam {
namespace {

// A camera that moves half around the origin and looks down at it. The world has z upwards.
Trajectory LookingDown() {
  Trajectory poses;
  for (int i = 0; i < 20; ++i) {
    poses.push_back({100.0 + i * 0.05, Inverse(CameraOnCircle(0.15 * i, 2.0, 1.2))});
  }
  return poses;
}

// The same poses in a world that is turned by `turn`.
Trajectory Turned(Trajectory poses, const Eigen::Quaterniond& turn) {
  for (StampedPose& pose : poses) {
    pose.world_from_cam = Rigid3(turn, Eigen::Vector3d(1.0, 2.0, 3.0)) * pose.world_from_cam;
  }
  return poses;
}

const Eigen::Quaterniond kTurn = ExpSo3({0.7, -1.1, 0.4});

TEST(UpFromGroundtruth, IsTheAxisOfTheGroundTruthInTheWorldOfTheMap) {
  const UpDirection found = UpFromGroundtruth(LookingDown(), Turned(LookingDown(), kTurn));
  ASSERT_TRUE(found.up);
  EXPECT_EQ(found.from, "ground truth");
  EXPECT_LT((*found.up - kTurn * Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(UpFromGroundtruth, MayBeAnyAxis) {
  const Eigen::Quaterniond y_up =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
  const UpDirection found = UpFromGroundtruth(Turned(LookingDown(), y_up), LookingDown());
  ASSERT_TRUE(found.up);
  EXPECT_LT((*found.up - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(UpFromGroundtruth, IsUnknownForOtherTimesOrOtherMotions) {
  Trajectory late = LookingDown();
  for (StampedPose& pose : late) {
    pose.timestamp += 1000.0;
  }
  EXPECT_FALSE(UpFromGroundtruth(LookingDown(), late).up);
  Trajectory random = LookingDown();
  for (size_t i = 0; i < random.size(); ++i) {
    random[i].world_from_cam.rotation = ExpSo3({1.0 * static_cast<double>(i), 0.3, 0.0});
  }
  EXPECT_FALSE(UpFromGroundtruth(LookingDown(), random).up);
  EXPECT_FALSE(UpFromGroundtruth({}, LookingDown()).up);
}

// Points of a floor and a table, and some that are anywhere, in the turned world.
std::vector<Eigen::Vector3d> PointsOfRoom() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 900; ++i) {
    const double x = number(random);
    const double y = number(random);
    const double z = number(random);
    const double height = i % 3 == 0 ? z : (i % 3 == 1 ? -0.7 : 0.1);
    points.push_back(kTurn * Eigen::Vector3d(2.0 * x, 2.0 * y, height + 0.003 * z));
  }
  return points;
}

TEST(UpFromPlanes, IsPerpendicularToTheFloor) {
  const UpDirection found = UpFromPlanes(PointsOfRoom(), Turned(LookingDown(), kTurn));
  ASSERT_TRUE(found.up) << found.from;
  EXPECT_EQ(found.from, "planes");
  EXPECT_GT(found.up->dot(kTurn * Eigen::Vector3d::UnitZ()), 0.9998);  // 1.1 degrees
}

TEST(UpFromPlanes, IsUnknownWithoutPlanes) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> number;
  std::vector<Eigen::Vector3d> cloud;
  for (int i = 0; i < 900; ++i) {
    const double x = number(random);
    const double y = number(random);
    cloud.emplace_back(x, y, number(random));
  }
  EXPECT_FALSE(UpFromPlanes(cloud, LookingDown()).up);
  EXPECT_FALSE(UpFromPlanes({}, LookingDown()).up);
}

TEST(FindUp, PrefersTheGroundTruth) {
  const Trajectory poses = Turned(LookingDown(), kTurn);
  EXPECT_EQ(FindUp(LookingDown(), poses, PointsOfRoom()).from, "ground truth");
  EXPECT_EQ(FindUp(std::nullopt, poses, PointsOfRoom()).from, "planes");
}

TEST(UpFromImages, IsUnknownIfTheCameraWasHeldInAllWays) {
  const auto up = UpFromImages(Trajectory(3, {0.0, Rigid3()}));
  ASSERT_TRUE(up);
  EXPECT_LT((*up + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_FALSE(UpFromImages({}));
  const Rigid3 turned(Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), Eigen::Vector3d::Zero());
  EXPECT_FALSE(UpFromImages({{0.0, Rigid3()}, {1.0, turned}}));
}

// The mean of the tops of cameras that are tilted to all sides by an angle is as long as its
// cosine, and a quarter is the least length: 75.5 degrees.
TEST(UpFromGroundtruth, NeedsACameraThatWasHeldUpright) {
  const auto tilted = [](double degrees) {
    const Eigen::Quaterniond top_is_z =
        Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
    Trajectory poses;
    for (int i = 0; i < 20; ++i) {
      const double turn = 0.1 * std::numbers::pi * i;
      const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0.0);
      const Eigen::Quaterniond tilt = ExpSo3(degrees * std::numbers::pi / 180.0 * axis);
      poses.push_back({0.05 * i, Rigid3(tilt * top_is_z, Eigen::Vector3d::Zero())});
    }
    return poses;
  };
  EXPECT_TRUE(UpFromGroundtruth(tilted(74.0), tilted(74.0)).up);
  const UpDirection found = UpFromGroundtruth(tilted(77.0), tilted(77.0));
  EXPECT_FALSE(found.up);
  EXPECT_NE(found.from.find("not held upright"), std::string::npos) << found.from;
}

TEST(UpFromPlanes, SaysWhyItIsUnknown) {
  const Trajectory poses = Turned(LookingDown(), kTurn);
  std::vector<Eigen::Vector3d> few = PointsOfRoom();
  few.resize(99);
  EXPECT_NE(UpFromPlanes(few, poses).from.find("too few landmarks"), std::string::npos);
  Trajectory all_ways = poses;
  for (const StampedPose& pose : poses) {  // each image once more, upside down
    const Rigid3 turned(Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), Eigen::Vector3d::Zero());
    all_ways.push_back({pose.timestamp, pose.world_from_cam * turned});
  }
  EXPECT_NE(UpFromPlanes(PointsOfRoom(), all_ways).from.find("many ways"), std::string::npos);
}

}  // namespace
}  // namespace hullslam
