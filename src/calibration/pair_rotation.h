// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// A point that both images of a pair show, px in the images that the given calibration has
// rectified. Some are wrong.
struct PairMatch {
  Eigen::Vector2d left;
  Eigen::Vector2d right;
  double sigma = 1.0;  // of a row, px
};

struct MatchedPair {
  std::vector<PairMatch> matches;
  // How much lower the points are in the next left image: a median, px.
  std::optional<double> moved_down;
};

// The deviation of a pair from its given calibration, which says that the images are rectified.
struct PairDeviation {
  // The rotation vector from the right camera as given to the right camera as it is, rad: pitch
  // about x (right), yaw about y (down), roll about z (forward).
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  double row_offset = 0.0;  // how much lower the right image is, after the rotation, px
  // The right camera is at b (1, down, ahead) in the left one, where b is the baseline. The rows do
  // not tell b, because a larger world looks the same.
  double down = 0.0;
  double ahead = 0.0;

  // The pixel of the right image as given, without rotation and offset.
  Eigen::Vector2d Undone(const PinholeCamera& camera, const Eigen::Vector2d& right) const;
  // The row of Undone(right) less the row in which the deviating baseline puts the point, px:
  //   v' - v + (fy down - (v - cy) ahead) (u - u') / fx,  with the pixel (u, v) of the left image.
  double RowError(const PinholeCamera& camera, const PairMatch& match) const;
  // The calibration with this deviation. Row offset and intrinsics of `rectified` are converted to
  // the focal length of the right camera as read.
  StereoCalibration AppliedTo(const StereoCalibration& given, const StereoRectifier& rectifier,
                              const PinholeCamera& rectified) const;
};

// The numbers of a deviation. If some are not determined, the last of them is held first.
enum class PairNumber { kPitch, kRoll, kRowOffset, kDown, kAhead, kYaw };
inline constexpr size_t kPairNumbers = 6;

// What a recording tells about one of them.
struct PairEvidence {
  double value = 0.0;  // rad or px
  double sigma = 0.0;  // with the systematic error of rows
  bool is_determined = false;
};

struct PairRows {
  PairDeviation found;  // the numbers that are determined
  std::array<PairEvidence, kPairNumbers> evidence;
  size_t matches = 0;
  double median_before = 0.0;  // of the lengths of the row errors, px
  double median = 0.0;         // without the deviation that was found
  // Whether the given calibration contradicts the rows: see FitPairRows().
  bool is_changed = false;
  // How many frames later the right images were taken than the left ones, if the motion of the
  // images tells so.
  double frames_late = 0.0;
  double frames_late_sigma = 0.0;
  bool is_late = false;

  const PairEvidence& Of(PairNumber number) const {
    return evidence.at(static_cast<size_t>(number));
  }
};

// Fits the deviation of a pair to the rows of all its matches. A rotation w = (p, y, r) and an
// offset c move the row of a point in the direction (X, Y, 1), whatever its distance is, by
//   fy (-p (1 + Y^2) + y X Y + r X) + c,
// which tells pitch p, roll r and, by the curvature, c. The yaw y is only freed, because X Y also
// is what a decentred lens does; disparities tell it (YawOf). The loss is Cauchy's. The standard
// deviations are those of a jackknife over ten pieces of the recording (as in MeasureEvidence), and
// a pattern of 0.03 px in the rows, which lenses and corners leave. A number counts as determined
// if its error moves rows by less than 0.75 px, a root mean square, or if it is not 0 by 4 sigmas;
// others are held at 0.
//
// The calibration is changed if the numbers are improbable, being 0: if the chi-square variable
// t^T C^-1 t with their covariance C is 4 standard deviations above its mean; and if the change
// moves rows by more than 0.25 px, since calibrated pairs are off by a few tenths of a pixel.
// Angles above 0.1 rad and offsets above 40 px are not believed.
//
// The right images are late by d frames if the mean error of the rows of a pair is d times the
// motion of the left image to the next one, by 4 sigmas and 0.25 px. Then nothing is changed.
PairRows FitPairRows(std::span<const MatchedPair> pairs, const PinholeCamera& camera,
                     double yaw = 0.0);

// The yaw that makes the measured disparities larger by `disparity_offset` px, rad: a yaw y makes
// them smaller by fx y (1 + X^2), on average over the width of the image.
double YawOf(double disparity_offset, const PinholeCamera& camera);

}  // namespace hullslam
