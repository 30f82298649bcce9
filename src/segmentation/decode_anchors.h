// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "segmentation/network_layout.h"

namespace hullslam {

inline constexpr int kAnchorsPerCell = 3;

// Decodes the maps of YOLOv5, 1 x (3 * (5 + classes + coefficients)) x rows x columns. For each of
// the three anchors of a cell, the channels are the logits of x, y, width, height, objectness and
// classes, and the coefficients. With the sigmoid s, the centre of the box is 2 s - 0.5 cells from
// the corner of the cell, and its size is (2 s)^2 times the anchor's. The anchors are as in
// the networks that were trained on COCO, which nearly all others keep; the maps do not have
// them.
std::vector<Candidate> DecodeAnchors(const NetworkLayout& layout,
                                     std::span<const NetworkOutput> outputs,
                                     const CandidateFilter& filter);

}  // namespace hullslam
