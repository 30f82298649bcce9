// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <vector>

#include "map/islands.h"
#include "matching/by_projection.h"
#include "tracking/frame_objects.h"
#include "tracking/pose_refinement.h"
#include "tracking/sources/pose_source.h"
#include "util/statistics.h"

namespace hullslam {
namespace {

// Radius of the search, px at level 0 of an image of this width (Mur-Artal and Tardos 2017).
constexpr double kSearchRadius = 15.0;
constexpr double kWidthOfRadius = 640.0;

struct LevelRange {
  int min = 0;
  int max = 0;
};

// When the camera moves forward, patches grow and are found at higher levels; when it moves
// backward, they are found at lower levels. For a monocular sensor the motion is not known in
// metres, so only a change by one level is allowed, in both directions.
LevelRange LevelsAfterMotion(int level, double forward, const Sensor& sensor) {
  if (sensor.IsMonocular() || std::abs(forward) <= sensor.baseline()) {
    return {level - 1, level + 1};
  }
  return forward > 0.0 ? LevelRange{level, sensor.levels.count() - 1} : LevelRange{0, level};
}

struct Expected {
  std::vector<Projection> projections;
  std::vector<LandmarkId> landmarks;  // one per projection
  std::vector<float> distances;       // px; how far they are expected to move, one per projection
};

// px at level 0. A prediction is wrong by an angle, which is more pixels in a larger image.
double SearchRadius(const Sensor& sensor, bool is_wide) {
  return is_wide ? kSearchRadius * std::max(1.0, sensor.camera.width / kWidthOfRadius)
                 : kSearchRadius;
}

// The expected pixels of the last frame's landmarks for a camera at `cam_from_world`.
Expected ExpectLandmarks(const Map& map, const Sensor& sensor, const LastFrame& last,
                         const Rigid3& cam_from_world, double forward, bool is_wide) {
  Expected expected;
  const auto radius = static_cast<float>(SearchRadius(sensor, is_wide));
  for (size_t i = 0; i < last.landmarks.size(); ++i) {
    const Landmark* landmark = map.landmarks().Find(last.landmarks[i]);
    if (landmark == nullptr) {
      continue;
    }
    const Eigen::Vector3d point = cam_from_world * landmark->position;
    if (point.z() <= 0.0) {
      continue;
    }
    const auto pixel = sensor.RawPixel(sensor.camera.Project(point));
    if (!pixel) {
      continue;
    }
    const FrameFeatures& features = last.frame->features;
    const Keypoint& seen = features.keypoints[i];
    const LevelRange levels = LevelsAfterMotion(seen.level, forward, sensor);
    Projection& projection = expected.projections.emplace_back();
    projection.pixel = pixel->cast<float>();
    projection.radius = radius * sensor.levels.scale[static_cast<size_t>(seen.level)];
    projection.ExpectDepth(point.z(), sensor.camera.bf);
    projection.min_level = levels.min;
    projection.max_level = levels.max;
    projection.descriptor = landmark->descriptor;
    projection.angle = seen.angle;
    expected.landmarks.push_back(last.landmarks[i]);
    expected.distances.push_back(
        (projection.pixel - features.grid.PositionOf(features.keypoints, static_cast<uint32_t>(i)))
            .norm());
  }
  return expected;
}

// Searches in windows that double until at least `enough` landmarks are found. They double at least
// once, and then as long as they are smaller than the motion. A camera may stop or double its
// velocity from one frame to the next, and then its landmarks are as far from their expected pixels
// as they were expected to move: far if the motion is fast or there are few frames per second.
// Unless the search is wide, they double once.
std::vector<Match> SearchLandmarks(const Frame& frame, const Sensor& sensor, size_t enough,
                                   bool is_wide, Expected& expected) {
  const ProjectionSearch search{.max_distance = 100, .compare_rotation = true};
  std::vector<Match> matches = MatchByProjection(frame.features, expected.projections, {}, search);
  if (expected.projections.empty()) {
    return matches;
  }
  double radius = SearchRadius(sensor, is_wide);
  const double motion = is_wide ? static_cast<double>(Median(expected.distances)) : 0.0;
  const double largest = std::max(2.0 * radius, motion);
  while (matches.size() < enough && radius < largest) {
    radius *= 2.0;
    for (Projection& projection : expected.projections) {
      projection.radius *= 2.0f;
    }
    matches = MatchByProjection(frame.features, expected.projections, {}, search);
  }
  return matches;
}

}  // namespace

std::optional<PoseEstimate> PoseByMotionModel(const Frame& frame, const Map& map,
                                              const TrackingContext& context,
                                              const LastFrame& last) {
  const std::optional<Rigid3> motion = PredictMotion(last, frame.timestamp);
  if (!motion) {
    return std::nullopt;
  }
  PoseEstimate estimate;
  estimate.cam_from_world = *motion * last.cam_from_world;
  const double forward = Inverse(*motion).translation.z();
  const bool is_wide = context.options.wide_search;
  Expected expected =
      ExpectLandmarks(map, context.sensor, last, estimate.cam_from_world, forward, is_wide);
  const std::vector<Match> matches =
      SearchLandmarks(frame, context.sensor, context.min_motion_matches(), is_wide, expected);
  estimate.landmarks.resize(frame.features.size());
  for (const Match& match : matches) {
    estimate.landmarks[match.keypoint] = expected.landmarks[match.query];
  }
  // Objects are only searched if there are too few landmarks without them.
  PoseObjects objects;
  if (matches.size() < context.min_motion_matches() && context.objects.joint_pose) {
    const IslandId island = IslandOf(map, last.reference);
    objects =
        MakePoseObjects(map, context.sensor, frame, estimate.cam_from_world,
                        FindMappedObjects(frame, map, context, estimate, island), context.objects);
  }
  if (matches.size() + PoseEstimate::kLandmarksPerObject * objects.objects.size() <
      context.min_motion_matches()) {
    // The local map may have other landmarks where a motion prior leads.
    estimate.landmarks.assign(frame.features.size(), LandmarkId());
    return last.ahead ? std::optional(std::move(estimate)) : std::nullopt;
  }
  estimate = RefinePose(frame, map, context, objects.objects, std::move(estimate));
  return estimate.EffectiveInliers() >= context.min_start_inliers()
             ? std::optional(std::move(estimate))
             : std::nullopt;
}

}  // namespace hullslam
