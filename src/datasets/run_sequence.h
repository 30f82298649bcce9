// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"
#include "results/finished_run.h"

namespace hullslam {

// Opens the sequence of a finished run, which is at `path` now, for its images and its ground
// truth. With `use_depth`, the frames of RGB-D runs have the paths of their depth images. Throws
// InputError as the functions that open sequences do, and if the data set is not known.
ImageSequence OpenRunSequence(const SequenceOfRun& run, const std::filesystem::path& path,
                              const PinholeCamera& camera, bool use_depth = false);

}  // namespace hullslam
