// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/pose_scale_check.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr size_t kViews = 20;         // of a class that are kept
constexpr size_t kFewestPoints = 10;  // of the depth in a mask
// m. The centre of what is seen of a thing moves by a few centimetres when the camera moves.
constexpr double kLeastMotion = 0.15;
constexpr double kLeastCosine = 0.9;  // of the angle between the two motions, by depth and by poses
constexpr size_t kFewestPairs = 20;
constexpr size_t kMostPairs = 20'000;

// The median of each coordinate, so that a few points behind the thing do not matter.
Eigen::Vector3d CentreOf(const PackedPoints<3>& packed) {
  const std::vector<Eigen::Vector3d> points = packed.Unpack();
  Eigen::Vector3d centre;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const Eigen::Vector3d& point : points) {
      values.push_back(point[axis]);
    }
    centre[axis] = Median(std::move(values));
  }
  return centre;
}

}  // namespace

void PoseScaleCheck::Add(std::span<const Detection> detections, const Rigid3& world_from_cam) {
  std::set<std::string> once;
  std::set<std::string> often;
  for (const Detection& detection : detections) {
    if (!once.insert(detection.label).second) {
      often.insert(detection.label);
    }
  }
  for (const Detection& detection : detections) {
    if (often.contains(detection.label) || detection.is_cut ||
        detection.points.size() < kFewestPoints) {
      continue;
    }
    const View view{world_from_cam.rotation * CentreOf(detection.points),
                    world_from_cam.translation};
    std::deque<View>& former = views_[detection.label];
    for (const View& other : former) {
      Compare(view, other);
    }
    former.push_back(view);
    if (former.size() > kViews) {
      former.pop_front();
    }
  }
}

void PoseScaleCheck::Compare(const View& one, const View& other) {
  const Eigen::Vector3d by_depth = one.from_camera - other.from_camera;
  const Eigen::Vector3d by_poses = other.camera - one.camera;
  const double lengths = by_depth.norm() * by_poses.norm();
  if (by_depth.norm() >= kLeastMotion && by_depth.dot(by_poses) >= kLeastCosine * lengths &&
      lengths > 0.0 && scales_.size() < kMostPairs) {
    scales_.push_back(by_depth.norm() / by_poses.norm());
  }
}

std::optional<double> PoseScaleCheck::Scale() const {
  return scales_.size() < kFewestPairs ? std::nullopt : std::optional(Median(scales_));
}

}  // namespace hullslam
