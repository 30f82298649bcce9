// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace hullslam {

// Lengths of runs of pixels outside and inside a mask in turn, outside first, column after column.
using MaskRuns = std::vector<uint32_t>;

// The runs in COCO's compressed form: five bits a character, the difference from the last run of
// the same kind from the fourth on. Nothing for other characters, an end in the middle of a number,
// or a run below 0 or beyond 32 bits.
std::optional<MaskRuns> DecodeRuns(std::string_view text);

// The sum of all runs, which must be width x height.
uint64_t CountPixels(const MaskRuns& runs);

// The outlines of the mask, as of FindMaskOutlines(). Needs CountPixels(runs) = width x height.
std::vector<std::vector<Eigen::Vector2d>> OutlineRuns(const MaskRuns& runs, int width, int height);

}  // namespace hullslam
