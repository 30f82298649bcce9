// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/ate.h"

#include <algorithm>
#include <span>
#include <sstream>
#include <vector>

namespace hullslam {
namespace {

struct PairedPoints {
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> estimate;
};

PairedPoints Translations(const Trajectory& reference, const Trajectory& estimate,
                          const std::vector<IndexPair>& pairs) {
  PairedPoints points;
  for (const auto& [first, second] : pairs) {
    points.reference.push_back(reference[first].world_from_cam.translation);
    points.estimate.push_back(estimate[second].world_from_cam.translation);
  }
  return points;
}

double CountDistinctEstimates(const std::vector<IndexPair>& pairs) {
  std::vector<size_t> estimates;
  estimates.reserve(pairs.size());
  for (const IndexPair& pair : pairs) {
    estimates.push_back(pair.second);
  }
  std::sort(estimates.begin(), estimates.end());
  return static_cast<double>(std::unique(estimates.begin(), estimates.end()) - estimates.begin());
}

std::optional<double> ScaleDrift(const PairedPoints& points) {
  const size_t count = points.reference.size() / 10;
  const auto align = [count](const std::vector<Eigen::Vector3d>& estimate,
                             const std::vector<Eigen::Vector3d>& reference, size_t begin) {
    return AlignPoints(std::span(estimate).subspan(begin, count),
                       std::span(reference).subspan(begin, count), AlignmentKind::kSim3);
  };
  const PointAlignment first = align(points.estimate, points.reference, 0);
  const PointAlignment last =
      align(points.estimate, points.reference, points.reference.size() - count);
  // `scale` converts lengths of the estimate to true lengths. If it is larger at the beginning than
  // at the end, lengths in the estimate have grown.
  return first.ok() && last.ok() ? std::optional(first.scale / last.scale - 1.0) : std::nullopt;
}

std::string NoPairs(double max_difference) {
  std::ostringstream message;
  message << "no pose of the estimate has a partner within " << max_difference
          << " s in the reference";
  return message.str();
}

}  // namespace

AteReport EvaluateAte(const Trajectory& reference, const Trajectory& estimate,
                      const AteOptions& options) {
  const double max_difference =
      options.max_difference.value_or(DefaultMaxDifference(options.pairing));
  const std::vector<IndexPair> pairs =
      PairPoses(reference, estimate, options.pairing, max_difference);
  AteReport report;
  report.pairs = pairs.size();
  report.estimate_poses = estimate.size();
  report.reference_poses = reference.size();
  if (pairs.empty()) {
    report.failure = NoPairs(max_difference);
    return report;
  }
  report.coverage = CountDistinctEstimates(pairs) / static_cast<double>(estimate.size());
  report.paired_span =
      reference[pairs.back().first].timestamp - reference[pairs.front().first].timestamp;
  const PairedPoints points = Translations(reference, estimate, pairs);
  report.reference_from_estimate =
      AlignPoints(points.estimate, points.reference, options.alignment);
  report.failure = report.reference_from_estimate.failure;
  if (!report.ok()) {
    return report;
  }
  if (options.alignment == AlignmentKind::kSim3) {
    report.scale_drift = ScaleDrift(points);
  }
  std::vector<double> errors;
  for (size_t i = 0; i < pairs.size(); ++i) {
    errors.push_back(
        (report.reference_from_estimate * points.estimate[i] - points.reference[i]).norm());
  }
  report.errors = SummarizeErrors(std::move(errors));
  return report;
}

const char* ToString(AlignmentKind kind) {
  switch (kind) {
    case AlignmentKind::kNone:
      return "none";
    case AlignmentKind::kSe3:
      return "se3";
    case AlignmentKind::kSim3:
      return "sim3";
  }
  return "unknown";
}

}  // namespace hullslam
