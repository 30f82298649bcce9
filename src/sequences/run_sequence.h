// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// Finds what a finished run, whose folder is `run_folder`, has read or written elsewhere: its
// sequence, masks or map. `input` is the path in its summary.json: a relative one is looked for in
// the working directory, then in `run_folder` and in all folders above it. Absent if it is not
// found there.
std::optional<std::filesystem::path> FindRunInput(const std::string& input,
                                                  const std::filesystem::path& run_folder);

// Opens the sequence for its images and its ground truth. With `use_depth`, the frames of programs
// for RGB-D have the paths of their depth images. `program` is the one of the run, such as
// "rgbd_tum" or "mono_video"; it tells the format. Throws InputError as the functions that open
// sequences do.
ImageSequence OpenRunSequence(const std::string& program, const std::filesystem::path& sequence,
                              const PinholeCamera& camera, bool use_depth = false);

}  // namespace hullslam
