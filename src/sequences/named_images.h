// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The images of a folder without a list, in order of time, as frames without depth.
struct NamedImages {
  std::vector<FramePaths> frames = {};
  bool are_numbered = false;  // else their names are time stamps
};

// Files that end in .png, .jpg or .jpeg, in upper or lower case, in natural order of their names
// (frame2 before frame10). Throws InputError for an image in another format, because it would be
// missing silently.
// Only files whose names contain `part` count.
std::vector<std::filesystem::path> ListImages(const std::filesystem::path& folder,
                                              std::string_view part = {});

// The last number in a name without its extension: "12.5" of "left_12.5" and "0007" of
// "frame-0007.color".
std::string_view LastNumber(std::string_view name);

// Finds the time stamps of images by the last number in each name without its extension. A number
// with a decimal point is in seconds. A whole number of 13, 16 or 19 digits is in milliseconds,
// microseconds or nanoseconds, as of clocks that begin in 1970. Any other whole number is the
// number of a frame, whose stamp is number / `frames_per_second`. Throws InputError for a folder
// without images, names of different kinds, two images with the same number, and numbers with gaps
// that no camera makes.
NamedImages FindNamedImages(const std::filesystem::path& folder, double frames_per_second,
                            std::string_view part = {});

}  // namespace hullslam
