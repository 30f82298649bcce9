// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Gives the sequence the file of --groundtruth in place of its own ground truth; "none" takes the
// own one away. Throws InputError if the file cannot be read, or if no true pose has a stamp during
// the images. `expected` says for the message what the user can do then.
void UseGivenGroundtruth(const std::filesystem::path& file, const std::string& expected,
                         ImageSequence& sequence);

// The ground truth of the sequence. SLAM does not need it: what was skipped or converted is printed
// as a warning, and if it cannot be used, so is the reason, and the result is absent.
std::optional<Trajectory> FindGroundtruth(const ImageSequence& sequence);

}  // namespace hullslam
