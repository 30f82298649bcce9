// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/geometry/trajectory.h"

namespace hullslam {

struct UpDirection {
  std::optional<Eigen::Vector3d> up;  // unit vector in the world of the map
  std::string from;                   // "ground truth", "planes", or why it is not known
};

// The upward direction from a ground truth. Its world has one axis upwards: the one that the tops
// of the images are nearest to. The rotation between the two worlds follows from the orientations
// of the camera, so it is also known if the camera has hardly moved. Not known if no pose has a
// true pose of the same time, if the tops of the images point to no axis, or if the orientations do
// not agree with one rotation between the worlds.
UpDirection UpFromGroundtruth(const Trajectory& groundtruth, const Trajectory& poses);

// The upward direction from the planes of the scene. Floors, tables and shelves are horizontal, so
// many landmarks have the same height. Of all directions near the tops of the images, takes the one
// along which the heights of the landmarks are concentrated most. Not known if they are not clearly
// more concentrated than along other directions.
UpDirection UpFromPlanes(std::span<const Eigen::Vector3d> landmarks, const Trajectory& poses);

// The direction that the tops of the images point to on average. It is only a guess, good enough to
// draw a map; absent if the camera was held in too many ways.
std::optional<Eigen::Vector3d> UpFromImages(const Trajectory& poses);

// The first of ground truth and planes that gives a direction.
UpDirection FindUp(const std::optional<Trajectory>& groundtruth, const Trajectory& poses,
                   std::span<const Eigen::Vector3d> landmarks);

}  // namespace hullslam
