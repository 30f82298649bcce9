// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "hullslam/camera/pinhole.h"

namespace hullslam {

// The number with up to six digits.
std::string PrintNumber(double value);

// The reason, with its key, why the distortion cannot be that of a lens that took these images: it
// has no inverse at a pixel of the image, the undistorted image has a very different size, or a
// coefficient is given that the model does not have. Empty if there is nothing wrong.
std::string FindLensFault(const PinholeCamera& camera);

}  // namespace hullslam
