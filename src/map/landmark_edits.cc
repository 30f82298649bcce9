// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/landmark_edits.h"

#include <algorithm>
#include <vector>

#include "features/typical_descriptor.h"

namespace hullslam {
void UpdateDescriptor(Map& map, LandmarkId id) {
  std::vector<Descriptor> descriptors;
  for (const Observation& observation : map.landmarks().At(id).observations) {
    descriptors.push_back(
        map.keyframes().At(observation.keyframe).frame->features.descriptors[observation.keypoint]);
  }
  if (!descriptors.empty()) {
    map.MutableLandmark(id).descriptor = descriptors[MostTypicalDescriptor(descriptors)];
  }
}

void UpdateViewingGeometry(Map& map, LandmarkId id, const ScaleLevels& levels) {
  Landmark& landmark = map.MutableLandmark(id);
  if (landmark.observations.empty()) {
    return;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Observation& observation : landmark.observations) {
    const Rigid3& cam_from_world = map.keyframes().At(observation.keyframe).cam_from_world;
    const Eigen::Vector3d center = Inverse(cam_from_world).translation;
    sum += (landmark.position - center).normalized();
  }
  landmark.viewing_direction = sum.normalized();

  const auto reference =
      std::find_if(landmark.observations.begin(), landmark.observations.end(),
                   [&](const Observation& o) { return o.keyframe == landmark.reference; });
  const Observation& observation =
      reference != landmark.observations.end() ? *reference : landmark.observations.front();
  const Keyframe& keyframe = map.keyframes().At(observation.keyframe);
  const double distance = (keyframe.cam_from_world * landmark.position).norm();
  const int level = keyframe.frame->features.keypoints[observation.keypoint].level;
  landmark.max_distance = distance * static_cast<double>(levels.scale[static_cast<size_t>(level)]);
  landmark.min_distance = landmark.max_distance / static_cast<double>(levels.scale.back());
}

}  // namespace hullslam
