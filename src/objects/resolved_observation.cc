// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/resolved_observation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hullslam/util/check.h"
#include "objects/constraint/point_statistics.h"
#include "util/statistics.h"

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

ResolvedObservation MakeView(const Map& map, const ObjectObservation& observation) {
  const Keyframe& keyframe = map.keyframes().At(observation.keyframe);
  const Detection& detection = keyframe.frame->detections[observation.detection];
  return {observation.keyframe, keyframe.cam_from_world, &detection};
}

}  // namespace

std::vector<ResolvedObservation> ResolveObservations(const Map& map, const ObjectLandmark& object,
                                                     size_t max_views) {
  const size_t count = object.observations.size();
  const size_t taken = max_views == 0 ? count : std::min(count, max_views);
  std::vector<ResolvedObservation> observations;
  observations.reserve(taken);
  for (size_t i = 0; i < taken; ++i) {
    const size_t index = taken == 1 ? count - 1 : i * (count - 1) / (taken - 1);
    observations.push_back(MakeView(map, object.observations[index]));
  }
  return observations;
}

std::vector<ResolvedObservation> LatestObservations(const Map& map, const ObjectLandmark& object,
                                                    size_t count) {
  const size_t total = object.observations.size();
  std::vector<ResolvedObservation> observations;
  observations.reserve(std::min(count, total));
  for (size_t i = total - std::min(count, total); i < total; ++i) {
    observations.push_back(MakeView(map, object.observations[i]));
  }
  return observations;
}

void AddSurfaceLandmarks(const Map& map, std::span<ResolvedObservation> observations) {
  for (ResolvedObservation& observation : observations) {
    if (observation.detection->points.empty()) {
      observation.landmarks =
          FindLandmarks(map, map.keyframes().At(observation.keyframe), *observation.detection);
    }
  }
}

std::vector<Eigen::Vector3d> SurfacePoints(const ResolvedObservation& observation) {
  return observation.detection->points.empty() ? observation.landmarks
                                               : observation.detection->points.Unpack();
}

std::optional<double> LandmarkDepth(const ResolvedObservation& observation) {
  if (observation.landmarks.size() < kMinLandmarks) {
    return std::nullopt;
  }
  std::vector<double> depths;
  for (const Eigen::Vector3d& landmark : observation.landmarks) {
    depths.push_back(landmark.z());
  }
  return Median(std::move(depths));
}

std::vector<Eigen::Vector3d> CollectPoints(std::span<const ResolvedObservation> observations,
                                           size_t max_points) {
  size_t total = 0;
  for (const ResolvedObservation& observation : observations) {
    total += observation.detection->points.size();
  }
  const size_t step = std::max<size_t>(1, total / std::max<size_t>(1, max_points));
  std::vector<Eigen::Vector3d> points;
  points.reserve(total / step + 1);
  size_t index = 0;
  for (const ResolvedObservation& observation : observations) {
    const Rigid3 world_from_cam = Inverse(observation.cam_from_world);
    for (const Eigen::Vector3d& point : observation.detection->points.Unpack()) {
      if (index++ % step == 0) {
        points.push_back(world_from_cam * point);
      }
    }
  }
  return points;
}

bool HasDepth(std::span<const ResolvedObservation> observations) {
  size_t points = 0;
  for (const ResolvedObservation& observation : observations) {
    points += observation.detection->points.size();
  }
  return points >= kMinDepthPoints;
}

double MeanDistance(std::span<const ResolvedObservation> observations,
                    const Eigen::Vector3d& point) {
  Check(!observations.empty(), "an object that no keyframe observes has no distance");
  double sum = 0.0;
  for (const ResolvedObservation& observation : observations) {
    sum += (observation.cam_from_world * point).norm();
  }
  return sum / static_cast<double>(observations.size());
}

double LargestDistance(std::span<const ResolvedObservation> observations,
                       const Eigen::Vector3d& point) {
  double farthest = 0.0;
  for (const ResolvedObservation& observation : observations) {
    farthest = std::max(farthest, (observation.cam_from_world * point).norm());
  }
  return farthest;
}

Eigen::Vector3d Centroid(const ResolvedObservation& observation) {
  Check(!observation.detection->points.empty(), "an observation without depth has no centroid");
  return Inverse(observation.cam_from_world) * MeanOf(observation.detection->points.Unpack());
}

double Parallax(std::span<const ResolvedObservation> observations, const Eigen::Vector3d& point) {
  std::vector<Eigen::Vector3d> rays;
  rays.reserve(observations.size());
  for (const ResolvedObservation& observation : observations) {
    rays.push_back((point - Inverse(observation.cam_from_world).translation).normalized());
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
