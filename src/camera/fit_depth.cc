// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/fit_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

// The place of a pixel of the new image along one axis of the old one.
struct Place {
  int first = 0;       // the pixel before it
  int second = 0;      // the pixel after it
  int nearest = 0;     // one of the two
  double share = 0.0;  // of the second
};

// Pixel centres have integer coordinates, so the images begin at -1/2.
std::vector<Place> PlacesAlong(int from, int to) {
  std::vector<Place> places;
  for (int i = 0; i < to; ++i) {
    const double at = std::clamp((i + 0.5) * from / to - 0.5, 0.0, from - 1.0);
    const int first = static_cast<int>(at);
    const int second = std::min(first + 1, from - 1);
    const double share = at - first;
    places.push_back({first, second, share < 0.5 ? first : second, share});
  }
  return places;
}

// A plane that is seen at 80 degrees by a camera with 256 pixels on 60 degrees has steps of 2.7 %
// from pixel to pixel. Larger steps are borders of things.
bool AreOneSurface(const std::array<double, 4>& depths) {
  constexpr double kMostStep = 0.05;
  const auto [least, most] = std::minmax_element(depths.begin(), depths.end());
  const bool are_known = std::ranges::all_of(depths, [](double depth) { return depth > 0.0; });
  return are_known && *most - *least <= kMostStep * *least;
}

double Mix(const std::array<double, 4>& depths, double column, double row) {
  const double above = (1.0 - column) / depths[0] + column / depths[1];
  const double below = (1.0 - column) / depths[2] + column / depths[3];
  return 1.0 / ((1.0 - row) * above + row * below);
}

template <typename Value>
void Fill(const cv::Mat& depth, cv::Mat& fitted) {
  const std::vector<Place> columns = PlacesAlong(depth.cols, fitted.cols);
  const std::vector<Place> rows = PlacesAlong(depth.rows, fitted.rows);
  for (size_t y = 0; y < rows.size(); ++y) {
    const auto* const above = depth.ptr<Value>(rows[y].first);
    const auto* const below = depth.ptr<Value>(rows[y].second);
    const auto* const nearest = depth.ptr<Value>(rows[y].nearest);
    auto* const filled = fitted.ptr<Value>(static_cast<int>(y));
    for (size_t x = 0; x < columns.size(); ++x) {
      const Place& column = columns[x];
      const std::array<double, 4> four{
          static_cast<double>(above[column.first]), static_cast<double>(above[column.second]),
          static_cast<double>(below[column.first]), static_cast<double>(below[column.second])};
      if (!AreOneSurface(four)) {
        filled[x] = nearest[column.nearest];
      } else {
        filled[x] = cv::saturate_cast<Value>(Mix(four, column.share, rows[y].share));
      }
    }
  }
}

}  // namespace

bool HaveSameShape(const cv::Size& depth, const cv::Size& colour) {
  constexpr double kTolerance = 0.01;
  const double ratio = static_cast<double>(depth.width) * colour.height /
                       (static_cast<double>(depth.height) * colour.width);
  return depth.width > 0 && depth.height > 0 && std::abs(ratio - 1.0) <= kTolerance;
}

cv::Mat FitDepth(const cv::Mat& depth, const cv::Size& size) {
  Check(depth.empty() || depth.type() == CV_16UC1 || depth.type() == CV_32FC1,
        "the depth image is neither CV_16UC1 nor CV_32FC1");
  if (depth.empty() || depth.size() == size) {
    return depth;
  }
  cv::Mat fitted(size, depth.type());
  if (depth.type() == CV_16UC1) {
    Fill<uint16_t>(depth, fitted);
  } else {
    Fill<float>(depth, fitted);
  }
  return fitted;
}

cv::Mat WithoutDisparityOffset(const cv::Mat& depth, double offset, double bf,
                               double units_per_metre) {
  if (offset == 0.0) {
    return depth;
  }
  // 1 / z = 1 / z_measured - offset / bf, in the units of the image.
  const bool is_metric = depth.type() == CV_32FC1;
  const double shift = offset / (bf * (is_metric ? 1.0 : units_per_metre));
  cv::Mat corrected(depth.size(), depth.type());
  const auto correct = [&](auto value, const int* place) {
    using Value = decltype(value);
    const auto measured = static_cast<double>(depth.at<Value>(place));
    const double inverse = measured > 0.0 ? 1.0 / measured - shift : 0.0;
    const double units = inverse > 0.0 ? 1.0 / inverse : 0.0;
    corrected.at<Value>(place) = cv::saturate_cast<Value>(units);
  };
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const std::array<int, 2> place = {y, x};
      is_metric ? correct(float(), place.data()) : correct(uint16_t(), place.data());
    }
  }
  return corrected;
}

DepthReprojection::DepthReprojection(const PinholeCamera& camera,
                                     const std::array<double, 6>& depth_from_colour)
    : size_(camera.width, camera.height) {
  const Eigen::Map<const Eigen::Vector3d> turn(depth_from_colour.data());
  const Eigen::Map<const Eigen::Vector3d> shift(depth_from_colour.data() + 3);
  const Eigen::Matrix3d rotation = ExpSo3(turn).toRotationMatrix();
  depth_shift_ = static_cast<float>(-(rotation.transpose() * shift).z());
  pixels_.reserve(static_cast<size_t>(size_.area()));
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      const Eigen::Vector2d raw(x, y);
      const Eigen::Vector3d ray = camera.Unproject(camera.Undistort(raw), 1.0);
      const auto seen_at = [&](double inverse) -> Eigen::Vector2d {
        return camera.Distort(camera.Project(rotation * ray + inverse * shift));
      };
      constexpr double kStep = 0.5;  // 1/m
      const Eigen::Vector2d at_infinity = seen_at(0.0);
      pixels_.push_back({(at_infinity - raw).cast<float>(),
                         ((seen_at(kStep) - at_infinity) / kStep).cast<float>(),
                         static_cast<float>((rotation.transpose() * ray).z())});
    }
  }
}

template <typename Value>
void DepthReprojection::Fill(const cv::Mat& depth, float units, cv::Mat& registered) const {
  for (int y = 0; y < size_.height; ++y) {
    auto* const row = registered.ptr<Value>(y);
    for (int x = 0; x < size_.width; ++x) {
      row[x] = Value(0);
      const auto here = static_cast<float>(depth.at<Value>(y, x));
      if (!(here > 0.0F) || !std::isfinite(here)) {
        continue;
      }
      const Pixel& pixel = pixels_[static_cast<size_t>(y * size_.width + x)];
      const Eigen::Vector2f move = pixel.at_infinity + pixel.by_inverse * (units / here);
      const int column = x + static_cast<int>(std::lround(move.x()));
      const int line = y + static_cast<int>(std::lround(move.y()));
      if (column < 0 || line < 0 || column >= size_.width || line >= size_.height) {
        continue;
      }
      const auto there = static_cast<float>(depth.at<Value>(line, column));
      if (there > 0.0F && std::isfinite(there)) {
        const float factor = pixels_[static_cast<size_t>(line * size_.width + column)].depth_factor;
        row[x] = cv::saturate_cast<Value>(std::max(there * factor + units * depth_shift_, 0.0F));
      }
    }
  }
}

cv::Mat DepthReprojection::Register(const cv::Mat& depth, double units_per_metre) const {
  Check(depth.size() == size_, "the depth image has another size than the camera's images");
  cv::Mat registered(depth.size(), depth.type());
  if (depth.type() == CV_16UC1) {
    Fill<uint16_t>(depth, static_cast<float>(units_per_metre), registered);
  } else {
    Fill<float>(depth, 1.0F, registered);
  }
  return registered;
}

}  // namespace hullslam
