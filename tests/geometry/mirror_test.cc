// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mirror.h"

#include <gtest/gtest.h>

#include "support/made_room.h"

namespace hullslam {
namespace {

// The pixel of a point in a camera whose y axis points up (fy < 0). Pose and point are those of its
// left-handed world.
Eigen::Vector2d PixelWithYUp(const PinholeCamera& camera, const Rigid3& world_from_cam,
                             const Eigen::Vector3d& point) {
  const Eigen::Vector3d seen = Inverse(world_from_cam) * point;
  return {camera.cx + camera.fx * seen.x() / seen.z(), camera.cy - camera.fy * seen.y() / seen.z()};
}

TEST(MirrorY, TheMirroredCameraSeesThePixelsInTheMirroredWorld) {
  const PinholeCamera camera = MadeRoom().camera();
  const Rigid3 pose(ExpSo3({0.3, -0.5, 0.2}), {0.4, -1.2, 2.0});
  for (const Eigen::Vector3d& seen :
       {Eigen::Vector3d(0.5, 0.3, 2.0), Eigen::Vector3d(-1.0, -0.7, 3.0)}) {
    const Eigen::Vector3d point = pose * seen;
    const Eigen::Vector3d mirrored(point.x(), -point.y(), point.z());
    const Eigen::Vector2d pixel = camera.Project(Inverse(MirrorY(pose)) * mirrored);
    EXPECT_LT((pixel - PixelWithYUp(camera, pose, point)).norm(), 1e-9);
  }
}

TEST(MirrorY, IsItsOwnInverseAndKeepsProducts) {
  const Rigid3 a(ExpSo3({0.3, -0.5, 0.2}), {0.4, -1.2, 2.0});
  const Rigid3 b(ExpSo3({-0.1, 0.4, 1.1}), {-2.0, 0.3, 0.1});
  EXPECT_TRUE(MirrorY(MirrorY(a)).ToMatrix().isApprox(a.ToMatrix(), 1e-12));
  EXPECT_TRUE(MirrorY(a * b).ToMatrix().isApprox((MirrorY(a) * MirrorY(b)).ToMatrix(), 1e-12));
}

}  // namespace
}  // namespace hullslam
