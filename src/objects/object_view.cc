// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hullslam/util/check.h"
#include "objects/point_statistics.h"
#include "util/median.h"

namespace hullslam {
namespace {

// Least angle (degrees) between the rays to a landmark from which the depth of an object is
// computed. With a smaller angle the depth of the landmark is not precise.
constexpr double kMinLandmarkParallax = 1.5;
constexpr size_t kMinLandmarks = 3;  // for the depth of an object

bool HasParallax(const Map& map, const Landmark& landmark) {
  static const double max_cosine = std::cos(kMinLandmarkParallax * std::numbers::pi / 180.0);
  const auto ray_from = [&](const Observation& observation) {
    const Rigid3& cam_from_world = map.keyframes().At(observation.keyframe).cam_from_world;
    return (landmark.position - Inverse(cam_from_world).translation).normalized().eval();
  };
  const Eigen::Vector3d first = ray_from(landmark.observations.front());
  return std::any_of(
      landmark.observations.begin() + 1, landmark.observations.end(),
      [&](const Observation& other) { return first.dot(ray_from(other)) < max_cosine; });
}

std::vector<Eigen::Vector3d> FindLandmarks(const Map& map, const Keyframe& keyframe,
                                           const Detection& detection) {
  std::vector<Eigen::Vector3d> points;
  for (const uint32_t keypoint : detection.keypoints) {
    const LandmarkId id = keyframe.landmarks[keypoint];
    if (!id.IsValid()) {
      continue;
    }
    const Landmark& landmark = map.landmarks().At(id);
    const Eigen::Vector3d point = keyframe.cam_from_world * landmark.position;
    if (point.z() > 0.0 && HasParallax(map, landmark)) {
      points.push_back(point);
    }
  }
  return points;
}

ObjectView MakeView(const Map& map, const ObjectObservation& observation) {
  const Keyframe& keyframe = map.keyframes().At(observation.keyframe);
  const Detection& detection = keyframe.frame->detections[observation.detection];
  return {observation.keyframe, keyframe.cam_from_world, &detection};
}

}  // namespace

std::vector<ObjectView> CollectViews(const Map& map, const ObjectLandmark& object,
                                     size_t max_views) {
  const size_t count = object.observations.size();
  const size_t taken = max_views == 0 ? count : std::min(count, max_views);
  std::vector<ObjectView> views;
  views.reserve(taken);
  for (size_t i = 0; i < taken; ++i) {
    const size_t index = taken == 1 ? count - 1 : i * (count - 1) / (taken - 1);
    views.push_back(MakeView(map, object.observations[index]));
  }
  return views;
}

std::vector<ObjectView> LatestViews(const Map& map, const ObjectLandmark& object, size_t count) {
  const size_t total = object.observations.size();
  std::vector<ObjectView> views;
  views.reserve(std::min(count, total));
  for (size_t i = total - std::min(count, total); i < total; ++i) {
    views.push_back(MakeView(map, object.observations[i]));
  }
  return views;
}

void AddSurfaceLandmarks(const Map& map, std::span<ObjectView> views) {
  for (ObjectView& view : views) {
    if (view.detection->points.empty()) {
      view.landmarks = FindLandmarks(map, map.keyframes().At(view.keyframe), *view.detection);
    }
  }
}

std::vector<Eigen::Vector3d> SurfacePoints(const ObjectView& view) {
  return view.detection->points.empty() ? view.landmarks : view.detection->points.Unpack();
}

std::optional<double> LandmarkDepth(const ObjectView& view) {
  if (view.landmarks.size() < kMinLandmarks) {
    return std::nullopt;
  }
  std::vector<double> depths;
  for (const Eigen::Vector3d& landmark : view.landmarks) {
    depths.push_back(landmark.z());
  }
  return Median(std::move(depths));
}

std::vector<Eigen::Vector3d> CollectPoints(std::span<const ObjectView> views, size_t max_points) {
  size_t total = 0;
  for (const ObjectView& view : views) {
    total += view.detection->points.size();
  }
  const size_t step = std::max<size_t>(1, total / std::max<size_t>(1, max_points));
  std::vector<Eigen::Vector3d> points;
  points.reserve(total / step + 1);
  size_t index = 0;
  for (const ObjectView& view : views) {
    const Rigid3 world_from_cam = Inverse(view.cam_from_world);
    for (const Eigen::Vector3d& point : view.detection->points.Unpack()) {
      if (index++ % step == 0) {
        points.push_back(world_from_cam * point);
      }
    }
  }
  return points;
}

bool HasDepth(std::span<const ObjectView> views) {
  size_t points = 0;
  for (const ObjectView& view : views) {
    points += view.detection->points.size();
  }
  return points >= kMinDepthPoints;
}

double MeanDistance(std::span<const ObjectView> views, const Eigen::Vector3d& point) {
  Check(!views.empty(), "an object that no keyframe observes has no distance");
  double sum = 0.0;
  for (const ObjectView& view : views) {
    sum += (view.cam_from_world * point).norm();
  }
  return sum / static_cast<double>(views.size());
}

double FarthestView(std::span<const ObjectView> views, const Eigen::Vector3d& point) {
  double farthest = 0.0;
  for (const ObjectView& view : views) {
    farthest = std::max(farthest, (view.cam_from_world * point).norm());
  }
  return farthest;
}

Eigen::Vector3d Centroid(const ObjectView& view) {
  Check(!view.detection->points.empty(), "a view without depth has no centroid");
  return Inverse(view.cam_from_world) * MeanOf(view.detection->points.Unpack());
}

double Parallax(std::span<const ObjectView> views, const Eigen::Vector3d& point) {
  std::vector<Eigen::Vector3d> rays;
  rays.reserve(views.size());
  for (const ObjectView& view : views) {
    rays.push_back((point - Inverse(view.cam_from_world).translation).normalized());
  }
  double min_cosine = 1.0;
  for (size_t i = 0; i < rays.size(); ++i) {
    for (size_t j = i + 1; j < rays.size(); ++j) {
      min_cosine = std::min(min_cosine, rays[i].dot(rays[j]));
    }
  }
  return std::acos(std::clamp(min_cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

}  // namespace hullslam
