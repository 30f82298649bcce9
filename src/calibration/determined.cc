// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/determined.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "util/statistics.h"

namespace hullslam {
namespace {

using Kind = CameraParameter::Kind;

constexpr size_t kPieces = 10;
constexpr double kFocalBound = 0.005;  // share of f
// px. Targets tell the principal point about as well as this, so a worse one is no better.
constexpr double kCentreBound = 0.75;
constexpr double kDistortionBound = 1.0;  // px, near a corner
constexpr double kReadoutBound = 1.5e-3;  // s
constexpr double kDisparityBound = 0.1;   // px

double BoundOf(const CameraParameter& parameter, const CameraModel& model) {
  switch (parameter.kind) {
    case Kind::kFocalLength:
      return kFocalBound * model.camera.fx;
    case Kind::kReadout:
      return kReadoutBound;
    case Kind::kDisparityOffset:
      return kDisparityBound;
    case Kind::kField:
    case Kind::kDepthScale:
      break;
  }
  return parameter.unit == "px" ? kCentreBound : kDistortionBound * parameter.step;
}

// The derivative of a raw pixel by the coefficients of the lens, in steps.
Eigen::MatrixXd PixelByCoefficients(const CameraAdjustment& adjustment,
                                    const Eigen::Vector2d& raw) {
  const auto parameters = adjustment.parameters();
  const Eigen::Vector2d undistorted = adjustment.model().camera.Undistort(raw);
  Eigen::MatrixXd derivative =
      Eigen::MatrixXd::Zero(2, static_cast<Eigen::Index>(parameters.size()));
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].IsCoefficient()) {
      continue;
    }
    constexpr double kDifference = 1e-2;
    CameraModel below = adjustment.model();
    CameraModel above = adjustment.model();
    parameters[i].Move(-kDifference, below);
    parameters[i].Move(kDifference, above);
    derivative.col(static_cast<Eigen::Index>(i)) =
        (above.camera.Distort(undistorted) - below.camera.Distort(undistorted)) /
        (2.0 * kDifference);
  }
  return derivative;
}

// The covariance of a jackknife over pieces of the views that are successive in time.
Eigen::MatrixXd JackknifeCovariance(const CameraAdjustment& adjustment) {
  const size_t views = adjustment.problem().views.size();
  const size_t pieces = std::min(kPieces, views / 2);
  const auto size = static_cast<Eigen::Index>(adjustment.parameters().size());
  Eigen::MatrixXd steps(size, static_cast<Eigen::Index>(pieces));
  for (size_t piece = 0; piece < pieces; ++piece) {
    std::vector<uint8_t> is_left_out(views, 0);
    for (size_t i = piece * views / pieces; i < (piece + 1) * views / pieces; ++i) {
      is_left_out[i] = 1;
    }
    steps.col(static_cast<Eigen::Index>(piece)) = adjustment.StepWithout(is_left_out);
  }
  const Eigen::VectorXd mean = steps.rowwise().mean();
  const Eigen::MatrixXd deviations = steps.colwise() - mean;
  const auto count = static_cast<double>(pieces);
  return (count - 1.0) / count * deviations * deviations.transpose();
}

}  // namespace

bool CameraEvidence::IsDistortionDetermined() const {
  return distortion_sigma >= 0.0 && distortion_sigma <= kDistortionBound;
}

bool CameraEvidence::IsCentringDetermined() const {
  return std::ranges::all_of(parameters, [](const ParameterEvidence& one) {
    return !one.parameter.IsCentring() || one.parameter.IsCoefficient() || one.IsDetermined();
  });
}

const ParameterEvidence* CameraEvidence::Find(const std::string& name) const {
  const auto it = std::ranges::find_if(
      parameters, [&](const ParameterEvidence& one) { return one.parameter.name == name; });
  return it == parameters.end() ? nullptr : &*it;
}

CameraEvidence MeasureEvidence(const CameraAdjustment& adjustment) {
  CameraEvidence evidence;
  const auto parameters = adjustment.parameters();
  const auto size = static_cast<Eigen::Index>(parameters.size());
  if (parameters.empty()) {
    return evidence;
  }
  const CameraAdjustment::Minimum minimum = adjustment.AtMinimum();
  evidence.variance_factor = minimum.variance_factor;
  const Eigen::MatrixXd information = minimum.information / minimum.variance_factor;
  // Directions of which nothing is known have a very large sigma, but not an infinite one.
  constexpr double kNothing = 1e-6;
  const Eigen::MatrixXd covariance =
      (information + kNothing * Eigen::MatrixXd::Identity(size, size)).inverse();
  const Eigen::MatrixXd jackknife = JackknifeCovariance(adjustment);
  // Ten pieces tell the variance of one number with an error of a third. The factor that all
  // numbers share is known better.
  std::vector<double> factors;
  for (Eigen::Index i = 0; i < size; ++i) {
    factors.push_back(std::sqrt(jackknife(i, i) / covariance(i, i)));
  }
  evidence.jackknife_factor = std::max(1.0, Median(factors));
  for (Eigen::Index i = 0; i < size; ++i) {
    const CameraParameter& parameter = parameters[static_cast<size_t>(i)];
    ParameterEvidence one{.parameter = parameter,
                          .value = parameter.ValueIn(adjustment.model()),
                          .bundle_sigma = parameter.step * std::sqrt(covariance(i, i)),
                          .partner = {},
                          .bound = BoundOf(parameter, adjustment.model())};
    one.sigma = std::max(parameter.step * std::sqrt(jackknife(i, i)),
                         evidence.jackknife_factor * one.bundle_sigma);
    for (Eigen::Index k = 0; k < size; ++k) {
      const double correlation = covariance(i, k) / std::sqrt(covariance(i, i) * covariance(k, k));
      if (k != i && std::abs(correlation) > std::abs(one.correlation)) {
        one.correlation = correlation;
        one.partner = parameters[static_cast<size_t>(k)].name;
      }
    }
    evidence.parameters.push_back(std::move(one));
  }
  if (std::ranges::any_of(parameters, &CameraParameter::IsCoefficient)) {
    const PinholeCamera& camera = adjustment.model().camera;
    const Eigen::Vector2d corner(0.1 * camera.width, 0.1 * camera.height);
    const Eigen::MatrixXd by_lens = PixelByCoefficients(adjustment, corner);
    const double factor = evidence.jackknife_factor;
    const double variance =
        (by_lens * (factor * factor * covariance) * by_lens.transpose()).trace();
    const double measured = (by_lens * jackknife * by_lens.transpose()).trace();
    evidence.distortion_sigma = std::sqrt(std::max(variance, measured));
  }
  return evidence;
}

}  // namespace hullslam
