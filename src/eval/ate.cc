// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/eval/ate.h"

#include <ceres/normal_prior.h>
#include <ceres/numeric_diff_cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {

ErrorStatistics SummarizeErrors(std::vector<double> errors) {
  ErrorStatistics statistics;
  if (errors.empty()) {
    return statistics;
  }
  std::sort(errors.begin(), errors.end());
  double sum = 0.0;
  double squares = 0.0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
  }
  const size_t count = errors.size();
  statistics.rmse = std::sqrt(squares / static_cast<double>(count));
  statistics.mean = sum / static_cast<double>(count);
  statistics.median = 0.5 * (errors[(count - 1) / 2] + errors[count / 2]);
  statistics.max = errors.back();
  return statistics;
}

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

// Why the pairs are too few. The ranges tell stamps of different clocks or units.
std::string TooFewPairs(const Trajectory& reference, const Trajectory& estimate, size_t paired,
                        double max_difference) {
  std::string message = paired == 0 ? "no pose of the estimate has"
                                    : fmt::format("only {} of the {} poses of the estimate have",
                                                  paired, estimate.size());
  message += fmt::format(" a partner within {:g} s in the reference", max_difference);
  if (!reference.empty() && !estimate.empty()) {
    message += fmt::format(
        "; the estimate is from {:.3f} to {:.3f} s, the reference from {:.3f} to {:.3f} s",
        estimate.front().timestamp, estimate.back().timestamp, reference.front().timestamp,
        reference.back().timestamp);
  }
  return message;
}

// The poses of `trajectory` whose stamps are between the first and the last one of `other`, both
// with a margin (s).
size_t CountDuring(const Trajectory& other, const Trajectory& trajectory, double margin = 0.0) {
  return static_cast<size_t>(
      std::count_if(trajectory.begin(), trajectory.end(), [&](const StampedPose& pose) {
        return !other.empty() && pose.timestamp >= other.front().timestamp - margin &&
               pose.timestamp <= other.back().timestamp + margin;
      }));
}

double SpanOf(const Trajectory& trajectory) {
  return trajectory.empty() ? 0.0 : trajectory.back().timestamp - trajectory.front().timestamp;
}

// The median time between two poses, s; 0 for fewer than two. Gaps do not change it.
double IntervalOf(const Trajectory& trajectory) {
  std::vector<double> intervals;
  for (size_t i = 1; i < trajectory.size(); ++i) {
    intervals.push_back(trajectory[i].timestamp - trajectory[i - 1].timestamp);
  }
  if (intervals.empty()) {
    return 0.0;
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

// The pairs that there would be if the reference had no gaps and the stamps were right: one for
// each pose of the estimate during the reference, or fewer if the reference has fewer poses per
// second.
size_t ExpectedPairs(const Trajectory& reference, const Trajectory& estimate) {
  const size_t during = CountDuring(reference, estimate);
  const double interval = IntervalOf(reference);
  if (during == 0 || interval <= 0.0) {
    return during;
  }
  const double common = std::min(reference.back().timestamp, estimate.back().timestamp) -
                        std::max(reference.front().timestamp, estimate.front().timestamp);
  return std::min(during, static_cast<size_t>(std::floor(common / interval * (1.0 + 1e-9))) + 1);
}

// Whether a few stamps hit each other by chance: they are less than a tenth of the trajectory with
// fewer poses (of the reference, those during the estimate count), or of the estimate in number and
// in time.
bool AreByChance(const Trajectory& reference, const Trajectory& estimate, double paired,
                 double paired_span, double max_difference) {
  constexpr double kLeast = 0.1;
  const size_t shorter =
      std::min(estimate.size(), CountDuring(estimate, reference, max_difference));
  return paired < kLeast * static_cast<double>(shorter) ||
         (paired < kLeast * static_cast<double>(estimate.size()) &&
          paired_span < kLeast * SpanOf(estimate));
}

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kMaxGap = 0.1;  // s, of true poses that are interpolated
// The unit of the clock, s. Ceres differentiates with a step of 1.5e-8, which is 1.5 ms in it.
constexpr double kClockUnit = 1e5;

std::optional<Rigid3> TruePose(const Trajectory& reference, double timestamp) {
  return InterpolatePose(reference, timestamp, kMaxGap);
}

// The error of a pose by the six parameters of Retract, for steps of the alignment and of the
// truth's offset. As a residual it is in standard deviations.
struct PoseError {
  Vector6d Of(const Vector6d& world, const Vector6d& mount, double clock) const {
    auto truth = TruePose(reference, timestamp + clock);
    if (!truth) {  // at the ends
      truth = TruePose(reference, timestamp);
    }
    return Difference(cam_from_world * Retract(world_from_truth, world),
                      Retract(Rigid3(), mount) * Inverse(*truth));
  }

  bool operator()(const double* world, const double* mount, const double* clock,
                  double* residual) const {
    Eigen::Map<Vector6d> whitened(residual);
    whitened = Of(Eigen::Map<const Vector6d>(world), Eigen::Map<const Vector6d>(mount),
                  kClockUnit * *clock);
    covariance.llt().matrixL().solveInPlace(whitened);
    return true;
  }

  const Trajectory& reference;
  double timestamp = 0.0;  // s, of the estimate
  Rigid3 cam_from_world;
  Matrix6d covariance;           // of the estimate and of the truth
  Rigid3 world_from_truth = {};  // before the step
};

}  // namespace

AteResult EvaluateAte(const Trajectory& reference, const Trajectory& estimate,
                      const AteOptions& options) {
  const double max_difference =
      options.max_difference.value_or(DefaultMaxDifference(options.pairing));
  const std::vector<IndexPair> pairs =
      PairPoses(reference, estimate, options.pairing, max_difference);
  AteResult report;
  report.pairs = pairs.size();
  report.estimate_poses = estimate.size();
  report.reference_poses = reference.size();
  const double paired = CountDistinctEstimates(pairs);
  report.coverage = estimate.empty() ? 0.0 : paired / static_cast<double>(estimate.size());
  report.expected_pairs = ExpectedPairs(reference, estimate);
  if (!pairs.empty()) {
    report.paired_span =
        reference[pairs.back().first].timestamp - reference[pairs.front().first].timestamp;
  }
  if (pairs.empty() ||
      AreByChance(reference, estimate, paired, report.paired_span, max_difference)) {
    report.failure = TooFewPairs(reference, estimate, static_cast<size_t>(paired), max_difference);
    return report;
  }
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

NeesResult EvaluateNees(const Trajectory& reference, const Trajectory& estimate,
                        std::span<const Eigen::Matrix<double, 6, 6>> covariances,
                        const TruthErrors& of_truth) {
  Check(of_truth.translation >= 0.0 && of_truth.rotation >= 0.0,
        "a standard deviation of the true trajectory is below 0");
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(of_truth.rotation),
      Eigen::Vector3d::Constant(of_truth.translation);
  std::vector<PoseError> pairs;
  for (size_t i = 0; i < estimate.size(); ++i) {
    // A pose without covariance is the first one, which the others are relative to.
    if (TruePose(reference, estimate[i].timestamp) &&
        Eigen::LLT<Matrix6d>(covariances[i]).info() == Eigen::Success) {
      pairs.push_back({.reference = reference,
                       .timestamp = estimate[i].timestamp,
                       .cam_from_world = Inverse(estimate[i].world_from_cam),
                       .covariance = covariances[i] + Matrix6d(sigma.cwiseAbs2().asDiagonal())});
    }
  }
  NeesResult result{
      .poses = pairs.size(), .ratio = {}, .rotation = {}, .translation = {}, .offset = {}};
  if (pairs.empty()) {
    return result;
  }
  // Ceres optimises steps of the alignment, of the mount and of the clock.
  const Rigid3 start = Inverse(pairs.front().cam_from_world) *
                       Inverse(*TruePose(reference, pairs.front().timestamp));
  Vector6d world = Vector6d::Zero();
  Vector6d mount = Vector6d::Zero();
  double clock = 0.0;
  ceres::Problem problem;
  for (PoseError& pair : pairs) {
    pair.world_from_truth = start;
    problem.AddResidualBlock(
        new ceres::NumericDiffCostFunction<PoseError, ceres::CENTRAL, 6, 6, 6, 1>(
            &pair, ceres::DO_NOT_TAKE_OWNERSHIP),
        nullptr, world.data(), mount.data(), &clock);
  }
  // Without rotation the translation of the mount is not determined, so 1 m and 1 rad are its
  // weak priors.
  problem.AddResidualBlock(new ceres::NormalPrior(Matrix6d::Identity(), mount), nullptr,
                           mount.data());
  problem.SetParameterLowerBound(&clock, 0, -kMaxGap / kClockUnit);
  problem.SetParameterUpperBound(&clock, 0, kMaxGap / kClockUnit);
  if (!of_truth.has_offset) {
    problem.SetParameterBlockConstant(mount.data());
    problem.SetParameterBlockConstant(&clock);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::vector<double> ratios;
  std::vector<double> rotations;
  std::vector<double> translations;
  for (const PoseError& pair : pairs) {
    const Vector6d off = pair.Of(world, mount, kClockUnit * clock);
    const auto of_part = [&](Eigen::Index first) {
      const Eigen::Vector3d part = off.segment<3>(first);
      return part.dot(pair.covariance.block<3, 3>(first, first).llt().solve(part)) / 3.0;
    };
    ratios.push_back(off.dot(pair.covariance.llt().solve(off)) / 6.0);
    rotations.push_back(of_part(0));
    translations.push_back(of_part(3));
  }
  result.ratio = SummarizeErrors(std::move(ratios));
  result.rotation = SummarizeErrors(std::move(rotations));
  result.translation = SummarizeErrors(std::move(translations));
  if (of_truth.has_offset) {
    result.offset = {.cam_from_body = Retract(Rigid3(), mount), .clock_ahead = kClockUnit * clock};
  }
  return result;
}

std::string DescribeMissingPairs(const AteResult& report) {
  constexpr double kEnough = 0.9;
  const auto paired = static_cast<size_t>(
      std::lround(report.coverage * static_cast<double>(report.estimate_poses)));
  if (static_cast<double>(paired) >= kEnough * static_cast<double>(report.expected_pairs)) {
    return {};
  }
  return "only " + std::to_string(paired) + " of the " + std::to_string(report.expected_pairs) +
         " poses during the ground truth have a partner in it; are the rates of both stamps right, "
         "or does the ground truth have gaps?";
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

AlignmentKind AlignmentOf(SensorKind sensor) {
  return sensor == SensorKind::kMonocular ? AlignmentKind::kSim3 : AlignmentKind::kSe3;
}

}  // namespace hullslam
