// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Checks the file of --groundtruth. Throws InputError if it cannot be read, or if no true pose has
// the time of an image, because the error of the run would then silently be missing. `expected`
// ends the message.
void CheckGivenGroundtruth(const std::filesystem::path& file, const ImageSequence& images,
                           const std::string& expected);

}  // namespace hullslam
