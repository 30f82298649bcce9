// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/rpe.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// Index of the pose at the end of the motion that starts at index `start`; absent if no pose is
// near enough in time.
std::optional<size_t> FindEnd(const std::vector<double>& stamps, size_t start,
                              const RpeOptions& options) {
  if (options.unit == RpeOptions::Unit::kFrames) {
    const size_t end = start + static_cast<size_t>(options.delta);
    return end < stamps.size() ? std::optional(end) : std::nullopt;
  }
  constexpr double kTolerance = 0.1;
  const double wanted = stamps[start] + options.delta;
  const size_t end = NearestStamp(stamps, wanted);
  const bool near = std::abs(stamps[end] - wanted) <= kTolerance * options.delta;
  return near && end > start ? std::optional(end) : std::nullopt;
}

Rigid3 Motion(const Trajectory& trajectory, size_t start, size_t end) {
  return Inverse(trajectory[start].world_from_cam) * trajectory[end].world_from_cam;
}

}  // namespace

RpeResult EvaluateRpe(const Trajectory& reference, const Trajectory& estimate,
                      const RpeOptions& options) {
  Check(options.delta > 0.0, "the length of motions is not above 0");
  Check(options.unit == RpeOptions::Unit::kSeconds || options.delta >= 1.0,
        "the length of motions is less than one frame");
  const std::vector<IndexPair> pairs =
      PairPoses(reference, estimate, options.pairing,
                options.max_difference.value_or(DefaultMaxDifference(options.pairing)));
  std::vector<double> stamps;
  stamps.reserve(pairs.size());
  for (const IndexPair& pair : pairs) {
    stamps.push_back(estimate[pair.second].timestamp);
  }
  std::vector<double> translations;
  std::vector<double> rotations;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (const std::optional<size_t> j = FindEnd(stamps, i, options)) {
      Rigid3 motion = Motion(estimate, pairs[i].second, pairs[*j].second);
      motion.translation *= options.scale;
      const Rigid3 error = Inverse(Motion(reference, pairs[i].first, pairs[*j].first)) * motion;
      translations.push_back(error.translation.norm());
      rotations.push_back(LogSo3(error.rotation).norm() * 180.0 / std::numbers::pi);
    }
  }
  RpeResult report;
  report.motions = translations.size();
  if (translations.empty()) {
    report.failure = "no two paired poses are far enough apart in time";
    return report;
  }
  report.translation = SummarizeErrors(std::move(translations));
  report.rotation = SummarizeErrors(std::move(rotations));
  return report;
}

std::string DescribeSwappedRotations(const Trajectory& reference, const Trajectory& estimate,
                                     const RpeResult& report, const RpeOptions& options) {
  constexpr double kGood = 1.0;  // degrees
  constexpr double kClearly = 5.0;
  if (!report.ok() || report.rotation.median <= kGood) {
    return "";
  }
  Trajectory swapped = reference;
  for (StampedPose& pose : swapped) {
    const Eigen::Vector4d read = pose.world_from_cam.rotation.coeffs();  // x y z w
    pose.world_from_cam.rotation = Eigen::Quaterniond(read[0], read[1], read[2], read[3]);
  }
  const double median = EvaluateRpe(swapped, estimate, options).rotation.median;
  if (kClearly * median > report.rotation.median) {
    return "";
  }
  return fmt::format(
      "the rotations of the ground truth seem to have qw first: they are off by {:.1f} degrees as "
      "qx qy qz qw, and by {:.2f} degrees as qw qx qy qz; expected qx qy qz qw",
      report.rotation.median, median);
}

TrajectoryErrors EvaluateTrajectory(const Trajectory& reference, const Trajectory& estimate,
                                    const AteOptions& options,
                                    std::span<const Eigen::Matrix<double, 6, 6>> covariances,
                                    const TruthErrors& of_truth) {
  TrajectoryErrors errors{.options = options, .ate = EvaluateAte(reference, estimate, options)};
  if (!errors.ate.ok()) {
    return errors;
  }
  const RpeOptions motions = {.scale = errors.ate.reference_from_estimate.scale,
                              .pairing = options.pairing,
                              .max_difference = options.max_difference};
  errors.rpe = EvaluateRpe(reference, estimate, motions);
  if (!covariances.empty()) {
    errors.nees = EvaluateNees(reference, estimate, covariances, of_truth);
  }
  for (const std::string& warning :
       {DescribeMissingPairs(errors.ate),
        DescribeSwappedRotations(reference, estimate, errors.rpe, motions)}) {
    if (!warning.empty()) {
      errors.warnings.push_back(warning);
    }
  }
  return errors;
}

}  // namespace hullslam
