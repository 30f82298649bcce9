// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mirror.h"

namespace hullslam {

Rigid3 MirrorY(const Rigid3& world_from_cam) {
  // F R F is a rotation about the mirrored axis by the opposite angle, so the vector part (x, y, z)
  // of the quaternion becomes (-x, y, -z).
  const Eigen::Quaterniond& q = world_from_cam.rotation;
  const Eigen::Vector3d& t = world_from_cam.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), Eigen::Vector3d(t.x(), -t.y(), t.z())};
}

Trajectory MirrorY(Trajectory trajectory) {
  for (StampedPose& pose : trajectory) {
    pose.world_from_cam = MirrorY(pose.world_from_cam);
  }
  return trajectory;
}

}  // namespace hullslam
