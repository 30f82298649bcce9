// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/distorted_pairs.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace hullslam {
namespace {

constexpr size_t kFewestPoints = 60;

// A raw point from the middle of the image, undistorted, and its derivative by the raw one.
struct Undistorted {
  Eigen::Vector3d point;  // homogeneous
  Eigen::Matrix2d by_raw;
};

class Division {
 public:
  Division(double distortion, int width, int height)
      : distortion_(distortion),
        middle_(0.5 * (width - 1), 0.5 * (height - 1)),
        half_(0.5 * std::hypot(width, height)) {}

  Undistorted Of(const Eigen::Vector2d& raw) const {
    const Eigen::Vector2d from_middle = (raw - middle_) / half_;
    const double factor = 1.0 / (1.0 + distortion_ * from_middle.squaredNorm());
    const Eigen::Vector2d point = factor * from_middle;
    return {point.homogeneous(),
            (factor * Eigen::Matrix2d::Identity() -
             2.0 * distortion_ * factor * factor * from_middle * from_middle.transpose()) /
                half_};
  }
  double half() const { return half_; }

 private:
  double distortion_;
  Eigen::Vector2d middle_;
  double half_;
};

// The fundamental matrix of undistorted points. Null if there is none.
std::optional<Eigen::Matrix3d> FundamentalMatrix(const std::vector<Undistorted>& a,
                                                 const std::vector<Undistorted>& b,
                                                 double threshold) {
  std::vector<cv::Point2d> in_a;
  std::vector<cv::Point2d> in_b;
  for (size_t i = 0; i < a.size(); ++i) {
    in_a.emplace_back(a[i].point.x(), a[i].point.y());
    in_b.emplace_back(b[i].point.x(), b[i].point.y());
  }
  cv::UsacParams params;
  params.threshold = threshold;
  params.confidence = 0.999;
  params.maxIterations = 1000;
  params.loMethod = cv::LOCAL_OPTIM_INNER_LO;
  params.score = cv::SCORE_METHOD_MSAC;
  cv::Mat mask;
  const cv::Mat found = cv::findFundamentalMat(in_a, in_b, mask, params);
  if (found.rows != 3 || found.cols != 3) {
    return std::nullopt;
  }
  Eigen::Matrix3d fundamental;
  cv::cv2eigen(found, fundamental);
  return fundamental;
}

// The mean over the points of min(e^2, 1), with the error e of each (Sampson 1982) in `kInlier` raw
// pixels.
double CostOf(const DistortedPair& pair, const Division& division) {
  constexpr double kInlier = 1.0;  // px
  std::vector<Undistorted> a;
  std::vector<Undistorted> b;
  for (size_t i = 0; i < pair.a.size(); ++i) {
    a.push_back(division.Of(pair.a[i]));
    b.push_back(division.Of(pair.b[i]));
  }
  const auto fundamental = FundamentalMatrix(a, b, kInlier / division.half());
  double cost = 0.0;
  for (size_t i = 0; i < a.size() && fundamental; ++i) {
    const Eigen::Vector3d line_in_b = *fundamental * a[i].point;
    const Eigen::Vector3d line_in_a = fundamental->transpose() * b[i].point;
    const double error = b[i].point.dot(line_in_b);
    const double variance = (a[i].by_raw.transpose() * line_in_a.head<2>()).squaredNorm() +
                            (b[i].by_raw.transpose() * line_in_b.head<2>()).squaredNorm();
    cost += std::min(1.0, error * error / (kInlier * kInlier * variance));
  }
  return fundamental ? cost / static_cast<double>(a.size()) : 1.0;
}

}  // namespace

std::optional<double> RadialDistortionOf(std::span<const DistortedPair> pairs, int width,
                                         int height) {
  constexpr double kStep = 0.05;
  constexpr int kValues = 24;      // from -0.8
  constexpr double kLeast = -0.8;  // nearly a fisheye lens
  std::array<double, kValues> costs{};
  bool is_known = false;
  for (const DistortedPair& pair : pairs) {
    if (pair.a.size() < kFewestPoints) {
      continue;
    }
    is_known = true;
    for (int i = 0; i < kValues; ++i) {
      costs.at(static_cast<size_t>(i)) += CostOf(pair, Division(kLeast + kStep * i, width, height));
    }
  }
  if (!is_known) {
    return std::nullopt;
  }
  // A parabola through the costs near the least one, which smooths the chance of the samples.
  constexpr int kReach = 4;
  const auto best = static_cast<int>(std::ranges::min_element(costs) - costs.begin());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int i = std::max(0, best - kReach); i <= std::min(kValues - 1, best + kReach); ++i) {
    const double x = i - best;
    const Eigen::Vector3d row(1.0, x, x * x);
    normal += row * row.transpose();
    right += costs.at(static_cast<size_t>(i)) * row;
  }
  const Eigen::Vector3d parabola = normal.ldlt().solve(right);
  const double shift = parabola[2] > 0.0 ? -0.5 * parabola[1] / parabola[2] : 0.0;
  return kLeast + kStep * (best + std::clamp(shift, -1.0 * kReach, 1.0 * kReach));
}

void SetDivisionModel(double distortion, PinholeCamera& camera) {
  constexpr int kPoints = 20;
  const double half = 0.5 * std::hypot(camera.width, camera.height) / camera.fx;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int i = 1; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    const double distorted = share * half;
    const double undistorted = distorted / (1.0 + distortion * share * share);
    const double cube = undistorted * undistorted * undistorted;
    const Eigen::Vector2d row(cube, cube * undistorted * undistorted);
    normal += row * row.transpose();
    right += row * (distorted - undistorted);
  }
  const Eigen::Vector2d coefficients = normal.ldlt().solve(right);
  camera.k1 = coefficients[0];
  camera.k2 = coefficients[1];
}

}  // namespace hullslam
