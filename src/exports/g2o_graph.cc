// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "camera/point_measurement.h"
#include "exports/single_files.h"

namespace hullslam {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Edge = std::pair<KeyframeId, KeyframeId>;

std::set<Edge> EdgesOf(const Map& map) {
  std::set<Edge> edges;
  const auto add = [&](KeyframeId a, KeyframeId b) {
    if (map.keyframes().Find(a) != nullptr && map.keyframes().Find(b) != nullptr) {
      edges.insert(std::minmax(a, b));
    }
  };
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    add(id, keyframe.parent);
    for (const Covisible& other : keyframe.covisible) {
      add(id, other.keyframe);
    }
    for (const KeyframeId other : keyframe.loops) {
      add(id, other);
    }
  });
  return edges;
}

PointMeasurement MeasurementOf(const Frame& frame, size_t keypoint, const Sensor& sensor) {
  const Keypoint& seen = frame.features.keypoints[keypoint];
  const double depth = frame.features.depth[keypoint];
  PointMeasurement measurement = PointMeasurement::Create(
      seen.undistorted.cast<double>(), sensor.levels.scale[static_cast<size_t>(seen.level)],
      depth > 0.0 ? std::optional(sensor.camera.bf / depth) : std::nullopt, sensor.depth_error);
  if (sensor.camera.IsDistorted()) {
    measurement.TakeLens(sensor.camera.DistortionJacobian(seen.undistorted.cast<double>()));
  }
  return measurement;
}

// The derivative of a point in the second camera by g2o's error of the edge: a translation and the
// vector part of a quaternion, which is half of a small rotation. The motion of the second camera
// is multiplied on the right of first_from_second.
Eigen::Matrix<double, 3, 6> PointByError(const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 3, 6> derivative;
  derivative << -Eigen::Matrix3d::Identity(), 2.0 * Skew(point);
  return derivative;
}

Matrix6d InformationOf(const Map& map, const Keyframe& first, const Keyframe& second,
                       const Sensor& sensor) {
  constexpr int kLeastShared = 6;
  const std::set<LandmarkId> in_first(first.landmarks.begin(), first.landmarks.end());
  Matrix6d information = Matrix6d::Zero();
  int shared = 0;
  for (size_t i = 0; i < second.landmarks.size(); ++i) {
    const LandmarkId id = second.landmarks[i];
    if (!id.IsValid() || !in_first.contains(id)) {
      continue;
    }
    const Eigen::Vector3d point = second.cam_from_world * map.landmarks().At(id).position;
    if (point.z() < kMinDepth) {
      continue;
    }
    const PointLinearization linear(sensor.camera, MeasurementOf(*second.frame, i, sensor), point);
    const Eigen::Matrix<double, 3, 6> by_error = PointByError(point);
    information += by_error.transpose() * linear.Hessian() * by_error;
    ++shared;
  }
  return shared < kLeastShared ? Matrix6d::Identity() : information;
}

void AppendPose(const Rigid3& pose, std::string& text) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond q = pose.rotation.normalized();
  fmt::format_to(std::back_inserter(text), " {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}",
                 t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

std::string FormatG2o(const Map& map, const LocatedLandmarks& located, const Sensor& sensor) {
  std::string text;
  uint32_t next = 0;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    const bool is_first = text.empty();
    fmt::format_to(std::back_inserter(text), "VERTEX_SE3:QUAT {}", id.value);
    AppendPose(Inverse(keyframe.cam_from_world), text);
    text += is_first ? fmt::format("\nFIX {}\n", id.value) : "\n";
    next = id.value + 1;
  });
  for (const Eigen::Vector3d& position : located.positions) {
    fmt::format_to(std::back_inserter(text), "VERTEX_TRACKXYZ {} {:.9f} {:.9f} {:.9f}\n", next++,
                   position.x(), position.y(), position.z());
  }
  for (const auto& [first_id, second_id] : EdgesOf(map)) {
    const Keyframe& first = map.keyframes().At(first_id);
    const Keyframe& second = map.keyframes().At(second_id);
    fmt::format_to(std::back_inserter(text), "EDGE_SE3:QUAT {} {}", first_id.value,
                   second_id.value);
    AppendPose(first.cam_from_world * Inverse(second.cam_from_world), text);
    const Matrix6d information = InformationOf(map, first, second, sensor);
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = row; column < 6; ++column) {
        fmt::format_to(std::back_inserter(text), " {:.6g}", information(row, column));
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace hullslam
