// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/recorded_camera.h"

namespace hullslam {

// The camera of `options` with a radial distortion and a focal length that fit a recording. Of the
// intrinsics only the size of the image is used. The distortion is estimated from pairs of images
// all over the recording (RadialDistortionOf). Then SLAM runs on the first frames with this
// distortion and fields of view from 45 to 100 degrees, and the lens is calibrated from each. The
// one with which most points are seen in most images, with the smallest errors, wins. Throws
// InputError if SLAM fails with all of them.
PinholeCamera GuessCamera(SystemOptions options, const CameraRecording& recording,
                          const RecordedCalibrationOptions& calibration);

}  // namespace hullslam
