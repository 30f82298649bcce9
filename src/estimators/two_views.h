// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// One point in two images, as undistorted pixels with the sigma of each in the image as read.
struct PixelPair {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  double sigma_a = 1.0;  // px
  double sigma_b = 1.0;
};

struct TwoViewOptions {
  uint64_t seed = 0;
  size_t min_points = 50;  // least number of points in front of both cameras
  double min_share = 0.7;  // least share of such points among the pairs that agree with any motion
  double min_parallax = 1.2;  // degrees; least angle between the two rays to half of the points
  // If the camera moves towards something that it sees, or away from it, `min_share` and the half
  // of the points above are multiplied by this factor. However far such a camera moves, what is
  // near leaves the image, and what is straight ahead has no parallax.
  double forward_factor = 0.5;
  // A rotation alone may explain at most this share of the pairs that agree with the best motion.
  // Otherwise there is too little parallax.
  double max_turned_share = 0.9;
  // A motion competes if the number of pairs that agree with it is at least this share of the
  // largest such number. The costs of competing motions must exceed the cost of the best one by so
  // many standard deviations that chance does not explain the difference.
  double min_rival_share = 0.75;
  double min_rival_deviations = 3.0;
};

enum class TwoViewFailure {
  kNone,
  kTooFewPairs,
  kTooLittleParallax,  // the camera has not moved, or it has only turned
  kAmbiguous,          // two different motions explain the pairs
  kTooFewPoints,
};

// "too few matches", "too little parallax", "ambiguous", "too few points".
std::string_view ToString(TwoViewFailure failure);

// The motion between two views and the points that both see. The unit of length is the distance of
// the cameras.
struct TwoViews {
  struct Point {
    size_t pair = 0;             // index
    Eigen::Vector3d point_in_a;  // in the camera frame of a
  };
  TwoViewFailure failure = TwoViewFailure::kNone;
  Rigid3 b_from_a;
  std::vector<Point> points;  // by increasing index of the pair
  bool is_forward = false;    // whether the image of a shows the direction of the motion
  double parallax = 0.0;  // degrees, the angle between the two rays that half of the points reach;
                          // if is_forward, a smaller share (TwoViewOptions::forward_factor)

  bool ok() const { return failure == TwoViewFailure::kNone; }
};

// The motion of a camera between two images, from pairs of keypoints, many of which may be wrong.
// Essential matrix and homography are both estimated (OpenCV's USAC), and all motions that follow
// from them compete. A general scene is explained by the essential matrix, a plane by the
// homography. A pair agrees with a motion if its point lies in front of both cameras and reprojects
// within 95 % of its noise. The assumed noise of keypoints is cautious, so in front of a plane even
// a wrong motion may agree with all pairs. Therefore the motions that agree with many pairs are
// refined, and the result is the motion with the least cost under the measured noise
// (RefineMotion). If a different motion has about the same cost, or if the rays are nearly
// parallel, there is no result. The same input and seed give the same bits.
TwoViews EstimateTwoViews(const PinholeCamera& camera, std::span<const PixelPair> pairs,
                          const TwoViewOptions& options);

}  // namespace hullslam
