// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/icl_office.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

TEST(IclOfficePath, StaysInTheMiddleOfTheRoomAndIsSlow) {
  for (int number = 0; number < 4; ++number) {
    const WaypointPath path = IclOfficePath(number);
    for (double time = 0.0; time < path.duration(); time += 0.1) {
      const Rigid3 pose = path.WorldFromCam(time);
      EXPECT_LT(std::abs(pose.translation.x()), 1.5) << number;
      EXPECT_LT(std::abs(pose.translation.y()), 1.3) << number;
      EXPECT_LT((path.WorldFromCam(time + 0.1).translation - pose.translation).norm(), 0.1);
    }
  }
  EXPECT_THROW(IclOfficePath(4), CheckError);
  EXPECT_THROW(IclOfficePath(-1), CheckError);
}

// The desks are at the walls at +x and +y; the others are plain.
TEST(IclOfficePath, OneAndThreeTurnToThePlainWalls) {
  for (int number = 0; number < 4; ++number) {
    const WaypointPath path = IclOfficePath(number);
    double plain = 0.0;
    double all = 0.0;
    for (double time = 0.0; time < path.duration(); time += 0.1) {
      const Eigen::Vector3d view = path.WorldFromCam(time).rotation * Eigen::Vector3d::UnitZ();
      plain += std::max(view.x(), view.y()) < 0.5 ? 1.0 : 0.0;
      all += 1.0;
    }
    EXPECT_EQ(plain / all > 0.3, number % 2 == 1) << number << ": " << plain / all;
    EXPECT_LT(plain / all, number % 2 == 1 ? 0.8 : 0.01) << number;
  }
}

TEST(FurnishIclOffice, IsFurnished) {
  SceneBuilder builder(1);
  FurnishIclOffice(builder);
  EXPECT_GE(builder.Finish().objects.size(), 15U);
}

}  // namespace
}  // namespace hullslam::synthetic
