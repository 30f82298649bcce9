// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/point_statistics.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam {
namespace {

std::vector<double> Coordinates(std::span<const Eigen::Vector3d> points, int axis) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    values.push_back(point[axis]);
  }
  return values;
}

struct Moments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();  // unbiased
};

Moments MomentsOf(std::span<const Eigen::Vector3d> samples) {
  Moments moments;
  moments.mean = MeanOf(samples);
  const auto count = static_cast<double>(samples.size());
  for (const Eigen::Vector3d& sample : samples) {
    moments.variance += (sample - moments.mean).cwiseAbs2() / (count - 1.0);
  }
  return moments;
}

bool IsPlausible(double t, double degrees_of_freedom, double alpha) {
  const boost::math::students_t distribution(degrees_of_freedom);
  return std::abs(t) <= boost::math::quantile(boost::math::complement(distribution, alpha / 2.0));
}

}  // namespace

Eigen::Vector3d MeanOf(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    sum += point;
  }
  return sum / static_cast<double>(std::max<size_t>(1, points.size()));
}

double RankSumScore(std::span<const double> a, std::span<const double> b) {
  Check(!a.empty() && !b.empty(), "the rank-sum test needs two samples");
  std::vector<std::pair<double, bool>> all;  // value, and whether it belongs to a
  for (const double value : a) {
    all.emplace_back(value, true);
  }
  for (const double value : b) {
    all.emplace_back(value, false);
  }
  std::sort(all.begin(), all.end());
  double rank_sum = 0.0;
  for (size_t begin = 0; begin < all.size();) {
    size_t end = begin;
    while (end < all.size() && all[end].first == all[begin].first) {
      ++end;
    }
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);  // mean of begin+1 .. end
    for (size_t i = begin; i < end; ++i) {
      rank_sum += all[i].second ? rank : 0.0;
    }
    begin = end;
  }
  const auto m = static_cast<double>(a.size());
  const auto n = static_cast<double>(b.size());
  const double mean = m * (m + n + 1.0) / 2.0;
  return (rank_sum - mean) / std::sqrt(m * n * (m + n + 1.0) / 12.0);
}

bool MayBeOneCloud(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                   double max_score, size_t min_points) {
  if (a.size() < min_points || b.size() < min_points) {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(RankSumScore(Coordinates(a, axis), Coordinates(b, axis))) > max_score) {
      return false;
    }
  }
  return true;
}

bool MayBeTheMean(const Eigen::Vector3d& value, std::span<const Eigen::Vector3d> samples,
                  double alpha, double noise) {
  if (samples.size() < 3) {
    return false;
  }
  const Moments moments = MomentsOf(samples);
  const auto count = static_cast<double>(samples.size());
  for (int axis = 0; axis < 3; ++axis) {
    // The value is one more sample, not a known mean, so its own variance is added.
    const double spread = std::sqrt((moments.variance[axis] + noise * noise) * (1.0 + 1.0 / count));
    if (!IsPlausible((value[axis] - moments.mean[axis]) / spread, count - 1.0, alpha)) {
      return false;
    }
  }
  return true;
}

bool MayHaveOneMean(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b,
                    double alpha, double noise) {
  if (a.size() < 3 || b.size() < 3) {
    return false;
  }
  const Moments moments_a = MomentsOf(a);
  const Moments moments_b = MomentsOf(b);
  const auto m = static_cast<double>(a.size());
  const auto n = static_cast<double>(b.size());
  for (int axis = 0; axis < 3; ++axis) {
    const double part_a = (moments_a.variance[axis] + noise * noise) / m;
    const double part_b = (moments_b.variance[axis] + noise * noise) / n;
    const double sum = part_a + part_b;
    const double degrees = sum * sum / (part_a * part_a / (m - 1.0) + part_b * part_b / (n - 1.0));
    const double t = (moments_a.mean[axis] - moments_b.mean[axis]) / std::sqrt(sum);
    if (!IsPlausible(t, degrees, alpha)) {
      return false;
    }
  }
  return true;
}

}  // namespace hullslam
