// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hullslam/eval/association.h"
#include "hullslam/eval/ate.h"
#include "hullslam/geometry/trajectory.h"

namespace hullslam {

struct RpeOptions {
  enum class Unit { kFrames, kSeconds };
  Unit unit = Unit::kSeconds;
  double delta = 1.0;  // length of the compared motions, > 0; an integer for frames
  double scale = 1.0;  // the translations of the estimate are multiplied by this first
  PairingRule pairing = PairingRule::kTum;
  std::optional<double> max_difference =
      std::nullopt;  // s; absent: the default of the pairing rule
};

// Relative pose error (Sturm et al. 2012, Eq. 1): E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) for reference Q
// and estimate P, over paired poses i and j that are `delta` apart. Each i is used (--fixed_delta
// in the TUM tools). For a delta in seconds, j is the pair nearest to t_i + delta; i is left out if
// no pair is within a tenth of delta.
struct RpeResult {
  std::string failure;          // the reason if there is no error, else empty
  ErrorStatistics translation;  // m
  ErrorStatistics rotation;     // degrees
  size_t motions = 0;

  bool ok() const { return failure.empty(); }
};

RpeResult EvaluateRpe(const Trajectory& reference, const Trajectory& estimate,
                      const RpeOptions& options = {});

// Says that the file of the reference has qw before qx qy qz: the rotations then agree with the
// estimate at least five times as well as in the order of TUM (qx qy qz qw). Empty if they do not,
// or if they agree within one degree as they are. `report` is about the same trajectories.
std::string DescribeSwappedRotations(const Trajectory& reference, const Trajectory& estimate,
                                     const RpeResult& report, const RpeOptions& options = {});

// The absolute and relative errors of a trajectory. The alignment gives the scale of both.
struct TrajectoryErrors {
  AteOptions options;
  AteResult ate;
  RpeResult rpe = {};                             // only if the absolute error could be computed
  std::vector<std::string> warnings = {};         // faults of the stamps and of the reference
  std::optional<NeesResult> nees = std::nullopt;  // absent without covariances
};

// `covariances` and `of_truth`: as in EvaluateNees, or empty.
TrajectoryErrors EvaluateTrajectory(const Trajectory& reference, const Trajectory& estimate,
                                    const AteOptions& options,
                                    std::span<const Eigen::Matrix<double, 6, 6>> covariances = {},
                                    const TruthErrors& of_truth = {});

}  // namespace hullslam
