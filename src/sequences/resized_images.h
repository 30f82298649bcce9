// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Resizes all images of the sequence, which have this size, to the camera's size when they
// are loaded, and masks with them. Depth images take the nearest pixel, since a mean of foreground
// and background is the depth of neither. The size is kept among the sequence's choices, so that
// OpenRunSequence() resizes them too.
void ResizeImages(int read_width, int read_height, const PinholeCamera& camera,
                  ImageSequence& sequence);

// The same with the size that was kept, such as "1280x720"; nothing if it is empty. Throws
// InputError if it is no size.
void ResizeImages(const std::string& size, const PinholeCamera& camera, ImageSequence& sequence);

}  // namespace hullslam
