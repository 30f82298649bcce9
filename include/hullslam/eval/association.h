// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/util/stamp_pairing.h"

namespace hullslam {

// How poses of two trajectories are paired by time.
enum class PairingRule {
  kTum,  // TUM's associate.py: |dt| < limit, the closest first, one to one
  kEvo,  // evo: for each stamp of the shorter trajectory (the estimate's where both are as long)
         // the nearest of the other one, |dt| <= limit; not one to one
};

const char* ToString(PairingRule rule);

// The limit that the tool of this rule has by default, s: 0.02 for TUM, 0.01 for evo.
double DefaultMaxDifference(PairingRule rule);

// Pairs (first: reference, second: estimate) in order of the shorter trajectory's time.
std::vector<IndexPair> PairPoses(const Trajectory& reference, const Trajectory& estimate,
                                 PairingRule rule, double max_difference);

}  // namespace hullslam
