// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/association.h"

#include <cmath>
#include <span>

namespace hullslam {
namespace {

std::vector<double> Stamps(const Trajectory& trajectory) {
  std::vector<double> stamps;
  stamps.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) {
    stamps.push_back(pose.timestamp);
  }
  return stamps;
}

std::vector<IndexPair> PairWithNearest(std::span<const double> shorter,
                                       std::span<const double> longer, double max_difference) {
  std::vector<IndexPair> pairs;
  for (size_t i = 0; i < shorter.size(); ++i) {
    const size_t nearest = NearestStamp(longer, shorter[i]);
    if (std::abs(longer[nearest] - shorter[i]) <= max_difference) {
      pairs.push_back({i, nearest});
    }
  }
  return pairs;
}

}  // namespace

const char* ToString(PairingRule rule) { return rule == PairingRule::kTum ? "tum" : "evo"; }

double DefaultMaxDifference(PairingRule rule) { return rule == PairingRule::kTum ? 0.02 : 0.01; }

std::vector<IndexPair> PairPoses(const Trajectory& reference, const Trajectory& estimate,
                                 PairingRule rule, double max_difference) {
  const std::vector<double> references = Stamps(reference);
  const std::vector<double> estimates = Stamps(estimate);
  if (rule == PairingRule::kTum) {
    return PairStampsGreedily(references, estimates, max_difference);
  }
  if (references.empty() || estimates.empty()) {
    return {};
  }
  if (references.size() < estimates.size()) {
    return PairWithNearest(references, estimates, max_difference);
  }
  std::vector<IndexPair> pairs = PairWithNearest(estimates, references, max_difference);
  for (IndexPair& pair : pairs) {
    std::swap(pair.first, pair.second);
  }
  return pairs;
}

}  // namespace hullslam
