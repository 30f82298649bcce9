// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/kannala_brandt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hullslam {
namespace {

double SlopeOfAngle(const PinholeCamera& camera, double angle) {
  const double t2 = angle * angle;
  return 1.0 + t2 * (3.0 * camera.k1 +
                     t2 * (5.0 * camera.k2 + t2 * (7.0 * camera.k3 + t2 * 9.0 * camera.k4)));
}

}  // namespace

double RadiusOfAngle(const PinholeCamera& camera, double angle) {
  const double t2 = angle * angle;
  return angle * (1.0 + t2 * (camera.k1 + t2 * (camera.k2 + t2 * (camera.k3 + t2 * camera.k4))));
}

// With x = r cos(phi), y = r sin(phi), the angle t = atan(r) and the radius d(t), the radial scale
// is d' / (1 + r^2) and the scale across is d / r.
LensPoint DistortKannalaBrandt(const PinholeCamera& camera, const Eigen::Vector2d& point) {
  constexpr double kTiny = 1e-9;
  const double r = point.norm();
  if (r < kTiny) {
    return {point, Eigen::Matrix2d::Identity()};
  }
  const double angle = std::atan(r);
  const double across = RadiusOfAngle(camera, angle) / r;
  const double along = SlopeOfAngle(camera, angle) / (1.0 + r * r);
  const Eigen::Vector2d direction = point / r;
  return {across * point, across * Eigen::Matrix2d::Identity() +
                              (along - across) * direction * direction.transpose()};
}

double LargestAngle(const PinholeCamera& camera, double limit) {
  // No terms below zero can outweigh the 1 of the slope at any smaller angle if they do not here.
  const double t2 = limit * limit;
  const double below = std::min(0.0, 3.0 * camera.k1 * t2) +
                       std::min(0.0, 5.0 * camera.k2 * t2 * t2) +
                       std::min(0.0, 7.0 * camera.k3 * t2 * t2 * t2) +
                       std::min(0.0, 9.0 * camera.k4 * t2 * t2 * t2 * t2);
  if (below > -1.0) {
    return limit;
  }
  constexpr double kStep = 0.2 * std::numbers::pi / 180.0;
  double largest = 0.0;
  // The comparison is written so that a NaN is a fold.
  while (largest < limit && SlopeOfAngle(camera, largest + kStep) > 0.0) {
    largest += kStep;
  }
  return std::min(largest, limit);
}

// Newton's method in a bracket, in which the radius grows with the angle.
double AngleOfRadius(const PinholeCamera& camera, double radius, double largest) {
  if (!(radius < RadiusOfAngle(camera, largest))) {
    return largest;
  }
  double low = 0.0;
  double high = largest;
  double angle = std::min(radius, largest);
  constexpr int kMaxIterations = 60;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double error = RadiusOfAngle(camera, angle) - radius;
    if (std::abs(error) < 1e-14) {
      break;
    }
    (error > 0.0 ? high : low) = angle;
    const double next = angle - error / SlopeOfAngle(camera, angle);
    angle = next > low && next < high ? next : 0.5 * (low + high);
  }
  return angle;
}

Eigen::Vector2d UndistortKannalaBrandt(const PinholeCamera& camera, const Eigen::Vector2d& target) {
  constexpr double kTiny = 1e-9;
  const double radius = target.norm();
  if (radius < kTiny) {
    return target;
  }
  const double largest = LargestAngle(camera, PinholeCamera::kMostAngle);
  return target * (std::tan(AngleOfRadius(camera, radius, largest)) / radius);
}

double FoldOfKannalaBrandt(const PinholeCamera& camera) {
  const double largest = LargestAngle(camera, std::numbers::pi);
  return largest < std::numbers::pi ? RadiusOfAngle(camera, largest)
                                    : std::numeric_limits<double>::infinity();
}

Eigen::Vector3d RayOfRawPixel(const PinholeCamera& camera, const Eigen::Vector2d& raw,
                              double largest) {
  const Eigen::Vector2d target((raw.x() - camera.cx) / camera.fx,
                               (raw.y() - camera.cy) / camera.fy);
  const double radius = target.norm();
  if (radius == 0.0) {
    return Eigen::Vector3d::UnitZ();
  }
  const double angle = AngleOfRadius(camera, radius, largest);
  const Eigen::Vector2d side = std::sin(angle) / radius * target;
  return {side.x(), side.y(), std::cos(angle)};
}

Eigen::Vector2d RawPixelOfRay(const PinholeCamera& camera, const Eigen::Vector3d& ray) {
  const double side = ray.head<2>().norm();
  const double scale = side == 0.0 ? 0.0 : RadiusOfAngle(camera, std::atan2(side, ray.z())) / side;
  return {camera.fx * scale * ray.x() + camera.cx, camera.fy * scale * ray.y() + camera.cy};
}

}  // namespace hullslam
