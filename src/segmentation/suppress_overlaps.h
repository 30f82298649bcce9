// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "segmentation/candidate.h"

namespace hullslam {

// Non-maximum suppression: keeps the candidates, best score first, whose box overlaps the box of no
// better one of the same class by more than kMostOverlap (intersection over union), and at most
// kMostInstances of them. Ties go to the first.
inline constexpr double kMostOverlap = 0.7;    // as networks of YOLO are evaluated
inline constexpr size_t kMostInstances = 300;  // in an image; COCO's evaluation counts 100
std::vector<Candidate> SuppressOverlaps(std::vector<Candidate> candidates);

}  // namespace hullslam
