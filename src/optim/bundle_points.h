// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "camera/point_measurement.h"

namespace hullslam::internal {

// The precision with which a point is optimised for given poses, before the cost of these poses is
// computed.
struct FollowOptions {
  int steps = 2;  // largest number of steps
  // Another step is only taken if the last one was expected to lower the cost of the point by a
  // larger share than this.
  double worthwhile = 1e-3;
  // The squared error of a point behind its camera. If it is infinite, one point can hold the map.
  double chi2_behind = std::numeric_limits<double>::infinity();
};

// The points of a bundle adjustment and their measurements in its images.
class BundlePoints {
 public:
  struct PointObservation {
    PointMeasurement measurement;
    size_t pose = 0;      // index of the pose
    double weight = 1.0;  // weight of its cost
    bool is_inlier = true;
  };

  void Reserve(size_t points, size_t observations) {
    positions_.reserve(points);
    ends_.reserve(points);
    observations_.reserve(observations);
  }

  // `position`: m, world frame. The observations of the point are added next.
  void AddPoint(const Eigen::Vector3d& position) {
    positions_.push_back(position);
    ends_.push_back(observations_.size());
  }
  // Adds an observation of the point that was added last.
  void AddView(const PointMeasurement& measurement, size_t pose, double weight = 1.0) {
    observations_.push_back({measurement, pose, weight, true});
    ends_.back() = observations_.size();
  }

  size_t size() const { return positions_.size(); }
  std::vector<Eigen::Vector3d>& positions() { return positions_; }
  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  std::span<PointObservation> ObservationsOf(size_t point) {
    return std::span(observations_).subspan(Begin(point), ends_[point] - Begin(point));
  }
  std::span<const PointObservation> ObservationsOf(size_t point) const {
    return std::span(observations_).subspan(Begin(point), ends_[point] - Begin(point));
  }
  int CountInliers() const {
    return static_cast<int>(
        std::count_if(observations_.begin(), observations_.end(),
                      [](const PointObservation& observation) { return observation.is_inlier; }));
  }

 private:
  size_t Begin(size_t point) const { return point == 0 ? 0 : ends_[point - 1]; }

  std::vector<Eigen::Vector3d> positions_;
  std::vector<PointObservation> observations_;  // those of the first point, then of the second ...
  std::vector<size_t> ends_;
};

}  // namespace hullslam::internal
