// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/determined.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "util/statistics.h"
#include "util/task_runner.h"

namespace hullslam {
namespace {

using Kind = CameraParameter::Kind;

constexpr size_t kPieces = 10;
constexpr double kFocalBound = 0.005;  // share of f
// px. Targets tell the principal point about as well as this, so a worse one is no better.
constexpr double kCentreBound = 0.75;
constexpr double kDistortionBound = 1.0;    // px, near a corner
constexpr double kReadoutBound = 1.5e-3;    // s
constexpr double kDisparityBound = 0.1;     // px
constexpr double kDepthTimeBound = 1.5e-3;  // s
constexpr double kDepthTurnBound = 2.0;     // px in the middle of the image
constexpr double kDepthShiftBound = 4e-3;   // m

double BoundOf(const CameraParameter& parameter, const CameraModel& model) {
  switch (parameter.kind) {
    case Kind::kFocalLength:
      return kFocalBound * model.camera.fx;
    case Kind::kReadout:
      return kReadoutBound;
    case Kind::kDisparityOffset:
      return kDisparityBound;
    case Kind::kDepthTime:
      return kDepthTimeBound;
    case Kind::kDepthPose:
      return parameter.unit == "m" ? kDepthShiftBound : kDepthTurnBound / model.camera.fx;
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
  ParallelRunner(0).Run(pieces, [&](size_t piece) {
    std::vector<uint8_t> is_left_out(views, 0);
    for (size_t i = piece * views / pieces; i < (piece + 1) * views / pieces; ++i) {
      is_left_out[i] = 1;
    }
    steps.col(static_cast<Eigen::Index>(piece)) = adjustment.StepWithout(is_left_out);
  });
  const Eigen::VectorXd mean = steps.rowwise().mean();
  const Eigen::MatrixXd deviations = steps.colwise() - mean;
  const auto count = static_cast<double>(pieces);
  return (count - 1.0) / count * deviations * deviations.transpose();
}

constexpr double kLittleTurn = 0.2;  // rad
constexpr double kLittleWay = 0.05;

// The share of the points whose distance from the plane of best fit is small.
double ShareInPlane(std::vector<Eigen::Vector3d> points) {
  constexpr int kRounds = 5;
  double share = 0.0;
  std::vector<Eigen::Vector3d> inner = points;
  for (int round = 0; round < kRounds && inner.size() > 10; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& point : inner) {
      mean += point / static_cast<double>(inner.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& point : inner) {
      spread += (point - mean) * (point - mean).transpose() / static_cast<double>(inner.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    const double near = 0.05 * std::sqrt(solver.eigenvalues()[2]);
    inner.clear();
    for (const Eigen::Vector3d& point : points) {
      if (std::abs(normal.dot(point - mean)) < near) {
        inner.push_back(point);
      }
    }
    share = static_cast<double>(inner.size()) / static_cast<double>(points.size());
  }
  return share;
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

bool CameraEvidence::IsDepthPoseDetermined() const {
  return IsCentringDetermined() &&
         std::ranges::all_of(parameters, [](const ParameterEvidence& one) {
           return one.parameter.kind != Kind::kDepthPose || one.IsDetermined();
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

MotionSummary SummarizeMotion(const CalibrationProblem& problem) {
  MotionSummary motion;
  std::vector<double> depths;
  for (size_t i = 0; i < problem.points.size(); ++i) {
    for (const CalibrationObservation& seen : problem.observations[i]) {
      depths.push_back((problem.views[seen.view].cam_from_world * problem.points[i]).z());
    }
  }
  const double depth = depths.empty() ? 1.0 : std::max(1e-9, Median(std::move(depths)));
  for (const CalibrationView& a : problem.views) {
    for (const CalibrationView& b : problem.views) {
      if (a.recording != b.recording || !(a.timestamp < b.timestamp)) {
        continue;
      }
      const Rigid3 b_from_a = b.cam_from_world * Inverse(a.cam_from_world);
      const Eigen::Vector3d axis = b_from_a.rotation * Eigen::Vector3d::UnitZ();
      const double across = std::acos(std::clamp(axis.z(), -1.0, 1.0));
      const Eigen::Quaterniond back =
          Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ()) * b_from_a.rotation;
      motion.turn_across = std::max(motion.turn_across, across);
      motion.roll = std::max(motion.roll, LogSo3(back).norm());
      const Eigen::Vector3d way = Inverse(b_from_a).translation / depth;
      motion.way = std::max(motion.way, way.norm());
      motion.way_ahead = std::max(motion.way_ahead, std::abs(way.z()));
    }
  }
  motion.plane = problem.points.empty() ? 0.0 : ShareInPlane(problem.points);
  return motion;
}

std::string AdviceFor(const ParameterEvidence& one, const MotionSummary& motion) {
  const bool turns = motion.turn_across > kLittleTurn;
  if (!turns && motion.way < kLittleWay && motion.roll < kLittleTurn) {
    return "the camera stood still; move it and turn it about all axes";
  }
  switch (one.parameter.kind) {
    case Kind::kFocalLength:
      if (!turns) {
        return "turn the camera left and right, and up and down, by 30 degrees and more";
      }
      break;
    case Kind::kReadout:
      return "turn the camera faster, and roll it, so that not all images have the same readout "
             "direction";
    case Kind::kDepthScale:
      break;
    case Kind::kDepthTime:
      return "move the camera faster, and look at walls that are tilted";
    case Kind::kDepthPose:
    case Kind::kDisparityOffset:
      return "look at things at different distances, near and far, while the camera moves";
    case Kind::kField:
      if (!turns && motion.way_ahead > 0.7 * motion.way) {
        return "do not only go ahead: move sideways and turn";
      }
      if (motion.roll < kLittleTurn) {
        return "roll the camera by 90 degrees";
      }
      break;
  }
  return motion.plane > 0.8 ? "look at something that is no plane, or tilt the camera more"
                            : "turn the camera about all axes, and let things reach all corners";
}

}  // namespace hullslam
