// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapping/contradicted_landmarks.h"

#include <cmath>
#include <optional>
#include <vector>

#include "camera/point_measurement.h"
#include "map/covisibility.h"
#include "map/keyframe_order.h"
#include "map/landmark_projection.h"
#include "util/chi_square.h"

namespace hullslam {
namespace {

// A static landmark is contradicted by mistake in at most 2.5 % of the keyframes (one side of the
// bound below), so by three of them once in 60 000 times: less than one landmark in a map.
constexpr int kContradictions = 3;
// Samples of the depth grid on each side of the projection. Two are at least 8 px: color and depth
// images are shifted by some pixels where their stamps differ or the camera turns fast.
constexpr int kMargin = 2;

// The depths around the projection of a landmark compared with its own depth.
enum class Sight {
  kUnclear,  // it is not in view, depths are unknown, or something hides it
  kSurface,  // some depth is that of the landmark
  kPast,     // all depths are behind it
};

// The depth z (m) of a sample compared with that of a point, in standard deviations; positive if
// the sample is behind the point.
double SigmasBehind(const Sensor& sensor, const LandmarkProjection& view, double z) {
  const auto sample =
      PointMeasurement::Create(view.pixel, 1.0, sensor.camera.bf / z, sensor.depth_error);
  return PointResidual(sensor.camera, sample, view.point_in_cam).z();
}

Sight LookAt(const Sensor& sensor, const Keyframe& keyframe, const Landmark& landmark) {
  const DepthGrid& grid = keyframe.frame->depth;
  const std::optional<LandmarkProjection> view =
      ProjectLandmark(sensor, keyframe.cam_from_world, landmark);
  if (!view || grid.empty()) {
    return Sight::kUnclear;
  }
  // Both the depth of the landmark and that of the sample have this error.
  const double bound = std::sqrt(2.0 * Chi2Bound(1));
  const Eigen::Vector2d sample =
      (sensor.camera.Distort(view->pixel) - DepthGrid::RawPixel(0, 0)) / DepthGrid::kStep;
  const int first_column = static_cast<int>(std::floor(sample.x())) - kMargin + 1;
  const int first_row = static_cast<int>(std::floor(sample.y())) - kMargin + 1;
  bool is_past = true;
  for (int row = first_row; row < first_row + 2 * kMargin; ++row) {
    for (int column = first_column; column < first_column + 2 * kMargin; ++column) {
      const bool is_inside =
          row >= 0 && row < grid.rows() && column >= 0 && column < grid.columns();
      const double z = is_inside ? grid.At(column, row) : 0.0;
      const double behind = z > 0.0 ? SigmasBehind(sensor, *view, z) : -HUGE_VAL;
      if (std::abs(behind) <= bound) {
        return Sight::kSurface;
      }
      is_past &= behind > bound;
    }
  }
  return is_past ? Sight::kPast : Sight::kUnclear;
}

}  // namespace

size_t EraseContradictedLandmarks(Map& map, KeyframeId current, const Sensor& sensor,
                                  Contradictions<LandmarkId>& contradictions) {
  const Keyframe& keyframe = map.keyframes().At(current);
  if (keyframe.frame->depth.empty()) {
    return 0;
  }
  std::vector<KeyframeId> neighbours;
  for (const Covisible& neighbour : keyframe.covisible) {
    neighbours.push_back(neighbour.keyframe);
  }
  std::vector<LandmarkId> contradicted;
  for (const LandmarkId id : ObservedLandmarks(map, neighbours)) {
    const Landmark& landmark = map.landmarks().At(id);
    const FrameId last_seen = FrameIdOf(map, LastObserver(map, landmark.observations));
    if (last_seen >= keyframe.frame->id) {
      continue;
    }
    const Sight sight = LookAt(sensor, keyframe, landmark);
    if (sight == Sight::kSurface) {
      contradictions.Forget(id);
    } else if (sight == Sight::kPast && contradictions.Add(id, last_seen) == kContradictions) {
      contradicted.push_back(id);
    }
  }
  for (const LandmarkId id : contradicted) {
    contradictions.Forget(id);
    map.EraseLandmark(id);
  }
  return contradicted.size();
}

}  // namespace hullslam
