// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/landmark_edits.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "util/function_clones.h"

namespace hullslam {
namespace {

HULLSLAM_FUNCTION_CLONES
size_t MostTypical(std::span<const Descriptor> descriptors) {
  const size_t n = descriptors.size();
  if (n <= 2) {
    return 0;  // the median of two is the distance of each from itself
  }
  std::vector<int> distances(n * n, 0);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      distances[i * n + j] = distances[j * n + i] = HammingDistance(descriptors[i], descriptors[j]);
    }
  }
  size_t best = 0;
  int best_median = std::numeric_limits<int>::max();
  for (size_t i = 0; i < n; ++i) {
    const auto row = distances.begin() + static_cast<std::ptrdiff_t>(i * n);
    const auto middle = row + static_cast<std::ptrdiff_t>((n - 1) / 2);
    const auto end = row + static_cast<std::ptrdiff_t>(n);
    // Counting takes less time than finding the median.
    if (std::count_if(row, end, [&](int d) { return d < best_median; }) > middle - row) {
      std::nth_element(row, middle, end);
      best_median = *middle;
      best = i;
    }
  }
  return best;
}

}  // namespace

size_t MostTypicalDescriptor(std::span<const Descriptor> descriptors) {
  return MostTypical(descriptors);
}

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
