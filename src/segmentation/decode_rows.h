// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "segmentation/network_layout.h"

namespace hullslam {

// Decodes the output of YOLOv8 and YOLO11 with the decoding of the exporter, 1 x (4 + classes +
// coefficients) x cells: the centre, width and height of the box, px, the scores of the classes,
// and the coefficients.
std::vector<Candidate> DecodeColumns(const NetworkLayout& layout,
                                     std::span<const NetworkOutput> outputs,
                                     const CandidateFilter& filter);

// Decodes YOLOv5's output, 1 x anchors x (5 + classes + coefficients): the box as above, the score
// of an object, the scores of the classes, and the coefficients. A candidate has the product of
// both scores.
std::vector<Candidate> DecodeRows(const NetworkLayout& layout,
                                  std::span<const NetworkOutput> outputs,
                                  const CandidateFilter& filter);

}  // namespace hullslam
