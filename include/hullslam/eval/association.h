// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/util/stamp_pairing.h"

namespace hullslam {

// The rule by which the poses of two trajectories are paired by time.
enum class PairingRule {
  // TUM's associate.py: |dt| < limit, the closest pairs first, one to one.
  kTum,
  // evo: each pose of the shorter trajectory (of the estimate if both have the same length) is
  // paired with the nearest pose of the other one if |dt| <= limit; not one to one.
  kEvo,
};

const char* ToString(PairingRule rule);

// The default limit of the tool with this rule, s: 0.02 for TUM, 0.01 for evo.
double DefaultMaxDifference(PairingRule rule);

// Pairs (first: index in reference, second: index in estimate), ordered by the time of the shorter
// trajectory.
std::vector<IndexPair> PairPoses(const Trajectory& reference, const Trajectory& estimate,
                                 PairingRule rule, double max_difference);

}  // namespace hullslam
