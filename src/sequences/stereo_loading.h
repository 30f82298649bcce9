// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Reads the images, and the right images if there are some, from their files. Without depth images,
// images of 16 bits are images too.
void LoadWithoutDepth(ImageSequence& sequence);

// The images of the frames show both halves of a pair, the left one first.
void SplitHalves(ImageSequence& sequence);

// Rectifies the pairs. `rectifier` is null for images that are rectified already.
void RectifyPairs(const std::shared_ptr<const StereoRectifier>& rectifier, ImageSequence& sequence);

}  // namespace hullslam
