// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace hullslam {

// The scene of a finished run or of a file of --save-map, whichever `source` is. Throws InputError
// if the run has none, and for broken files.
Scene LoadScene(const std::filesystem::path& source);

}  // namespace hullslam
