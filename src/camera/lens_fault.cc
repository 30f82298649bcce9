// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/lens_fault.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "camera/wide_lens.h"

namespace hullslam {
namespace {

// "Camera.k1 is '-5': ", for the coefficient that moves a raw pixel most.
std::string NameCoefficient(const PinholeCamera& camera, const Eigen::Vector2d& raw) {
  if (const WideModel* const model = FindWideModel(camera.lens);
      model != nullptr && model->coefficients.front().field != &PinholeCamera::k1) {
    const LensCoefficient& last = model->coefficients.back();
    return "Camera." + std::string(last.name) + " is '" + PrintNumber(camera.*last.field) + "': ";
  }
  const double r = std::hypot((raw.x() - camera.cx) / camera.fx, (raw.y() - camera.cy) / camera.fy);
  struct Term {
    const char* key;
    double coefficient;
    double factor;
  };
  // k4 to k6 divide in Brown's model, and k4 is the fourth coefficient of a fisheye lens.
  const std::array<Term, 8> terms = {
      {{"Camera.k1", camera.k1, std::pow(r, 2)},
       {"Camera.k2", camera.k2, std::pow(r, 4)},
       {"Camera.k3", camera.k3, std::pow(r, 6)},
       {"Camera.p1", camera.p1, r},
       {"Camera.p2", camera.p2, r},
       {"Camera.k4", camera.k4, std::pow(r, camera.IsFisheye() ? 8 : 2)},
       {"Camera.k5", camera.k5, std::pow(r, 4)},
       {"Camera.k6", camera.k6, std::pow(r, 6)}}};
  const auto largest =
      std::max_element(terms.begin(), terms.end(), [](const auto& a, const auto& b) {
        return std::abs(a.coefficient) * a.factor < std::abs(b.coefficient) * b.factor;
      });
  return std::string(largest->key) + " is '" + PrintNumber(largest->coefficient) + "': ";
}

std::string DescribeFold(const PinholeCamera& camera) {
  const double radius = camera.FoldRadius();
  return std::isfinite(radius)
             ? ", because it folds " + PrintNumber(radius) + " px from the principal point"
             : std::string();
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
      // The comparisons are written so that a NaN is a fold.
      const bool has_inverse = (camera.Distort(p) - raw).norm() <= kMostError &&
                               camera.DistortionJacobian(p).determinant() >= kSmallestSlope;
      if (!has_inverse) {
        return raw;
      }
    }
  }
  return std::nullopt;
}

std::string FindBrownFault(const PinholeCamera& camera) {
  if (const std::optional<Eigen::Vector2d> fold = FindFold(camera)) {
    return NameCoefficient(camera, *fold) + "the distortion cannot be undone at pixel (" +
           PrintNumber(fold->x()) + ", " + PrintNumber(fold->y()) + ")" + DescribeFold(camera) +
           ", expected the coefficients of a lens";
  }
  constexpr double kMostStretch = 4.0;
  const PinholeCamera::Bounds bounds = camera.UndistortedBounds();
  const double stretch_x = (bounds.max_x - bounds.min_x) / camera.width;
  const double stretch_y = (bounds.max_y - bounds.min_y) / camera.height;
  const Range range = Range::Between(1.0 / kMostStretch, kMostStretch);
  if (!range.Contains(stretch_x) || !range.Contains(stretch_y)) {
    return NameCoefficient(camera, Eigen::Vector2d::Zero()) + "the undistorted image would have " +
           PrintNumber(stretch_x) + " times the width and " + PrintNumber(stretch_y) +
           " times the height of the image, expected " + range.ToString();
  }
  return {};
}

// A coefficient that the lens does not have.
std::string FindForeignCoefficient(const PinholeCamera& camera) {
  constexpr std::array<LensCoefficient, 11> kAll = {{{"p1", &PinholeCamera::p1},
                                                     {"p2", &PinholeCamera::p2},
                                                     {"k5", &PinholeCamera::k5},
                                                     {"k6", &PinholeCamera::k6},
                                                     {"k1", &PinholeCamera::k1},
                                                     {"k2", &PinholeCamera::k2},
                                                     {"k3", &PinholeCamera::k3},
                                                     {"k4", &PinholeCamera::k4},
                                                     {"xi", &PinholeCamera::xi},
                                                     {"alpha", &PinholeCamera::alpha},
                                                     {"beta", &PinholeCamera::beta}}};
  const WideModel* const model = FindWideModel(camera.lens);
  const auto is_of_lens = [&](const LensCoefficient& one) {
    if (model == nullptr) {
      return one.field != &PinholeCamera::xi && one.field != &PinholeCamera::alpha &&
             one.field != &PinholeCamera::beta;
    }
    return std::any_of(model->coefficients.begin(), model->coefficients.end(),
                       [&](const auto& own) { return own.field == one.field; });
  };
  for (const LensCoefficient& one : kAll) {
    const double unused = PinholeCamera().*one.field;
    if (!is_of_lens(one) && camera.*one.field != unused) {
      return "Camera." + std::string(one.name) + " is '" + PrintNumber(camera.*one.field) +
             "', expected " + PrintNumber(unused) + ": " +
             (model == nullptr ? "a PinHole has no such coefficient (Camera.type)"
                               : "a fisheye lens (" + std::string(model->type) + ") has only " +
                                     std::string(model->coefficients.front().name) + " to " +
                                     std::string(model->coefficients.back().name));
    }
  }
  return {};
}

std::string FindFisheyeFault(const PinholeCamera& camera) {
  // A ray cannot be more than 180 degrees from the axis, so the image must not go on there.
  const double behind = RadiusOfAngle(camera, std::numbers::pi);
  const double nearest_side =
      std::min({camera.cx / camera.fx, camera.cy / camera.fy,
                (camera.width - camera.cx) / camera.fx, (camera.height - camera.cy) / camera.fy});
  if (LargestAngle(camera, std::numbers::pi) >= std::numbers::pi && nearest_side > behind) {
    return "Camera.fx is '" + PrintNumber(camera.fx) + "': the field of view is larger than 360 " +
           "degrees, because the opposite of the axis would be " +
           PrintNumber(behind * std::min(camera.fx, camera.fy)) +
           " px from the principal point and the border of the image is " +
           PrintNumber(nearest_side * std::min(camera.fx, camera.fy)) + " px from it";
  }
  const double largest = LargestAngle(camera, PinholeCamera::kMostAngle);
  const double radius = RadiusOfAngle(camera, largest);
  for (const double x : {0.0, static_cast<double>(camera.width)}) {
    for (const double y : {0.0, static_cast<double>(camera.height)}) {
      const Eigen::Vector2d corner((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy);
      // The comparison is written so that a NaN is a fold.
      if (largest < PinholeCamera::kMostAngle && !(corner.norm() < radius)) {
        return NameCoefficient(camera, {x, y}) + "the distortion cannot be undone at pixel (" +
               PrintNumber(x) + ", " + PrintNumber(y) + ")" + DescribeFold(camera) +
               ", expected the coefficients of a fisheye lens";
      }
    }
  }
  return {};
}

}  // namespace

std::string PrintNumber(double value) {
  constexpr int kDigits = 6;
  std::array<char, 32> text = {};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::general, kDigits);
  return {text.data(), end};
}

std::string FindLensFault(const PinholeCamera& camera) {
  if (std::string fault = FindForeignCoefficient(camera); !fault.empty() || !camera.IsDistorted()) {
    return fault;
  }
  return camera.IsFisheye() ? FindFisheyeFault(camera) : FindBrownFault(camera);
}

}  // namespace hullslam
