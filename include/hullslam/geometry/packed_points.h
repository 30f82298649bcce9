// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace hullslam {

// A list of measured points in 16 bits per coordinate, a quarter of the memory of doubles. Every
// keyframe keeps thousands of points. Along each axis, coordinates are multiples of 1/65535 of the
// extent of all points, so they change by at most 1/131070 of it: by 0.005 px in a contour that is
// as wide as an image of 640 px, and by 0.01 mm in depth points of an object of 1 m. The smallest
// and the largest coordinate change only by the rounding of single precision.
template <int N>
class PackedPoints {
 public:
  using Point = Eigen::Matrix<double, N, 1>;
  static constexpr size_t kBytesPerPoint = N * sizeof(uint16_t);

  PackedPoints() = default;
  // The points must be finite.
  PackedPoints(const std::vector<Point>& points) {
    Eigen::AlignedBox<double, N> box;
    for (const Point& point : points) {
      box.extend(point);
    }
    if (points.empty()) {
      return;
    }
    min_ = box.min().template cast<float>();
    step_ = (box.sizes() / kSteps).template cast<float>();
    packed_.reserve(points.size());
    for (const Point& point : points) {
      Packed& packed = packed_.emplace_back();
      for (int axis = 0; axis < N; ++axis) {
        const double steps = step_[axis] > 0.0f ? (point[axis] - static_cast<double>(min_[axis])) /
                                                      static_cast<double>(step_[axis])
                                                : 0.0;
        packed[static_cast<size_t>(axis)] =
            static_cast<uint16_t>(std::lround(std::clamp(steps, 0.0, kSteps)));
      }
    }
  }

  size_t size() const { return packed_.size(); }
  bool empty() const { return packed_.empty(); }
  void clear() { *this = PackedPoints(); }
  std::vector<Point> Unpack() const {
    std::vector<Point> points;
    points.reserve(packed_.size());
    for (const Packed& packed : packed_) {
      Point& point = points.emplace_back();
      for (int axis = 0; axis < N; ++axis) {
        point[axis] = static_cast<double>(min_[axis]) +
                      static_cast<double>(step_[axis]) * packed[static_cast<size_t>(axis)];
      }
    }
    return points;
  }
  bool operator==(const PackedPoints&) const = default;

  // The stored numbers: point = min + step * packed. Map files store them, so that reading gives
  // exactly the same points.
  using Corner = Eigen::Matrix<float, N, 1>;
  using Packed = std::array<uint16_t, N>;
  PackedPoints(const Corner& min, const Corner& step, std::vector<Packed> packed)
      : min_(min), step_(step), packed_(std::move(packed)) {}
  const Corner& min() const { return min_; }
  const Corner& step() const { return step_; }
  const std::vector<Packed>& packed() const { return packed_; }

 private:
  static constexpr double kSteps = std::numeric_limits<uint16_t>::max();

  Corner min_ = Corner::Zero();
  Corner step_ = Corner::Zero();
  std::vector<Packed> packed_;
};

}  // namespace hullslam
