// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_sighting.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace hullslam {
namespace {

constexpr double kSizeFactor = 1.5;
constexpr double kClassShare = 0.25;

// Area, centre and covariance of a convex polygon.
struct AreaMoments {
  double area = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

// Sums over the triangles of a fan. The second moment of a triangle with a corner at the origin and
// the others at p and q is area / 12 (p p^T + q q^T + (p + q) (p + q)^T).
AreaMoments MomentsOf(const std::vector<Eigen::Vector2d>& polygon) {
  AreaMoments moments;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (size_t i = 2; i < polygon.size(); ++i) {
    const Eigen::Vector2d p = polygon[i - 1] - polygon[0];
    const Eigen::Vector2d q = polygon[i] - polygon[0];
    const double area = 0.5 * (p.x() * q.y() - p.y() * q.x());
    moments.area += area;
    first += area / 3.0 * (p + q);
    second += area / 12.0 * (p * p.transpose() + q * q.transpose() + (p + q) * (p + q).transpose());
  }
  if (moments.area > 0.0) {
    const Eigen::Vector2d offset = first / moments.area;
    moments.mean = polygon[0] + offset;
    moments.covariance = second / moments.area - offset * offset.transpose();
  }
  return moments;
}

}  // namespace

std::optional<ObjectSighting> SightObject(const PinholeCamera& camera, const Detection& detection) {
  if (detection.is_cut) {
    return std::nullopt;
  }
  std::vector<Eigen::Vector2d> hull;  // at depth 1
  for (const Eigen::Vector2d& pixel : detection.hull) {
    hull.push_back(camera.Unproject(pixel, 1.0).head<2>());
  }
  const AreaMoments moments = MomentsOf(hull);
  if (!(moments.area > 0.0)) {
    return std::nullopt;
  }
  ObjectSighting sighting;
  sighting.ray = moments.mean.homogeneous().normalized();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments.covariance);
  // The variance of an ellipse along a half axis is a quarter of its square.
  sighting.half_axes = 2.0 * solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
  const std::vector<Eigen::Vector3d> points = detection.points.Unpack();
  for (const Eigen::Vector3d& point : points) {
    sighting.surface += point.dot(sighting.ray) / static_cast<double>(points.size());
  }
  return sighting;
}

double DistanceOfCenter(const ObjectSighting& sighting, const Eigen::Vector3d& half_axes) {
  constexpr int kRounds = 3;  // the size of the silhouette depends on the distance
  const double volume = half_axes.prod();
  double distance = sighting.surface + 2.0 / 3.0 * std::cbrt(volume);
  for (int i = 0; i < kRounds; ++i) {
    const double z = distance * sighting.ray.z();
    const double front = 2.0 / 3.0 * volume / (z * z * sighting.half_axes.prod());
    distance = sighting.surface + std::clamp(front, 2.0 / 3.0 * half_axes.minCoeff(),
                                             2.0 / 3.0 * half_axes.maxCoeff());
  }
  return distance;
}

bool MayHaveSize(const ObjectSighting& sighting, double distance,
                 const Eigen::Vector3d& half_axes) {
  Eigen::Vector3d sorted = half_axes;
  std::sort(sorted.begin(), sorted.end());
  const Eigen::Vector2d seen = sighting.half_axes * distance * sighting.ray.z();
  const auto is_between = [](double value, double low, double high) {
    return value >= low / kSizeFactor && value <= high * kSizeFactor;
  };
  return is_between(seen[0], sorted[1], sorted[2]) && is_between(seen[1], sorted[0], sorted[1]);
}

bool MayHaveClass(const ObjectLandmark& object, const std::string& label) {
  double total = 0.0;
  for (const auto& [name, votes] : object.votes) {
    total += votes;
  }
  const auto found = object.votes.find(label);
  return found != object.votes.end() && found->second >= kClassShare * total;
}

}  // namespace hullslam
