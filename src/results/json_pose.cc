// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/json_pose.h"

#include <fmt/format.h>

#include <vector>

#include "files/plausible.h"

namespace hullslam {

Rigid3 PoseOf(const JsonNode& node) {
  const std::vector<double> v = node.Numbers(7, "tx, ty, tz, qx, qy, qz, qw");
  Rigid3 pose(Eigen::Quaterniond(v[6], v[3], v[4], v[5]), {v[0], v[1], v[2]});
  if (!(pose.translation.cwiseAbs().maxCoeff() <= kMostMetres)) {
    node.Fail(fmt::format("a position from {:g} to {:g} m", -kMostMetres, kMostMetres));
  }
  if (!IsPlausibleRotation(pose.rotation)) {
    node.Fail("a quaternion of length 1");
  }
  pose.rotation.normalize();
  return pose;
}

}  // namespace hullslam
