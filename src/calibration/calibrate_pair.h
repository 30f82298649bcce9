// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "calibration/pair_rotation.h"
#include "calibration/recorded_camera.h"

namespace hullslam {

// Matches of points in two images, of which each is the best of the other, by the descriptors of
// ORB: with at most 50 different bits, and at most 0.8 of those of the next one. Positions are
// refined to fractions of a pixel. The rows may differ by a rotation of 3 degrees about x and z,
// and 20 px more. Both are CV_8UC1.
std::vector<PairMatch> MatchAnywhere(const cv::Mat& left, const cv::Mat& right,
                                     const PinholeCamera& camera);

// Matches up to 60 pairs, evenly chosen from all recordings, in the order of time. Images that
// cannot be read are left out. Empty if it is cancelled.
std::vector<MatchedPair> MatchPairs(std::span<const CameraRecording> recordings,
                                    const PinholeCamera& camera, const Cancellation* cancellation);

// Takes the number for the offset of disparities out of a result, and tells it as a yaw. It is also
// determined if it is not 0 by 4 sigmas.
PairEvidence TakeYaw(CameraCalibrationResult& result);

struct PairCalibration {
  RecordedCalibration recorded;  // of the images that are rectified with the deviation
  PairRows rows;
  PairEvidence yaw;
  PairDeviation deviation;  // of the given calibration; only what is changed
  PinholeCamera given;      // of the images as they were given
  PinholeCamera rectified;  // before its numbers were calibrated
  bool is_changed = false;

  // The calibration of both cameras as read, with everything that was calibrated. `rectifier` has
  // made the images that were given.
  StereoCalibration Cameras(const StereoRectifier& rectifier) const;
};

// A pair of cameras without distortion that are as far apart as Camera.bf says.
StereoCalibration RectifiedPair(const PinholeCamera& camera);

// Calibrates the pair of `options`: first the rotation of the right camera from the rows of points
// (FitPairRows), then the camera as CalibrateFromRecordings() does, from images that are rectified
// with this rotation. There the disparities of points have an offset, as one more number: it is the
// yaw, and without it disparities that are wrong by a tenth of a pixel would change f. If the yaw
// changes, SLAM runs again. Throws InputError likewise, and if the images of the pairs do not
// belong together in time.
PairCalibration CalibratePair(SystemOptions options, std::span<const CameraRecording> recordings,
                              RecordedCalibrationOptions calibration);

}  // namespace hullslam
