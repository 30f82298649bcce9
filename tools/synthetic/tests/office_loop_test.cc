// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/office_loop.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hullslam::synthetic {
namespace {

TEST(OfficeLoopPath, GoesAroundAndSeesTheStartAgain) {
  for (const double seconds : {10.0, 25.0}) {
    const OrbitPath path = OfficeLoopPath(seconds);
    const Rigid3 start = path.WorldFromCam(0.0);
    double nearest = 10.0;
    double farthest = 0.0;
    for (double share = 0.2; share <= 1.0; share += 0.01) {
      const Rigid3 motion = Inverse(start) * path.WorldFromCam(share * seconds);
      farthest = std::max(farthest, motion.translation.norm());
      if (share > 0.7) {
        nearest = std::min(nearest, motion.translation.norm() + LogSo3(motion.rotation).norm());
      }
    }
    EXPECT_LT(nearest, 0.45) << seconds;
    EXPECT_GT(farthest, 3.0) << seconds;
  }
}

// Nothing is in the way of the camera.
TEST(FurnishOfficeLoop, LeavesThePathFree) {
  SceneBuilder builder(1);
  FurnishOfficeLoop(builder);
  const OrbitPath path = OfficeLoopPath(10.0);
  for (const SceneObject& object : builder.Finish().objects) {
    for (double time = 0.0; time <= 10.0; time += 0.05) {
      const Eigen::Vector3d eye =
          Inverse(object.world_from_object) * path.WorldFromCam(time).translation;
      EXPECT_GT((eye.cwiseAbs() - object.half_extents).maxCoeff(), 0.25) << object.class_name;
    }
  }
}

}  // namespace
}  // namespace hullslam::synthetic
