// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

namespace hullslam {

// Zero for no points.
Eigen::Vector3d MeanOf(std::span<const Eigen::Vector3d> points);

// Standard score of Wilcoxon's rank sum of `a` among `a` and `b` (Mann and Whitney 1947; normal
// approximation with the variance mn(m+n+1)/12 for samples of different sizes; ties share ranks).
// Near 0 where both may come from one distribution.
double RankSumScore(std::span<const double> a, std::span<const double> b);

// Whether two clouds of points (m) may be of one thing: the rank-sum test holds on each axis. False
// where either has fewer than `min_points`.
bool MayBeOneCloud(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                   double max_score, size_t min_points);

// Student's t-tests on each axis, with at least three samples: whether `value` may be the mean of
// `samples`, whether two samples may have one mean (Welch 1947). `noise` (m) is added to the
// variance: a few samples that happen to agree must not make the test sharper than the sensor is.
bool MayBeTheMean(const Eigen::Vector3d& value, std::span<const Eigen::Vector3d> samples,
                  double alpha, double noise);
bool MayHaveOneMean(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                    double alpha, double noise);

}  // namespace hullslam
