// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hullslam {

// A list of points that is kept with single precision. It takes half the memory of doubles, and a
// coordinate changes by less than 1e-7 of its size. Every keyframe keeps thousands of points.
template <int N>
class PackedPoints {
 public:
  using Point = Eigen::Matrix<double, N, 1>;
  static constexpr size_t kBytesPerPoint = N * sizeof(float);

  PackedPoints() = default;
  PackedPoints(const std::vector<Point>& points) {
    packed_.reserve(points.size());
    for (const Point& point : points) {
      packed_.push_back(point.template cast<float>());
    }
  }

  size_t size() const { return packed_.size(); }
  bool empty() const { return packed_.empty(); }
  void clear() { packed_.clear(); }
  std::vector<Point> Unpack() const {
    std::vector<Point> points;
    points.reserve(packed_.size());
    for (const auto& point : packed_) {
      points.push_back(point.template cast<double>());
    }
    return points;
  }
  bool operator==(const PackedPoints&) const = default;

 private:
  std::vector<Eigen::Matrix<float, N, 1>> packed_;
};

}  // namespace hullslam
