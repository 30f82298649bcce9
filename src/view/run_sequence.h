// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The sequence of a finished run, whose folder is `run_folder`. `sequence` is the path in its
// summary.json: a relative one is looked for in the working directory, then in `run_folder` and in
// all folders above it. Absent if it is not found there.
std::optional<std::filesystem::path> FindSequence(const std::string& sequence,
                                                  const std::filesystem::path& run_folder);

// Opens the sequence for its images and its ground truth, without depth. `program` is the one of
// the run, such as "rgbd_tum" or "mono_video"; it tells the format. Throws InputError as the
// functions that open sequences do.
ImageSequence OpenRunSequence(const std::string& program, const std::filesystem::path& sequence,
                              const PinholeCamera& camera);

}  // namespace hullslam
