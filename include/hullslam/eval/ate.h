// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/eval/association.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/alignment.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/util/eigen_alignment.h"

namespace hullslam {

// Statistics of a list of errors, in the unit of the errors; all zero for an empty list.
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  // for an even count the mean of the two middle errors
  double max = 0.0;
};

ErrorStatistics SummarizeErrors(std::vector<double> errors);

struct AteOptions {
  AlignmentKind alignment = AlignmentKind::kSe3;
  PairingRule pairing = PairingRule::kTum;
  std::optional<double> max_difference =
      std::nullopt;  // s; absent: the default of the pairing rule
};

// Absolute trajectory error (Sturm et al. 2012): the distances between the translations of paired
// poses, after the estimate was aligned to the reference.
struct AteResult {
  std::string failure;     // the reason if there is no error (too few pairs), else empty
  ErrorStatistics errors;  // m
  PointAlignment reference_from_estimate;
  size_t pairs = 0;
  size_t estimate_poses = 0;
  size_t reference_poses = 0;
  double coverage = 0.0;  // share of the estimated poses that are paired, 0 to 1
  // The pairs that there would be without gaps and with the right stamps: of all estimated poses
  // between the first and the last one of the reference, or fewer if it has fewer poses per second.
  size_t expected_pairs = 0;
  double paired_span = 0.0;  // s, from the first to the last pair
  // Only with kSim3: the growth of lengths in the estimate from the first tenth of the pairs to the
  // last tenth, 0.01 for 1 %. Each tenth is aligned by itself. Absent if a tenth has fewer than
  // three pairs or does not determine the scale.
  std::optional<double> scale_drift = std::nullopt;

  bool ok() const { return failure.empty(); }
};

// Fails if fewer than a tenth of the poses of the shorter trajectory are paired: the few pairs of
// stamps that hit each other by chance say nothing of the trajectory. A reference with few poses
// per second is enough if it reaches over a tenth of the estimate's time.
AteResult EvaluateAte(const Trajectory& reference, const Trajectory& estimate,
                      const AteOptions& options = {});

// Constant errors of a true trajectory.
struct TruthOffset {
  Rigid3 cam_from_body;      // the camera from the body whose poses the trajectory has
  double clock_ahead = 0.0;  // s, by which its clock is ahead of that of the estimate
};

// Whether the covariances of poses are honest, by the normalised estimation error squared (NEES):
// d' C^-1 d, where d is the error of the pose by the six parameters of Retract and C its
// covariance. Its mean is 6 if the covariances are right, and larger if they are too small.
struct NeesResult {
  size_t poses = 0;             // that have a true pose at their time and a covariance
  ErrorStatistics ratio;        // of NEES / 6
  ErrorStatistics rotation;     // of NEES / 3 of the rotation alone
  ErrorStatistics translation;  // the same of the position of the camera
  std::optional<TruthOffset> offset = std::nullopt;  // with TruthErrors::has_offset
};

// The errors of a true trajectory itself, such as one of a motion capture system.
struct TruthErrors {
  // Standard deviations on each axis of the camera, m and rad. Not below 0.
  double translation = 0.0;
  double rotation = 0.0;
  // Whether its body may be mounted on the camera in another way than it says, and its clock may be
  // off, by up to 0.1 s. Both errors are constant, and are found together with the alignment.
  bool has_offset = false;
};

// `covariances`: one per pose of the estimate, of TrackedFrame::covariance; those that cannot be
// inverted are left out. The estimate is aligned by the rigid motion of its world for which the sum
// of NEES is least. The true poses are interpolated. The covariance of an error is that of the
// estimate plus that of the true pose: C + diag(rotation^2 I, translation^2 I).
NeesResult EvaluateNees(const Trajectory& reference, const Trajectory& estimate,
                        std::span<const Eigen::Matrix<double, 6, 6>> covariances,
                        const TruthErrors& of_truth = {});

// Describes pairs that are fewer than the stamps allow: less than nine tenths of
// AteResult::expected_pairs. Then the stamps of one side have a wrong rate, or the reference has
// gaps. Empty if there are enough.
std::string DescribeMissingPairs(const AteResult& report);

const char* ToString(AlignmentKind kind);

// The scale of a monocular map is not known, so its alignment has a scale.
AlignmentKind AlignmentOf(SensorKind sensor);

}  // namespace hullslam
