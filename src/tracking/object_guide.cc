// SPDX-License-Identifier: GPL-3.0-or-later
#include "tracking/object_guide.h"

#include <algorithm>
#include <utility>

#include "geometry/polyline.h"
#include "hullslam/frame/instance_mask.h"
#include "objects/resolved_observation.h"
#include "objects/validity.h"
#include "util/lists.h"

namespace hullslam {
namespace {

std::vector<uint8_t> KeypointsOutside(const Frame& frame, const Detection& detection) {
  const std::vector<Keypoint>& keypoints = frame.features.keypoints;
  std::vector<uint8_t> is_outside(keypoints.size(), 1);
  for (size_t i = 0; i < keypoints.size(); ++i) {
    const Eigen::Vector2d pixel = keypoints[i].undistorted.cast<double>();
    if (detection.box.squaredExteriorDistance(pixel) <= kMaskMarginPx * kMaskMarginPx &&
        IsInOrNearConvex(detection.hull, pixel, kMaskMarginPx)) {
      is_outside[i] = 0;
    }
  }
  return is_outside;
}

}  // namespace

std::vector<LandmarkId> LandmarksOn(const Map& map, const ObjectLandmark& object,
                                    const IdSet<LandmarkId>& known, const ObjectOptions& options) {
  const std::vector<ResolvedObservation> views =
      ResolveObservations(map, object, static_cast<size_t>(options.guide.views));
  if (views.empty()) {
    return {};
  }
  std::vector<LandmarkId> landmarks;
  for (const ResolvedObservation& view : views) {
    const Keyframe& keyframe = map.keyframes().At(view.keyframe);
    for (const uint32_t keypoint : view.detection->keypoints) {
      const LandmarkId landmark = keyframe.landmarks[keypoint];
      if (landmark.IsValid() && !known.Contains(landmark)) {
        landmarks.push_back(landmark);
      }
    }
  }
  SortUnique(landmarks);
  const Ellipsoid& ellipsoid = object.ellipsoid;
  const double margin = NearSurface(
      ellipsoid, MeanDistance(views, ellipsoid.world_from_object.translation), options.validity);
  std::erase_if(landmarks, [&](LandmarkId id) {
    return ellipsoid.RadialDistance(map.landmarks().At(id).position) > margin;
  });
  return landmarks;
}

std::vector<ObjectGuide> GuideByObjects(const Map& map, const Frame& frame,
                                        std::span<const ObjectId> objects,
                                        const IdSet<LandmarkId>& known,
                                        const ObjectOptions& options) {
  std::vector<ObjectGuide> guides;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!objects[i].IsValid()) {
      continue;
    }
    std::vector<LandmarkId> landmarks =
        LandmarksOn(map, map.objects().At(objects[i]), known, options);
    if (!landmarks.empty()) {
      guides.push_back({std::move(landmarks), KeypointsOutside(frame, frame.detections[i])});
    }
  }
  return guides;
}

}  // namespace hullslam
