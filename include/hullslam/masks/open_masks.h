// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hullslam/masks/mask_source.h"

namespace hullslam {

// The names of all formats (docs/masks.md).
std::vector<std::string> MaskFormatNames();

// Throws InputError if the format is unknown, if none or several formats fit (the message says what
// was found), or if no frame has an entry. The last message shows the name of one entry and the
// name of one frame. `frames` must not be empty.
std::unique_ptr<const MaskSource> OpenMasks(const MaskRequest& request,
                                            std::span<const MaskFrame> frames);

}  // namespace hullslam
