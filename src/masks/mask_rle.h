// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace hullslam {

// The lengths of runs of pixels in a mask that is read column by column. Runs outside and inside
// the mask alternate; the first run is outside and may be 0.
using MaskRuns = std::vector<uint32_t>;

// Decodes runs in COCO's compressed form: five bits per character. From the fourth run on, the
// number is the difference to the previous run of the same kind (outside or inside). Returns
// nothing for other characters, for an incomplete number, and for a run below 0 or above 32 bits.
std::optional<MaskRuns> DecodeRuns(std::string_view text);

// The sum of all runs. It must be width x height.
uint64_t CountPixels(const MaskRuns& runs);

// The outlines of the mask, as from FindMaskOutlines(). Requires CountPixels(runs) = width x
// height.
std::vector<std::vector<Eigen::Vector2d>> OutlineRuns(const MaskRuns& runs, int width, int height);

}  // namespace hullslam
