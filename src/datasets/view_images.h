// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>

#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The images of a frame for tools that need little of them.
struct ViewImages {
  cv::Mat grey;   // empty if it was not asked for, or if its file is missing
  cv::Mat depth;  // of the size of the camera; empty without depth
};

// Whether the frame has an image. Only files of images may be missing.
bool HasImage(const ImageSequence& sequence, const FramePaths& frame);

// Reads what is needed: the depth, and the image if it is asked for. Throws InputError for what
// ImageSequence::load refuses.
ViewImages ReadView(const ImageSequence& sequence, const FramePaths& frame,
                    const PinholeCamera& camera, bool with_image);

}  // namespace hullslam
