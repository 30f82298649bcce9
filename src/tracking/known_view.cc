// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/known_view.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "util/id_set.h"

namespace hullslam {
namespace {

// What was seen a moment ago is mapped better by a second look; a lap of a room takes longer.
constexpr double kLeastTime = 30.0;   // s
constexpr double kMostShift = 0.04;   // of the width of the image; half of it lies between
                                      // keyframes of a hand that moves at 0.25 m/s
constexpr double kMostZoom = 0.1;     // logarithm of the ratio of distances
constexpr double kLeastFound = 0.25;  // of its landmarks; fewer if the light has changed
constexpr size_t kPoints = 40;        // that are compared

// The landmarks of a frame with some of their positions in its camera.
struct View {
  IdSet<LandmarkId> landmarks;
  std::vector<Eigen::Vector3d> points;
};

View ViewOf(const Map& map, const PoseEstimate& estimate) {
  std::vector<LandmarkId> found;
  for (const LandmarkId id : estimate.landmarks) {
    if (id.IsValid() && map.landmarks().Contains(id)) {
      found.push_back(id);
    }
  }
  View view;
  const size_t step = std::max<size_t>(1, found.size() / kPoints);
  for (size_t i = 0; i < found.size(); ++i) {
    view.landmarks.Insert(found[i]);
    if (i % step == 0) {
      view.points.push_back(estimate.cam_from_world * map.landmarks().At(found[i]).position);
    }
  }
  return view;
}

bool ShowsTheSame(const View& view, const Keyframe& keyframe, const Rigid3& keyframe_from_frame,
                  double most_angle) {
  const auto is_near = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d other = keyframe_from_frame * point;
    return std::abs(std::log(other.norm() / point.norm())) < kMostZoom &&
           std::atan2(point.cross(other).norm(), point.dot(other)) < most_angle;
  };
  const auto near = std::count_if(view.points.begin(), view.points.end(), is_near);
  if (2 * static_cast<size_t>(near) <= view.points.size()) {
    return false;
  }
  size_t landmarks = 0;
  size_t found = 0;
  for (const LandmarkId id : keyframe.landmarks) {
    landmarks += id.IsValid() ? 1 : 0;
    found += id.IsValid() && view.landmarks.Contains(id) ? 1 : 0;
  }
  return static_cast<double>(found) >= kLeastFound * static_cast<double>(landmarks);
}

}  // namespace

bool IsKnownView(const Map& map, const Sensor& sensor, const Frame& frame, FrameId first_of_session,
                 KeyframeId reference, const PoseEstimate& estimate) {
  const View view = ViewOf(map, estimate);
  const Rigid3 world_from_cam = Inverse(estimate.cam_from_world);
  const double most_angle = kMostShift * sensor.camera.width / sensor.camera.fx;
  const auto is_known = [&](KeyframeId id) {
    const Keyframe& keyframe = map.keyframes().At(id);
    return keyframe.frame->id >= first_of_session &&
           frame.timestamp - keyframe.frame->timestamp > kLeastTime &&
           ShowsTheSame(view, keyframe, keyframe.cam_from_world * world_from_cam, most_angle);
  };
  const std::vector<Covisible>& covisible = map.keyframes().At(reference).covisible;
  return is_known(reference) ||
         std::any_of(covisible.begin(), covisible.end(),
                     [&](const Covisible& other) { return is_known(other.keyframe); });
}

}  // namespace hullslam
