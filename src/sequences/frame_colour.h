// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Time stamps that differ by at most this much are of the same moment, s: files round them.
inline constexpr double kSameMoment = 1e-3;

// The frame of the sequence whose time stamp is nearest to this one; null if that is of another
// moment. It lives as long as the sequence.
const FramePaths* FindFrameAt(const ImageSequence& sequence, double timestamp);

// The image of a frame in colour, CV_8UC3 with blue first, in raw pixels. A grey image has three
// equal channels. To be called like ImageSequence::load. Throws InputError if the image cannot be
// read or does not have the size of the camera.
cv::Mat LoadColour(const ImageSequence& sequence, const FramePaths& frame,
                   const PinholeCamera& camera);

}  // namespace hullslam
