// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
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

// How a run opened its sequence, by its summary.json.
struct RunOpening {
  std::string program;  // such as "rgbd_tum" or "mono_video"; it tells the format
  std::map<std::string, std::string> choices = {};  // ImageSequence::choices
};

// The opening in the content of a summary.json; what is not in it, or of another type, is left out.
RunOpening ReadRunOpening(const nlohmann::json& summary);

// Opens the sequence for its images and its ground truth. With `use_depth`, the frames of programs
// for RGB-D have the paths of their depth images. Throws InputError as the functions that open
// sequences do.
ImageSequence OpenRunSequence(const RunOpening& run, const std::filesystem::path& sequence,
                              const PinholeCamera& camera, bool use_depth = false);

}  // namespace hullslam
