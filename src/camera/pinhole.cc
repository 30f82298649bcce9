// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/pinhole.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

namespace hullslam {
namespace {

// The number with up to six digits.
std::string Print(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

struct Distortion {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

// Brown's model on normalised coordinates, with its derivative.
Distortion DistortNormalized(const PinholeCamera& camera, const Eigen::Vector2d& p) {
  const double x = p.x();
  const double y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (camera.k1 + r2 * (camera.k2 + r2 * camera.k3));
  const double slope =
      camera.k1 + r2 * (2.0 * camera.k2 + 3.0 * r2 * camera.k3);  // d radial / d r2
  const double p1 = camera.p1;
  const double p2 = camera.p2;
  Distortion result;
  result.point = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
                  y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  result.jacobian(0, 0) = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
  result.jacobian(0, 1) = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
  result.jacobian(1, 0) = result.jacobian(0, 1);
  result.jacobian(1, 1) = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return result;
}

constexpr double kLeastFocalLength = 10.0;  // px
constexpr double kMostFocalLength = 1e5;
constexpr double kMostPrincipalPoint = 1e5;
constexpr double kLeastBaselineTimesFx = 1e-3;  // m px
constexpr double kMostBaselineTimesFx = 1e6;

std::string Describe(const char* key, double value, const Range& range) {
  return range.Contains(value) ? std::string()
                               : std::string(key) + " is '" + Print(value) +
                                     "', expected a number " + range.ToString();
}

// The name of the coefficient that moves a raw pixel most.
std::string NameCoefficient(const PinholeCamera& camera, const Eigen::Vector2d& raw) {
  const double r = std::hypot((raw.x() - camera.cx) / camera.fx, (raw.y() - camera.cy) / camera.fy);
  struct Term {
    const char* key;
    double coefficient;
    double factor;
  };
  const std::array<Term, 5> terms = {{{"Camera.k1", camera.k1, std::pow(r, 2)},
                                      {"Camera.k2", camera.k2, std::pow(r, 4)},
                                      {"Camera.k3", camera.k3, std::pow(r, 6)},
                                      {"Camera.p1", camera.p1, r},
                                      {"Camera.p2", camera.p2, r}}};
  const auto largest =
      std::max_element(terms.begin(), terms.end(), [](const auto& a, const auto& b) {
        return std::abs(a.coefficient) * a.factor < std::abs(b.coefficient) * b.factor;
      });
  return std::string(largest->key) + " is '" + Print(largest->coefficient) + "': ";
}

// A pixel of the image at which the distortion has no inverse.
std::optional<Eigen::Vector2d> FindFold(const PinholeCamera& camera) {
  constexpr int kSteps = 16;
  constexpr double kMostError = 0.1;  // px
  constexpr double kSmallestSlope = 1e-3;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d raw(static_cast<double>(camera.width) * j / kSteps,
                                static_cast<double>(camera.height) * i / kSteps);
      const Eigen::Vector2d p = camera.Undistort(raw);
      const Distortion distortion = DistortNormalized(
          camera, {(p.x() - camera.cx) / camera.fx, (p.y() - camera.cy) / camera.fy});
      // The comparisons are written so that a NaN is a fold.
      const bool has_inverse = (camera.Distort(p) - raw).norm() <= kMostError &&
                               distortion.jacobian.determinant() >= kSmallestSlope;
      if (!has_inverse) {
        return raw;
      }
    }
  }
  return std::nullopt;
}

std::string FindDistortionFault(const PinholeCamera& camera) {
  if (const std::optional<Eigen::Vector2d> fold = FindFold(camera)) {
    return NameCoefficient(camera, *fold) + "the distortion cannot be undone at pixel (" +
           Print(fold->x()) + ", " + Print(fold->y()) + "), expected the coefficients of a lens";
  }
  constexpr double kMostStretch = 4.0;
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  const double stretch_x = (bounds.max_x - bounds.min_x) / camera.width;
  const double stretch_y = (bounds.max_y - bounds.min_y) / camera.height;
  const Range range = Range::Between(1.0 / kMostStretch, kMostStretch);
  if (!range.Contains(stretch_x) || !range.Contains(stretch_y)) {
    return NameCoefficient(camera, Eigen::Vector2d::Zero()) + "the undistorted image would have " +
           Print(stretch_x) + " times the width and " + Print(stretch_y) +
           " times the height of the image, expected " + range.ToString();
  }
  return {};
}

}  // namespace

void PinholeCamera::Bind(OptionTable& options) {
  const OptionScope scope(options, "Camera");
  scope.Add("fx", &fx, Range::Between(kLeastFocalLength, kMostFocalLength),
            "focal length in x, px");
  scope.Add("fy", &fy, Range::Between(kLeastFocalLength, kMostFocalLength),
            "focal length in y, px");
  scope.Add("cx", &cx, Range::Between(-kMostPrincipalPoint, kMostPrincipalPoint),
            "principal point in x, px");
  scope.Add("cy", &cy, Range::Between(-kMostPrincipalPoint, kMostPrincipalPoint),
            "principal point in y, px");
  scope.Add("k1", &k1, Range::Any(), "radial distortion, second order");
  scope.Add("k2", &k2, Range::Any(), "radial distortion, fourth order");
  scope.Add("p1", &p1, Range::Any(), "tangential distortion");
  scope.Add("p2", &p2, Range::Any(), "tangential distortion");
  scope.Add("k3", &k3, Range::Any(), "radial distortion, sixth order");
  scope.Add("width", &width, Range::Between(16, 16384), "width of the images, px");
  scope.Add("height", &height, Range::Between(16, 16384), "height of the images, px");
  scope.Add("bf", &bf, Range::Between(kLeastBaselineTimesFx, kMostBaselineTimesFx),
            "baseline of the virtual stereo camera (m) times fx (px)");
}

Eigen::Vector2d PinholeCamera::Distort(const Eigen::Vector2d& undistorted) const {
  const Eigen::Vector2d normalized((undistorted.x() - cx) / fx, (undistorted.y() - cy) / fy);
  const Eigen::Vector2d distorted = DistortNormalized(*this, normalized).point;
  return {fx * distorted.x() + cx, fy * distorted.y() + cy};
}

Eigen::Vector2d PinholeCamera::Undistort(const Eigen::Vector2d& raw) const {
  if (!IsDistorted()) {
    return raw;
  }
  const Eigen::Vector2d target((raw.x() - cx) / fx, (raw.y() - cy) / fy);
  Eigen::Vector2d estimate = target;
  constexpr int kMaxIterations = 20;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Distortion distortion = DistortNormalized(*this, estimate);
    const Eigen::Vector2d error = distortion.point - target;
    if (error.squaredNorm() < 1e-20) {
      break;
    }
    if (distortion.jacobian.determinant() <= 1e-6) {
      break;  // the polynomial folds here and has no inverse beyond
    }
    estimate -= distortion.jacobian.inverse() * error;
  }
  return {fx * estimate.x() + cx, fy * estimate.y() + cy};
}

PinholeCamera::Bounds PinholeCamera::UndistortedBounds() const {
  Bounds bounds{.min_x = std::numeric_limits<double>::max(),
                .min_y = std::numeric_limits<double>::max(),
                .max_x = std::numeric_limits<double>::lowest(),
                .max_y = std::numeric_limits<double>::lowest()};
  const auto include = [&](double x, double y) {
    const Eigen::Vector2d p = Undistort({x, y});
    bounds.min_x = std::min(bounds.min_x, p.x());
    bounds.min_y = std::min(bounds.min_y, p.y());
    bounds.max_x = std::max(bounds.max_x, p.x());
    bounds.max_y = std::max(bounds.max_y, p.y());
  };
  // The whole border is used, not only the corners: with barrel distortion the middle of a side
  // bulges out.
  constexpr int kSteps = 32;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = static_cast<double>(width) * i / kSteps;
    const double y = static_cast<double>(height) * i / kSteps;
    include(x, 0.0);
    include(x, height);
    include(0.0, y);
    include(width, y);
  }
  return bounds;
}

std::string PinholeCamera::FindFault() const {
  const Range focal_length = Range::Between(kLeastFocalLength, kMostFocalLength);
  const Range principal_point = Range::Between(-kMostPrincipalPoint, kMostPrincipalPoint);
  struct Number {
    const char* key;
    double value;
    Range range;
  };
  const std::array<Number, 10> numbers = {
      {{"Camera.fx", fx, focal_length},
       {"Camera.fy", fy, focal_length},
       {"Camera.cx", cx, principal_point},
       {"Camera.cy", cy, principal_point},
       {"Camera.bf", bf, Range::Between(kLeastBaselineTimesFx, kMostBaselineTimesFx)},
       {"Camera.k1", k1, Range::Any()},
       {"Camera.k2", k2, Range::Any()},
       {"Camera.k3", k3, Range::Any()},
       {"Camera.p1", p1, Range::Any()},
       {"Camera.p2", p2, Range::Any()}}};
  for (const Number& number : numbers) {
    std::string fault = Describe(number.key, number.value, number.range);
    if (!fault.empty()) {
      return fault;
    }
  }
  return IsDistorted() ? FindDistortionFault(*this) : std::string();
}

}  // namespace hullslam
