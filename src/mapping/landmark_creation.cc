// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/landmark_creation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "frame/measure_point.h"
#include "geometry/triangulation.h"
#include "map/keyframe_graph.h"
#include "map/landmark_edits.h"
#include "map/landmark_projection.h"
#include "mapping/sensor_rules.h"
#include "matching/by_projection.h"
#include "matching/for_triangulation.h"
#include "util/lists.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr double kMaxCosParallax = 0.9998;  // about 1.1 degrees, if both depths are unknown
// Least expected parallax of a monocular pair, in standard deviations of its keypoints.
constexpr double kMinParallaxSigmas = 2.0;

// A keypoint of a keyframe with the data that triangulation needs.
struct SeenPoint {
  const Keyframe* keyframe = nullptr;
  uint32_t keypoint = 0;
  Eigen::Vector2d pixel;
  Eigen::Vector2d normalized;
  Eigen::Vector3d ray_in_world;  // unit
  double depth = 0.0;            // m, 0 if unknown
  double scale = 1.0;            // scale of the keypoint's level
  PointMeasurement measurement;
};

SeenPoint MakeSeenPoint(const Keyframe& keyframe, uint32_t keypoint, const Sensor& sensor) {
  const FrameFeatures& features = keyframe.frame->features;
  SeenPoint seen;
  seen.keyframe = &keyframe;
  seen.keypoint = keypoint;
  seen.pixel = features.keypoints[keypoint].undistorted.cast<double>();
  const Eigen::Vector3d ray = sensor.camera.Unproject(seen.pixel, 1.0);
  seen.normalized = ray.head<2>();
  seen.ray_in_world = keyframe.cam_from_world.rotation.conjugate() * ray.normalized();
  seen.depth = static_cast<double>(features.depth[keypoint]);
  seen.scale = static_cast<double>(
      sensor.levels.scale[static_cast<size_t>(features.keypoints[keypoint].level)]);
  seen.measurement = MeasurePoint(sensor, features, keypoint, sensor.depth_error);
  return seen;
}

// Cosine of the parallax of the virtual stereo pair. 2, larger than any cosine, without depth.
double CosStereoParallax(const SeenPoint& seen, double baseline) {
  return seen.depth > 0.0 ? std::cos(2.0 * std::atan2(0.5 * baseline, seen.depth)) : 2.0;
}

Eigen::Vector3d UnprojectToWorld(const SeenPoint& seen, const Sensor& sensor) {
  return Inverse(seen.keyframe->cam_from_world) * sensor.camera.Unproject(seen.pixel, seen.depth);
}

std::optional<Eigen::Vector3d> Triangulate(const SeenPoint& a, const SeenPoint& b) {
  return TriangulatePoint(a.keyframe->cam_from_world, a.normalized, b.keyframe->cam_from_world,
                          b.normalized);
}

// The position of the point that both views show; null if the views do not determine it. For
// sensors with depth.
std::optional<Eigen::Vector3d> Locate(const SeenPoint& a, const SeenPoint& b,
                                      const Sensor& sensor) {
  const double cos_parallax = a.ray_in_world.dot(b.ray_in_world);
  const double cos_a = CosStereoParallax(a, sensor.baseline());
  const double cos_b = CosStereoParallax(b, sensor.baseline());
  const bool has_depth = a.depth > 0.0 || b.depth > 0.0;
  if (cos_parallax > 0.0 && cos_parallax < std::min(cos_a, cos_b) &&
      (has_depth || cos_parallax < kMaxCosParallax)) {
    return Triangulate(a, b);
  }
  if (!has_depth) {
    return std::nullopt;
  }
  return UnprojectToWorld(cos_a < cos_b ? a : b, sensor);
}

bool Reprojects(const SeenPoint& seen, const Eigen::Vector3d& point, const Sensor& sensor) {
  return IsInlier(sensor.camera, seen.measurement, seen.keyframe->cam_from_world * point);
}

// A patch that is farther away is found at a finer level, so distance times scale is constant.
bool HasConsistentScale(const SeenPoint& a, const SeenPoint& b, const Eigen::Vector3d& point,
                        const Sensor& sensor) {
  const double distance_a = (a.keyframe->cam_from_world * point).norm();
  const double distance_b = (b.keyframe->cam_from_world * point).norm();
  if (distance_a == 0.0 || distance_b == 0.0) {
    return false;
  }
  const double tolerance = 1.5 * std::exp(static_cast<double>(sensor.levels.log_factor));
  const double ratio = (distance_b * b.scale) / (distance_a * a.scale);
  return ratio < tolerance && ratio > 1.0 / tolerance;
}

std::vector<uint32_t> FreeKeypoints(const Keyframe& keyframe) {
  std::vector<uint32_t> free;
  for (uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (!keyframe.landmarks[i].IsValid()) {
      free.push_back(i);
    }
  }
  return free;
}

// The pixel where the line through both camera centres meets the image plane of b. It is far
// outside the image if the line is parallel to the plane.
Eigen::Vector2d EpipoleOf(const Rigid3& b_from_a, const PinholeCamera& camera) {
  const Eigen::Vector3d& center = b_from_a.translation;
  const bool is_parallel = std::abs(center.z()) <= 1e-6 * center.norm();
  return is_parallel ? Eigen::Vector2d::Constant(-1e6) : camera.Project(center);
}

// The shortest baseline from which landmarks are made. Below the virtual stereo baseline, depth is
// more precise than triangulation. For a monocular sensor the shortest baseline depends on the
// depths of the landmarks.
double MinBaseline(const Map& map, const Keyframe& keyframe, const LandmarkRules& rules) {
  if (rules.min_baseline) {
    return *rules.min_baseline;
  }
  std::vector<double> depths;
  for (const LandmarkId id : keyframe.landmarks) {
    if (id.IsValid()) {
      depths.push_back((keyframe.cam_from_world * map.landmarks().At(id).position).z());
    }
  }
  if (depths.empty()) {
    return 0.0;
  }
  return rules.min_baseline_share * Median(std::move(depths));
}

std::vector<Match> FindPairs(const Map& map, const Keyframe& a, const Keyframe& b,
                             const Sensor& sensor, const LandmarkRules& rules) {
  const Rigid3 b_from_a = b.cam_from_world * Inverse(a.cam_from_world);
  if (b_from_a.translation.norm() < MinBaseline(map, b, rules)) {
    return {};
  }
  const Eigen::Matrix3d calibration = sensor.camera.Matrix();
  return MatchForTriangulation(a.frame->features, FreeKeypoints(a), b.frame->features,
                               FreeKeypoints(b),
                               FundamentalFromPose(b_from_a, calibration, calibration),
                               EpipoleOf(b_from_a, sensor.camera), sensor.levels, sensor.camera);
}

bool IsConsistent(const SeenPoint& a, const SeenPoint& b, const Eigen::Vector3d& point,
                  const Sensor& sensor) {
  return Reprojects(a, point, sensor) && Reprojects(b, point, sensor) &&
         HasConsistentScale(a, b, point, sensor);
}

// The raw pixels and the depths of the landmarks of a keyframe.
class NearbyDepth {
 public:
  NearbyDepth(const Map& map, const Keyframe& keyframe, const Sensor& sensor) {
    for (size_t i = 0; i < keyframe.landmarks.size(); ++i) {
      if (keyframe.landmarks[i].IsValid()) {
        const Eigen::Vector3d& position = map.landmarks().At(keyframe.landmarks[i]).position;
        const Eigen::Vector2d pixel =
            keyframe.frame->features.keypoints[i].undistorted.cast<double>();
        samples_.push_back(
            {sensor.camera.Distort(pixel), (keyframe.cam_from_world * position).z()});
      }
    }
  }

  // The median depth of the landmarks that are nearest in the image; null if there are too few.
  std::optional<double> At(const Eigen::Vector2d& pixel) const {
    constexpr size_t kNearest = 9;
    if (samples_.size() < kNearest) {
      return std::nullopt;
    }
    std::vector<std::pair<double, double>> nearest;  // squared distance, depth
    for (const Sample& sample : samples_) {
      nearest.emplace_back((sample.pixel - pixel).squaredNorm(), sample.depth);
    }
    std::partial_sort(nearest.begin(), nearest.begin() + kNearest, nearest.end());
    std::vector<double> depths(kNearest);
    std::transform(nearest.begin(), nearest.begin() + kNearest, depths.begin(),
                   [](const auto& one) { return one.second; });
    return Median(std::move(depths));
  }

 private:
  struct Sample {
    Eigen::Vector2d pixel;
    double depth;
  };
  std::vector<Sample> samples_;
};

// The distance in the raw image b, px, between a point of a at this depth and a point that is
// infinitely far away.
double ParallaxAt(double depth, const SeenPoint& a, const SeenPoint& b, const Sensor& sensor) {
  const Rigid3 b_from_a = b.keyframe->cam_from_world * Inverse(a.keyframe->cam_from_world);
  const Eigen::Vector3d infinite = b_from_a.rotation * a.normalized.homogeneous();
  const Eigen::Vector3d point = infinite + b_from_a.translation / depth;
  if (point.z() <= 0.0 || infinite.z() <= 0.0) {
    return 0.0;
  }
  return (sensor.camera.Distort(sensor.camera.Project(point)) -
          sensor.camera.Distort(sensor.camera.Project(infinite)))
      .norm();
}

// Triangulates a pair of a monocular camera if the parallax expected for its depth is large enough.
// The pair's own parallax must not decide, because noise would select pairs that are too near. The
// scale of the map would then shrink wherever the camera only turns. So the expected parallax is
// computed from the depth of the landmarks that are nearest in the image.
std::optional<Eigen::Vector3d> LocateMonocular(const SeenPoint& a, const SeenPoint& b,
                                               const NearbyDepth& nearby, const Sensor& sensor) {
  const std::optional<double> depth = nearby.At(sensor.camera.Distort(a.pixel));
  const double noise = std::hypot(a.scale, b.scale);
  if (!depth || ParallaxAt(*depth, a, b, sensor) < kMinParallaxSigmas * noise) {
    return std::nullopt;
  }
  return Triangulate(a, b);
}

constexpr size_t kFusionNeighbours = 10;
constexpr size_t kSecondNeighbours = 5;
constexpr float kRadius = 3.0f;   // px at level 0
constexpr int kMaxDistance = 50;  // Hamming

std::vector<KeyframeId> Neighbourhood(const Map& map, KeyframeId id) {
  std::vector<KeyframeId> targets = BestCovisible(map.keyframes().At(id), kFusionNeighbours);
  const std::vector<KeyframeId> first = targets;
  for (const KeyframeId neighbour : first) {
    const auto second = BestCovisible(map.keyframes().At(neighbour), kSecondNeighbours);
    targets.insert(targets.end(), second.begin(), second.end());
  }
  SortUnique(targets);
  std::erase(targets, id);
  return targets;
}

void Join(Map& map, LandmarkId landmark, LandmarkId other, const ScaleLevels& levels) {
  if (landmark == other) {
    return;
  }
  const bool keep = map.landmarks().At(landmark).observation_weight >=
                    map.landmarks().At(other).observation_weight;
  const LandmarkId kept = keep ? landmark : other;
  map.ReplaceLandmark(keep ? other : landmark, kept);
  UpdateDescriptor(map, kept);
  UpdateViewingGeometry(map, kept, levels);
}

// Searches the landmarks in one keyframe. Merges them with the landmarks found there, or adds
// observations.
void FuseInto(Map& map, KeyframeId target, const std::vector<LandmarkId>& landmarks,
              const Sensor& sensor) {
  const std::shared_ptr<const Frame> frame = map.keyframes().At(target).frame;
  const std::vector<LandmarkId> known = ObservedLandmarks(map, std::span(&target, 1));
  std::vector<Projection> projections;
  std::vector<LandmarkId> ids;
  std::vector<Eigen::Vector3d> points_in_cam;
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = map.landmarks().Find(id);
    if (landmark == nullptr || std::ranges::binary_search(known, id)) {
      continue;
    }
    const auto view = ProjectLandmark(sensor, map.keyframes().At(target).cam_from_world, *landmark);
    if (!view) {
      continue;
    }
    Projection& projection = projections.emplace_back();
    projection.pixel = view->raw_pixel.cast<float>();
    projection.radius = kRadius * sensor.levels.scale[static_cast<size_t>(view->level)];
    projection.ExpectDepth(view->point_in_cam.z(), sensor.camera.bf);
    projection.min_level = view->level - 1;
    projection.max_level = view->level;
    projection.descriptor = landmark->descriptor;
    ids.push_back(id);
    points_in_cam.push_back(view->point_in_cam);
  }
  // Only keypoints at which the landmark may be are compared by their descriptors.
  const auto reprojects = [&](uint32_t query, uint32_t keypoint) {
    return IsInlier(sensor.camera,
                    MeasurePoint(sensor, frame->features, keypoint, sensor.depth_error),
                    points_in_cam[query]);
  };
  const std::vector<Match> matches = MatchByProjection(
      frame->features, projections, {}, {.max_distance = kMaxDistance, .may_match = reprojects});
  for (const Match& match : matches) {
    const LandmarkId landmark = map.Resolve(ids[match.query]);
    if (!landmark.IsValid()) {
      continue;
    }
    const LandmarkId other = map.keyframes().At(target).landmarks[match.keypoint];
    if (other.IsValid()) {
      Join(map, landmark, other, sensor.levels);
    } else if (map.AddObservation(landmark, target, match.keypoint)) {
      UpdateDescriptor(map, landmark);
      UpdateViewingGeometry(map, landmark, sensor.levels);
    }
  }
}

}  // namespace

std::vector<LandmarkId> CreateLandmarks(Map& map, KeyframeId id, const Sensor& sensor,
                                        MappingRule rule) {
  const LandmarkRules rules = LandmarkRules::ForSensor(sensor, rule);
  const std::vector<KeyframeId> neighbours =
      BestCovisible(map.keyframes().At(id), rules.neighbours);
  std::optional<NearbyDepth> nearby;
  if (rules.nearby_landmarks_decide) {
    nearby.emplace(map, map.keyframes().At(id), sensor);
  }
  std::vector<LandmarkId> created;
  for (const KeyframeId neighbour : neighbours) {
    for (const Match& pair :
         FindPairs(map, map.keyframes().At(id), map.keyframes().At(neighbour), sensor, rules)) {
      const SeenPoint a = MakeSeenPoint(map.keyframes().At(id), pair.query, sensor);
      const SeenPoint b = MakeSeenPoint(map.keyframes().At(neighbour), pair.keypoint, sensor);
      const std::optional<Eigen::Vector3d> point =
          nearby ? LocateMonocular(a, b, *nearby, sensor) : Locate(a, b, sensor);
      if (!point || !IsConsistent(a, b, *point, sensor)) {
        continue;
      }
      const LandmarkId landmark = map.AddLandmark(*point, id);
      map.AddObservation(landmark, id, pair.query);
      map.AddObservation(landmark, neighbour, pair.keypoint);
      UpdateDescriptor(map, landmark);
      UpdateViewingGeometry(map, landmark, sensor.levels);
      created.push_back(landmark);
    }
  }
  return created;
}

void FuseLandmarks(Map& map, KeyframeId id, const Sensor& sensor) {
  const std::vector<KeyframeId> targets = Neighbourhood(map, id);
  for (const KeyframeId target : targets) {
    FuseInto(map, target, ObservedLandmarks(map, std::span(&id, 1)), sensor);
  }
  FuseInto(map, id, ObservedLandmarks(map, targets), sensor);
  UpdateCovisibility(map, id);
}

}  // namespace hullslam
