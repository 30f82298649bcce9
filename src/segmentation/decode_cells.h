// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "segmentation/network_layout.h"

namespace hullslam {

// Each of the four sides of a box is a distribution over this many distances, in strides.
inline constexpr int kDistances = 16;
inline constexpr int kBoxChannels = 4 * kDistances;

// Decodes the maps of YOLOv8 and YOLO11, 1 x (kBoxChannels + classes + coefficients) x rows x
// columns. The channels of a cell are the logits of the distances of the left, upper, right and
// lower side from the centre of the cell, the logits of the classes, and the coefficients. A
// distance is the mean of its distribution, the softmax of the logits.
std::vector<Candidate> DecodeCells(const NetworkLayout& layout,
                                   std::span<const NetworkOutput> outputs,
                                   const CandidateFilter& filter);

}  // namespace hullslam
