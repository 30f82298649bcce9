// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Reads the images and the right images of the frames from their files, and rectifies them.
// `rectifier` is null for images that are rectified already.
void LoadPairs(std::shared_ptr<const StereoRectifier> rectifier, ImageSequence& sequence);

// Rectifies what the loaders of the sequence give.
void RectifyPairs(std::shared_ptr<const StereoRectifier> rectifier, ImageSequence& sequence);

// The images of the frames show both halves of a pair, the left one first. To be called for a
// sequence whose loaders give such images.
void SplitHalves(std::shared_ptr<const StereoRectifier> rectifier, ImageSequence& sequence);

}  // namespace hullslam
