// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "synthetic/hash_noise.h"
#include "synthetic/scene.h"
#include "synthetic/tests/implicit_shape.h"

namespace hullslam::synthetic {

inline bool IsInside(const SceneObject& object, const Eigen::Vector3d& point) {
  for (const Part& part : object.parts) {
    if (Implicit(part.shape, Inverse(part.owner_from_part) * point) < 1e-3) {
      return true;
    }
  }
  return false;
}

// The share of the lines between two points of the surface whose middle is outside the object: 0
// for convex objects.
inline double Concavity(const SceneObject& object) {
  std::vector<Eigen::Vector3d> surface;
  for (const Part& part : object.parts) {
    for (const Eigen::Vector3d& vertex : Tessellate(part.shape).vertices) {
      surface.push_back(part.owner_from_part * vertex);
    }
  }
  RandomStream random(1);
  const auto any = [&] {
    return surface[static_cast<size_t>(random.Index(static_cast<int>(surface.size())))];
  };
  constexpr int kLines = 2000;
  int outside = 0;
  for (int i = 0; i < kLines; ++i) {
    const Eigen::Vector3d from = any();
    const Eigen::Vector3d to = any();
    outside += IsInside(object, 0.5 * (from + to)) ? 0 : 1;
  }
  return static_cast<double>(outside) / kLines;
}

}  // namespace hullslam::synthetic
