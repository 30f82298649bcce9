// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/detection.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Measures whether known poses have the unit of the depth images. A thing that stands still has the
// position R c + t in the world, where c is its centre in the camera by the depth, and R and t are
// the pose. If the unit of the poses is s metres, two views of it give
//   R1 c1 - R2 c2 = s (t2 - t1).
class PoseScaleCheck {
 public:
  // Adds a view. A class counts if one detection has it, because others may be confused.
  void Add(std::span<const Detection> detections, const Rigid3& world_from_cam);

  // The metres in one unit of the poses by the depth; absent if there are too few pairs of views.
  std::optional<double> Scale() const;

 private:
  struct View {
    Eigen::Vector3d from_camera;  // R c, m
    Eigen::Vector3d camera;       // t, units of the poses
  };
  void Compare(const View& one, const View& other);

  std::map<std::string, std::deque<View>> views_;  // the newest ones of each class
  std::vector<double> scales_;                     // of the pairs
};

}  // namespace hullslam
