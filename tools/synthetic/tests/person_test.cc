// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/person.h"

#include <gtest/gtest.h>

#include "synthetic/tests/concavity.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

TEST(MakePerson, IsAsTallAsAPersonAndConcave) {
  const SceneObject person = MakePerson({}, {}, {}).Build(Vector3d::Zero(), 0.0);
  EXPECT_EQ(person.class_id, 0);
  EXPECT_NEAR(2.0 * person.half_extents.z(), 1.75, 0.01);
  EXPECT_LT(2.0 * person.half_extents.x(), 0.7);
  EXPECT_GT(Concavity(person), 0.2);
}

TEST(StrollPath, WalksWithTwoStopsOnACircle) {
  const StrollPath path;
  int stops = 0;
  bool stands = false;
  for (double time = 0.0; time < path.duration - 0.1; time += 1.0 / 30.0) {
    const Vector3d here = path.WorldFromPerson(time, 0.87).translation;
    const double step =
        (path.WorldFromPerson(time + 1.0 / 30.0, 0.87).translation - here).head<2>().norm();
    EXPECT_NEAR(here.head<2>().norm(), path.radius, 1e-9);
    EXPECT_LT(step * 30.0, 1.5) << "metres per second at " << time;
    stops += !stands && step == 0.0 ? 1 : 0;
    stands = step == 0.0;
  }
  EXPECT_EQ(stops, 2);
  EXPECT_EQ(path.WorldFromPerson(path.duration, 0.87).translation,
            path.WorldFromPerson(path.duration + 5.0, 0.87).translation);
}

TEST(StrollPath, ThePersonFacesItsWayAndStandsOnTheFloor) {
  for (const double swept : {-2.6, 2.6}) {
    const StrollPath path{.swept_angle = swept};
    const Rigid3 pose = path.WorldFromPerson(1.5, 0.87);
    const Vector3d way =
        (path.WorldFromPerson(1.51, 0.87).translation - pose.translation).normalized();
    const Vector3d front = pose.rotation * Vector3d(0.0, -1.0, 0.0);
    EXPECT_GT(front.head<2>().dot(way.head<2>()), 0.99) << swept;
    EXPECT_NEAR(pose.translation.z(), 0.88, 0.011);
  }
}

}  // namespace
}  // namespace hullslam::synthetic
