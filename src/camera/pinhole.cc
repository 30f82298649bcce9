// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/camera/pinhole.h"

#include <algorithm>
#include <array>
#include <limits>

#include "camera/brown.h"
#include "camera/lens_fault.h"
#include "camera/wide_lens.h"

namespace hullslam {
namespace {

constexpr double kLeastFocalLength = 10.0;  // px
constexpr double kMostFocalLength = 1e5;
constexpr double kMostPrincipalPoint = 1e5;
constexpr double kLeastBaselineTimesFx = 1e-3;  // m px
constexpr double kMostBaselineTimesFx = 1e6;

Range RangeOfXi() { return Range::Between(-0.9, 1.0); }
Range RangeOfBeta() { return Range::Between(1e-3, 1e3); }

std::string Describe(const char* key, double value, const Range& range) {
  return range.Contains(value) ? std::string()
                               : std::string(key) + " is '" + PrintNumber(value) +
                                     "', expected a number " + range.ToString();
}

LensPoint DistortNormalized(const PinholeCamera& camera, const Eigen::Vector2d& point) {
  return camera.IsFisheye() ? DistortWide(camera, point) : DistortBrown(camera, point);
}

Eigen::Vector2d Normalized(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
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
  scope.Add("k4", &k4, Range::Any(), "radial divisor; the fourth of a fisheye");
  scope.Add("k5", &k5, Range::Any(), "radial divisor");
  scope.Add("k6", &k6, Range::Any(), "radial divisor");
  scope.AddEnum("type", &lens, LensTypes(), "lens");
  scope.Add("xi", &xi, RangeOfXi(), "distance of the spheres of DoubleSphere");
  scope.Add("alpha", &alpha, Range::Share(), "share of DoubleSphere and EUCM");
  scope.Add("beta", &beta, RangeOfBeta(), "shape of EUCM");
  scope.Add("width", &width, Range::Between(16, 16384), "width of the images, px");
  scope.Add("height", &height, Range::Between(16, 16384), "height of the images, px");
  scope.Add("bf", &bf, Range::Between(kLeastBaselineTimesFx, kMostBaselineTimesFx),
            "baseline of the virtual stereo camera (m) times fx (px)");
}

bool PinholeCamera::IsDistorted() const {
  return IsFisheye() || k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0 ||
         k4 != 0.0 || k5 != 0.0 || k6 != 0.0;
}

Eigen::Vector2d PinholeCamera::Distort(const Eigen::Vector2d& undistorted) const {
  if (!IsDistorted()) {
    return undistorted;
  }
  const Eigen::Vector2d distorted = DistortNormalized(*this, Normalized(*this, undistorted)).point;
  return {fx * distorted.x() + cx, fy * distorted.y() + cy};
}

Eigen::Matrix2d PinholeCamera::DistortionJacobian(const Eigen::Vector2d& undistorted) const {
  if (!IsDistorted()) {
    return Eigen::Matrix2d::Identity();
  }
  const Eigen::Vector2d focal(fx, fy);
  return focal.asDiagonal() * DistortNormalized(*this, Normalized(*this, undistorted)).jacobian *
         focal.cwiseInverse().asDiagonal();
}

Eigen::Vector2d PinholeCamera::Undistort(const Eigen::Vector2d& raw) const {
  if (!IsDistorted()) {
    return raw;
  }
  const Eigen::Vector2d target = Normalized(*this, raw);
  const Eigen::Vector2d point =
      IsFisheye() ? UndistortWide(*this, target) : UndistortBrown(*this, target);
  return {fx * point.x() + cx, fy * point.y() + cy};
}

bool PinholeCamera::SeesRaw(const Eigen::Vector2d& raw) const {
  const bool is_inside = raw.x() >= 0.0 && raw.y() >= 0.0 && raw.x() < width && raw.y() < height;
  return is_inside &&
         (!IsFisheye() || Normalized(*this, raw).norm() <= RadiusOfAngle(*this, kMostAngle));
}

bool PinholeCamera::IsWide() const {
  if (!IsFisheye()) {
    return false;
  }
  const double right = width - 1;
  const double bottom = height - 1;
  return !SeesRaw({0.0, 0.0}) || !SeesRaw({right, 0.0}) || !SeesRaw({0.0, bottom}) ||
         !SeesRaw({right, bottom});
}

double PinholeCamera::FoldRadius() const {
  return std::min(fx, fy) * (IsFisheye() ? FoldOfWide(*this) : FoldOfBrown(*this));
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
  // Kalibr's focal lengths are divided by 1 + xi, so xi comes first.
  const std::array<Number, 16> numbers = {
      {{"Camera.xi", xi, RangeOfXi()},
       {"Camera.fx", fx, focal_length},
       {"Camera.fy", fy, focal_length},
       {"Camera.cx", cx, principal_point},
       {"Camera.cy", cy, principal_point},
       {"Camera.bf", bf, Range::Between(kLeastBaselineTimesFx, kMostBaselineTimesFx)},
       {"Camera.k1", k1, Range::Any()},
       {"Camera.k2", k2, Range::Any()},
       {"Camera.k3", k3, Range::Any()},
       {"Camera.p1", p1, Range::Any()},
       {"Camera.p2", p2, Range::Any()},
       {"Camera.k4", k4, Range::Any()},
       {"Camera.k5", k5, Range::Any()},
       {"Camera.k6", k6, Range::Any()},
       {"Camera.alpha", alpha, Range::Share()},
       {"Camera.beta", beta, RangeOfBeta()}}};
  for (const Number& number : numbers) {
    std::string fault = Describe(number.key, number.value, number.range);
    if (!fault.empty()) {
      return fault;
    }
  }
  return FindLensFault(*this);
}

}  // namespace hullslam
