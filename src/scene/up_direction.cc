// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/up_direction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hullslam {
namespace {

constexpr double kMostPoseGap = 0.1;  // s, between the two poses from which one is interpolated
// Least length of the mean of unit vectors that should be equal: a spread of about 15 degrees.
constexpr double kLeastAgreement = 0.95;
// Least cosine between the tops of the images and the axis that is upwards: 60 degrees.
constexpr double kLeastUpright = 0.5;

constexpr size_t kMostPoints = 3000;  // landmarks that are used; more make it no better
constexpr size_t kLeastPoints = 100;
constexpr double kSearchAngle = 50.0;  // degrees around the tops of the images
constexpr double kBinShare = 0.01;     // width of a bin, as a share of the extent of the scene
// Least concentration along the direction, relative to the median over all directions.
constexpr double kLeastConcentration = 1.5;

Eigen::Vector3d MeanTop(const Trajectory& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : poses) {
    sum += pose.world_from_cam.rotation * -Eigen::Vector3d::UnitY();
  }
  return sum / static_cast<double>(std::max<size_t>(1, poses.size()));
}

// The signed coordinate axis that is nearest to a vector.
Eigen::Vector3d NearestAxis(const Eigen::Vector3d& vector) {
  Eigen::Index axis = 0;
  vector.cwiseAbs().maxCoeff(&axis);
  return std::copysign(1.0, vector[axis]) * Eigen::Vector3d::Unit(axis);
}

// Points of which at least a few are near each other along horizontal planes, around the origin.
std::vector<Eigen::Vector3d> ChoosePoints(std::span<const Eigen::Vector3d> landmarks) {
  const size_t step = std::max<size_t>(1, landmarks.size() / kMostPoints);
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < landmarks.size(); i += step) {
    points.push_back(landmarks[i]);
    sum += landmarks[i];
  }
  for (Eigen::Vector3d& point : points) {
    point -= sum / static_cast<double>(points.size());
  }
  // The most distant tenth would make the bins too wide.
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  points.resize(points.size() * 9 / 10);
  return points;
}

// The probability that two points are in the same bin along the direction.
double Concentration(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& direction,
                     double extent, std::vector<double>& bins) {
  const double width = 2.0 * kBinShare * extent;
  bins.assign(static_cast<size_t>(std::ceil(2.0 * extent / width)) + 2, 0.0);
  for (const Eigen::Vector3d& point : points) {
    // Each point is shared between two bins, so that the result does not depend on their borders.
    const double place = (direction.dot(point) + extent) / width;
    const auto bin = static_cast<size_t>(std::clamp(place, 0.0, 2.0 * extent / width));
    const double share = std::clamp(place - static_cast<double>(bin), 0.0, 1.0);
    bins[bin] += 1.0 - share;
    bins[bin + 1] += share;
  }
  double sum = 0.0;
  for (const double bin : bins) {
    sum += bin * bin;
  }
  return sum / static_cast<double>(points.size() * points.size());
}

// The direction that is `tilt` radians from `axis`, turned by `turn` around it.
Eigen::Vector3d Tilted(const Eigen::Vector3d& axis, double tilt, double turn) {
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d side = std::cos(turn) * across + std::sin(turn) * axis.cross(across);
  return std::cos(tilt) * axis + std::sin(tilt) * side;
}

struct Search {
  Eigen::Vector3d best;
  double concentration = 0.0;
  std::vector<double> all;  // the concentrations of all directions
};

// Tries the directions within `angle` radians of `around`, `step` radians apart.
Search SearchAround(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& around,
                    double angle, double step) {
  const double extent = points.back().norm();
  std::vector<double> bins;
  Search search{.best = around, .all = {}};
  for (double tilt = 0.0; tilt <= angle; tilt += step) {
    const int turns =
        std::max(1, static_cast<int>(std::ceil(2.0 * std::numbers::pi * std::sin(tilt) / step)));
    for (int i = 0; i < turns; ++i) {
      const Eigen::Vector3d direction =
          Tilted(around, tilt, 2.0 * std::numbers::pi * i / static_cast<double>(turns));
      search.all.push_back(Concentration(points, direction, extent, bins));
      if (search.all.back() > search.concentration) {
        search.concentration = search.all.back();
        search.best = direction;
      }
    }
  }
  return search;
}

}  // namespace

UpDirection UpFromGroundtruth(const Trajectory& groundtruth, const Trajectory& poses) {
  const Eigen::Vector3d tops = MeanTop(groundtruth);
  const Eigen::Vector3d axis = NearestAxis(tops);
  if (groundtruth.empty() || tops.dot(axis) < kLeastUpright * std::max(tops.norm(), 0.5)) {
    return {std::nullopt, "unknown: the camera of the ground truth was not held upright"};
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  size_t count = 0;
  for (const StampedPose& pose : poses) {
    if (const auto truth = InterpolatePose(groundtruth, pose.timestamp, kMostPoseGap)) {
      sum += pose.world_from_cam.rotation * (truth->rotation.conjugate() * axis);
      ++count;
    }
  }
  if (count == 0) {
    return {std::nullopt, "unknown: no pose has a true pose of the same time"};
  }
  if (sum.norm() < kLeastAgreement * static_cast<double>(count)) {
    return {std::nullopt, "unknown: the poses do not agree with the ground truth"};
  }
  return {sum.normalized(), "ground truth"};
}

UpDirection UpFromPlanes(std::span<const Eigen::Vector3d> landmarks, const Trajectory& poses) {
  const Eigen::Vector3d tops = MeanTop(poses);
  if (landmarks.size() < kLeastPoints) {
    return {std::nullopt, "unknown: no ground truth, and too few landmarks"};
  }
  if (tops.norm() < kLeastUpright) {
    return {std::nullopt, "unknown: no ground truth, and the camera was held in many ways"};
  }
  constexpr double kDegree = std::numbers::pi / 180.0;
  const std::vector<Eigen::Vector3d> points = ChoosePoints(landmarks);
  Search search = SearchAround(points, tops.normalized(), kSearchAngle * kDegree, 2.0 * kDegree);
  std::nth_element(search.all.begin(), search.all.begin() + search.all.size() / 2,
                   search.all.end());
  const double median = search.all[search.all.size() / 2];
  for (const double step : {0.7 * kDegree, 0.2 * kDegree}) {
    search = SearchAround(points, search.best, 3.0 * step, step);
  }
  if (search.concentration < kLeastConcentration * median) {
    return {std::nullopt, "unknown: no ground truth, and the landmarks show no horizontal planes"};
  }
  return {search.best, "planes"};
}

std::optional<Eigen::Vector3d> UpFromImages(const Trajectory& poses) {
  constexpr double kLeastMean = 0.2;  // length of the mean of the unit vectors
  const Eigen::Vector3d tops = MeanTop(poses);
  return tops.norm() >= kLeastMean ? std::optional(tops.normalized()) : std::nullopt;
}

UpDirection FindUp(const std::optional<Trajectory>& groundtruth, const Trajectory& poses,
                   std::span<const Eigen::Vector3d> landmarks) {
  if (groundtruth) {
    const UpDirection from_truth = UpFromGroundtruth(*groundtruth, poses);
    if (from_truth.up) {
      return from_truth;
    }
  }
  return UpFromPlanes(landmarks, poses);
}

}  // namespace hullslam
