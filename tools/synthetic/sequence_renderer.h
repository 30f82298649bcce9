// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>

#include "synthetic/sequence_plan.h"

namespace hullslam::synthetic {

// Renders all frames of a sequence into the folder, which must exist and be empty, and writes its
// lists and its ground truth. `threads`: 0 for as many as the CPU supports; the files do not depend
// on it. `progress` is called after each frame with the number of finished frames, by one thread at
// a time; it returns false to stop. Returns whether the sequence was completed. Throws InputError
// or filesystem_error if a file cannot be written.
bool RenderSequence(const std::filesystem::path& folder, const SequencePlan& plan, int threads,
                    const std::function<bool(int)>& progress);

}  // namespace hullslam::synthetic
