// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/wide_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "util/text.h"

namespace hullslam {
namespace {

// Where a lens has no image of a ray: outside of any image.
constexpr double kNowhere = 1e9;

// sin(t) / d and its derivative.
LensRadius SineOver(double sine, double cosine, double d, double slope_of_d) {
  return d > 0.0 ? LensRadius{.radius = std::min(sine / d, kNowhere),
                              .slope = (cosine * d - sine * slope_of_d) / (d * d)}
                 : LensRadius{.radius = kNowhere, .slope = 0.0};
}

// ---- Kannala and Brandt 2006

LensRadius RadiusOfKannalaBrandt(const PinholeCamera& camera, double angle) {
  const double t2 = angle * angle;
  const double factor =
      1.0 + t2 * (camera.k1 + t2 * (camera.k2 + t2 * (camera.k3 + t2 * camera.k4)));
  const double slope =
      1.0 + t2 * (3.0 * camera.k1 +
                  t2 * (5.0 * camera.k2 + t2 * (7.0 * camera.k3 + t2 * 9.0 * camera.k4)));
  return {.radius = angle * factor, .slope = slope};
}

double LargestOfKannalaBrandt(const PinholeCamera& camera, double limit) {
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
  while (largest < limit && RadiusOfKannalaBrandt(camera, largest + kStep).slope > 0.0) {
    largest += kStep;
  }
  return std::min(largest, limit);
}

// ---- Double sphere (Usenko, Demmel and Cremers 2018, equations 40 to 46)

// The smaller one of alpha / (1 - alpha) and its inverse.
double SmallerShare(double alpha) {
  return alpha <= 0.5 ? alpha / (1.0 - alpha) : (1.0 - alpha) / alpha;
}

// The radius is (1 + xi) sin(t) / d with d = alpha d2 + (1 - alpha) (xi + cos(t)) and d2^2 =
// sin(t)^2 + (xi + cos(t))^2. The factor, which the paper has in the focal length, makes the scale
// on the axis 1, as that of the other lenses, so that a pixel of the undistorted image means one of
// the raw image there.
LensRadius RadiusOfDoubleSphere(const PinholeCamera& camera, double angle) {
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const double z = camera.xi + cosine;
  const double d2 = std::hypot(sine, z);
  const double factor = 1.0 / (1.0 + camera.xi);
  const double d = factor * (camera.alpha * d2 + (1.0 - camera.alpha) * z);
  const double slope_of_d = -factor * sine * (camera.alpha * camera.xi / d2 + (1.0 - camera.alpha));
  return SineOver(sine, cosine, d, slope_of_d);
}

double LargestOfDoubleSphere(const PinholeCamera& camera, double limit) {
  const double w1 = SmallerShare(camera.alpha);
  const double w2 =
      (w1 + camera.xi) / std::sqrt(2.0 * w1 * camera.xi + camera.xi * camera.xi + 1.0);
  return std::min(limit, std::acos(std::clamp(-w2, -1.0, 1.0)));
}

// ---- Extended unified model (Khomutenko, Garcia and Martinet 2016; as in Usenko et al. 2018)

// The radius is sin(t) / d with d = alpha q + (1 - alpha) cos(t) and q^2 = beta sin(t)^2 +
// cos(t)^2.
LensRadius RadiusOfExtendedUnified(const PinholeCamera& camera, double angle) {
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const double q = std::sqrt(camera.beta * sine * sine + cosine * cosine);
  const double d = camera.alpha * q + (1.0 - camera.alpha) * cosine;
  const double slope_of_d =
      camera.alpha * (camera.beta - 1.0) * sine * cosine / q - (1.0 - camera.alpha) * sine;
  return SineOver(sine, cosine, d, slope_of_d);
}

// Points are seen with cos(t) > -w q.
double LargestOfExtendedUnified(const PinholeCamera& camera, double limit) {
  const double w = SmallerShare(camera.alpha);
  return std::min(
      limit, std::numbers::pi - std::atan2(std::sqrt(1.0 - w * w), w * std::sqrt(camera.beta)));
}

// ---- all of them

constexpr std::array<std::string_view, 4> kKannalaBrandtNames = {
    "equidistant", "fisheye", "kannala_brandt", "kannalabrandt8"};
constexpr std::array<LensCoefficient, 4> kKannalaBrandtCoefficients = {
    {{"k1", &PinholeCamera::k1},
     {"k2", &PinholeCamera::k2},
     {"k3", &PinholeCamera::k3},
     {"k4", &PinholeCamera::k4}}};
constexpr std::array<std::string_view, 3> kDoubleSphereNames = {"double_sphere", "ds",
                                                                "doublesphere"};
constexpr std::array<LensCoefficient, 2> kDoubleSphereCoefficients = {
    {{"xi", &PinholeCamera::xi}, {"alpha", &PinholeCamera::alpha}}};
constexpr std::array<std::string_view, 2> kExtendedUnifiedNames = {"eucm", "extended_unified"};
constexpr std::array<LensCoefficient, 2> kExtendedUnifiedCoefficients = {
    {{"alpha", &PinholeCamera::alpha}, {"beta", &PinholeCamera::beta}}};

constexpr auto kWideModels = std::to_array<WideModel>({
    {LensModel::kKannalaBrandt, "KannalaBrandt8", "a fisheye lens (Kannala-Brandt)",
     kKannalaBrandtNames, kKannalaBrandtCoefficients, RadiusOfKannalaBrandt,
     LargestOfKannalaBrandt},
    {LensModel::kDoubleSphere, "DoubleSphere", "a fisheye lens (double sphere)", kDoubleSphereNames,
     kDoubleSphereCoefficients, RadiusOfDoubleSphere, LargestOfDoubleSphere},
    {LensModel::kExtendedUnified, "EUCM", "a fisheye lens (extended unified model)",
     kExtendedUnifiedNames, kExtendedUnifiedCoefficients, RadiusOfExtendedUnified,
     LargestOfExtendedUnified},
});

const WideModel& ModelOf(const PinholeCamera& camera) {
  const WideModel* const model = FindWideModel(camera.lens);
  return model != nullptr ? *model : kWideModels.front();
}

}  // namespace

std::span<const WideModel> WideModels() { return kWideModels; }

std::vector<std::string> LensTypes() {
  std::vector<std::string> types = {"PinHole"};
  for (const WideModel& model : kWideModels) {
    types.emplace_back(model.type);
  }
  return types;
}

std::span<const LensCoefficient> CoefficientsOf(LensModel lens) {
  static constexpr std::array<LensCoefficient, 8> kBrown = {{{"k1", &PinholeCamera::k1},
                                                             {"k2", &PinholeCamera::k2},
                                                             {"p1", &PinholeCamera::p1},
                                                             {"p2", &PinholeCamera::p2},
                                                             {"k3", &PinholeCamera::k3},
                                                             {"k4", &PinholeCamera::k4},
                                                             {"k5", &PinholeCamera::k5},
                                                             {"k6", &PinholeCamera::k6}}};
  const WideModel* const wide = FindWideModel(lens);
  return wide != nullptr ? wide->coefficients : std::span<const LensCoefficient>(kBrown);
}

const WideModel* FindWideModel(LensModel lens) {
  const auto* const found =
      std::find_if(kWideModels.begin(), kWideModels.end(),
                   [&](const WideModel& model) { return model.lens == lens; });
  return found != kWideModels.end() ? found : nullptr;
}

const WideModel* FindWideModel(std::string_view name) {
  const std::string lower = LowerCase(name);
  for (const WideModel& model : kWideModels) {
    if (std::find(model.names.begin(), model.names.end(), lower) != model.names.end()) {
      return &model;
    }
  }
  return nullptr;
}

LensRadius RadiusAt(const PinholeCamera& camera, double angle) {
  return ModelOf(camera).radius(camera, angle);
}

double LargestAngle(const PinholeCamera& camera, double limit) {
  return ModelOf(camera).largest(camera, limit);
}

// With x = r cos(phi), y = r sin(phi), the angle t = atan(r) and the radius d(t), the radial scale
// is d' / (1 + r^2) and the scale across is d / r.
LensPoint DistortWide(const PinholeCamera& camera, const Eigen::Vector2d& point) {
  constexpr double kTiny = 1e-9;
  const double r = point.norm();
  if (r < kTiny) {
    return {point, Eigen::Matrix2d::Identity()};
  }
  const LensRadius at = RadiusAt(camera, std::atan(r));
  const double across = at.radius / r;
  const double along = at.slope / (1.0 + r * r);
  const Eigen::Vector2d direction = point / r;
  return {across * point, across * Eigen::Matrix2d::Identity() +
                              (along - across) * direction * direction.transpose()};
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
    const LensRadius at = RadiusAt(camera, angle);
    const double error = at.radius - radius;
    if (std::abs(error) < 1e-14) {
      break;
    }
    (error > 0.0 ? high : low) = angle;
    const double next = angle - error / at.slope;
    angle = next > low && next < high ? next : 0.5 * (low + high);
  }
  return angle;
}

Eigen::Vector2d UndistortWide(const PinholeCamera& camera, const Eigen::Vector2d& target) {
  constexpr double kTiny = 1e-9;
  const double radius = target.norm();
  if (radius < kTiny) {
    return target;
  }
  const double largest = LargestAngle(camera, PinholeCamera::kMostAngle);
  return target * (std::tan(AngleOfRadius(camera, radius, largest)) / radius);
}

double FoldOfWide(const PinholeCamera& camera) {
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
