// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/reprojection_error.h"

#include <utility>
#include <vector>

#include "util/statistics.h"

namespace hullslam {

std::optional<double> MedianReprojectionError(const Map& map, const PinholeCamera& camera) {
  std::vector<double> errors;
  map.landmarks().ForEach([&](LandmarkId, const Landmark& landmark) {
    if (landmark.observations.size() < 2) {
      return;  // it was made from this observation, so its error is 0
    }
    for (const Observation& seen : landmark.observations) {
      const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
      const Eigen::Vector3d in_camera = keyframe.cam_from_world * landmark.position;
      if (in_camera.z() > 0.0) {
        const Keypoint& keypoint = keyframe.frame->features.keypoints[seen.keypoint];
        errors.push_back((camera.Project(in_camera) - keypoint.undistorted.cast<double>()).norm());
      }
    }
  });
  return errors.empty() ? std::nullopt : std::optional(Median(std::move(errors)));
}

}  // namespace hullslam
