// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/geometry/trajectory.h"

#include <algorithm>
#include <iterator>

namespace hullslam {

constexpr double kSameStamp = 1e-6;  // seconds: stamps nearer than this are the same

std::optional<Rigid3> InterpolatePose(const Trajectory& trajectory, double timestamp,
                                      double max_gap) {
  const auto after = std::lower_bound(
      trajectory.begin(), trajectory.end(), timestamp - kSameStamp,
      [](const StampedPose& pose, double stamp) { return pose.timestamp < stamp; });
  if (after == trajectory.end()) {
    return std::nullopt;
  }
  if (after->timestamp < timestamp + kSameStamp) {
    return after->world_from_cam;
  }
  if (after == trajectory.begin()) {
    return std::nullopt;
  }
  const StampedPose& before = *std::prev(after);
  const double gap = after->timestamp - before.timestamp;
  if (gap > max_gap) {
    return std::nullopt;
  }
  const double share = (timestamp - before.timestamp) / gap;
  const Rigid3& a = before.world_from_cam;
  const Rigid3& b = after->world_from_cam;
  return Rigid3(a.rotation.slerp(share, b.rotation),
                (1.0 - share) * a.translation + share * b.translation);
}

Trajectory OfOtherCamera(Trajectory trajectory, const Rigid3& cam_from_other) {
  for (StampedPose& pose : trajectory) {
    pose.world_from_cam = pose.world_from_cam * cam_from_other;
  }
  return trajectory;
}

std::vector<double> StampsOf(const Trajectory& trajectory) {
  std::vector<double> stamps;
  for (const StampedPose& pose : trajectory) {
    stamps.push_back(pose.timestamp);
  }
  return stamps;
}

}  // namespace hullslam
