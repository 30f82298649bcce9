// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/join_requests.h"

#include <algorithm>
#include <utility>

#include "map/islands.h"
#include "tracking/last_frame.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// A join needs two keyframes of one place. The second two are for what a single one may miss.
constexpr int kMostRequests = 4;
// Two images show the same view if each of them has at least this share of the landmarks of the
// other one (a camera that turns by a tenth of its field of view sees another one), and if the
// distance between the cameras is less than this share of the median depth: 10 degrees.
constexpr double kSameLandmarks = 0.9;
constexpr double kSameDirection = 0.18;

// The median depth of the landmarks that the map has; 0 if there are none.
double MedianDepth(const Map& map, const Rigid3& cam_from_world,
                   const std::vector<LandmarkId>& landmarks) {
  std::vector<double> depths;
  for (const LandmarkId id : landmarks) {
    if (const Landmark* const landmark = map.landmarks().Find(id)) {
      depths.push_back((cam_from_world * landmark->position).z());
    }
  }
  return depths.empty() ? 0.0 : Median(std::move(depths));
}

}  // namespace

bool JoinRequests::MayAskAgain(const Map& map, const Sensor& sensor, KeyframeId reference,
                               const PoseEstimate& estimate) {
  if (requests_ > 0 && !IsSameView(map, sensor, reference, estimate)) {
    requests_ = 0;
  }
  return requests_ < kMostRequests;
}

void JoinRequests::Add(const Map& map, KeyframeId reference, const PoseEstimate& estimate) {
  if (requests_++ == 0) {
    pose_ = map.RelativeTo(reference, estimate.cam_from_world);
    landmarks_ = estimate.landmarks;
  }
}

bool JoinRequests::IsSameView(const Map& map, const Sensor& sensor, KeyframeId reference,
                              const PoseEstimate& estimate) const {
  if (!map.NearestAlive(pose_.reference).IsValid() ||
      IslandOf(map, pose_.reference) != IslandOf(map, reference)) {
    return false;
  }
  std::vector<LandmarkId> then = landmarks_;
  std::ranges::transform(then, then.begin(), [&](LandmarkId id) { return map.Resolve(id); });
  const Rigid3 pose_then = map.CamFromWorld(pose_);
  const Rigid3& pose = estimate.cam_from_world;
  const double distance = (Inverse(pose).translation - Inverse(pose_then).translation).norm();
  return ShareInImage(map, sensor, pose, then) >= kSameLandmarks &&
         ShareInImage(map, sensor, pose_then, estimate.landmarks) >= kSameLandmarks &&
         distance <= kSameDirection * MedianDepth(map, pose, estimate.landmarks);
}

}  // namespace hullslam
