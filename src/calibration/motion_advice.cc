// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/motion_advice.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "util/statistics.h"

namespace hullslam {
namespace {

using Kind = CameraParameter::Kind;

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
