// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/depth_agreement.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/triangulation.h"
#include "util/median.h"

namespace hullslam {
namespace {

// A keypoint as a ray of its keyframe.
struct Sighting {
  const Rigid3* cam_from_world = nullptr;
  Eigen::Vector2d point;  // x/z, y/z
  double depth = 0.0;     // as measured; 0: unknown
};

Sighting SightingOf(const Map& map, const PinholeCamera& camera, const Observation& seen) {
  const Keyframe& keyframe = map.keyframes().At(seen.keyframe);
  const FrameFeatures& features = keyframe.frame->features;
  const Eigen::Vector2d pixel = features.keypoints[seen.keypoint].undistorted.cast<double>();
  return {&keyframe.cam_from_world, camera.Unproject(pixel, 1.0).head<2>(),
          features.depth[seen.keypoint]};
}

Eigen::Vector3d RayInWorld(const Sighting& sighting) {
  return (sighting.cam_from_world->rotation.conjugate() * sighting.point.homogeneous())
      .normalized();
}

}  // namespace

std::optional<DepthAgreement> CompareDepth(const Map& map, const PinholeCamera& camera) {
  const double kMostCosine = std::cos(3.0 * std::numbers::pi / 180.0);
  std::vector<double> deviations;
  map.landmarks().ForEach([&](LandmarkId, const Landmark& landmark) {
    if (landmark.observations.size() < 2) {
      return;
    }
    const Sighting a = SightingOf(map, camera, landmark.observations.front());
    const Sighting b = SightingOf(map, camera, landmark.observations.back());
    if (RayInWorld(a).dot(RayInWorld(b)) > kMostCosine) {
      return;
    }
    const auto point = TriangulatePoint(*a.cam_from_world, a.point, *b.cam_from_world, b.point);
    for (const Sighting& sighting : {a, b}) {
      const double z = point ? (*sighting.cam_from_world * *point).z() : 0.0;
      if (z > 0.0 && sighting.depth > 0.0) {
        deviations.push_back(std::abs(sighting.depth / z - 1.0));
      }
    }
  });
  if (deviations.empty()) {
    return std::nullopt;
  }
  const size_t points = deviations.size();
  return DepthAgreement{.deviation = Median(std::move(deviations)), .points = points};
}

}  // namespace hullslam
