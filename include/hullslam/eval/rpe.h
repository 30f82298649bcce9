// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "hullslam/eval/association.h"
#include "hullslam/eval/error_statistics.h"
#include "hullslam/geometry/trajectory.h"

namespace hullslam {

struct RpeOptions {
  enum class Unit { kFrames, kSeconds };
  Unit unit = Unit::kSeconds;
  double delta = 1.0;  // length of the motions compared, > 0; whole for frames
  double scale = 1.0;  // by which the estimate's translations are multiplied first
  PairingRule pairing = PairingRule::kTum;
  std::optional<double> max_difference =
      std::nullopt;  // s; the pairing's default where it is not given
};

// Relative pose error (Sturm et al. 2012, Eq. 1): for paired poses i and j, `delta` apart,
// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) of reference Q and estimate P. Every i is used (TUM's
// --fixed_delta); with seconds j is the pair nearest to t_i + delta, and i is left out where there
// is none within a tenth of delta.
struct RpeReport {
  std::string failure;          // empty, or why there is no error
  ErrorStatistics translation;  // m
  ErrorStatistics rotation;     // degrees
  size_t motions = 0;

  bool ok() const { return failure.empty(); }
};

RpeReport EvaluateRpe(const Trajectory& reference, const Trajectory& estimate,
                      const RpeOptions& options = {});

}  // namespace hullslam
