// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

namespace hullslam {

// Zero for no points.
Eigen::Vector3d MeanOf(std::span<const Eigen::Vector3d> points);

// Standard score of Wilcoxon's rank sum of `a` among `a` and `b` (Mann and Whitney 1947; normal
// approximation with the variance mn(m+n+1)/12 for samples of different sizes; ties share ranks).
// It is near 0 if both samples come from the same distribution.
double RankSumScore(std::span<const double> a, std::span<const double> b);

// Whether two clouds of points may belong to the same object: on each axis the absolute rank-sum
// score is at most `max_score`. False if either cloud has fewer than `min_points` points.
bool MayBeOneCloud(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                   double max_score, size_t min_points);

// Student's t-tests on each axis. MayBeTheMean tests whether `value` may come from the distribution
// of `samples`, MayHaveOneMean whether two samples may have the same mean (Welch 1947). Both are
// false for fewer than three samples. `noise` is a standard deviation in the unit of the points;
// its square is added to the variance, because a few samples that agree by chance must not make the
// test stricter than the precision of the sensor.
bool MayBeTheMean(const Eigen::Vector3d& value, std::span<const Eigen::Vector3d> samples,
                  double alpha, double noise);
bool MayHaveOneMean(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                    double alpha, double noise);

}  // namespace hullslam
