// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "segmentation/candidate.h"
#include "segmentation/letterbox.h"

namespace hullslam {

// The outline of the largest part of a mask, in pixels of the image with integer centres; empty if
// no part has an area of 1 px^2.
//
// The logits of the mask are the sum of the prototypes (1 x coefficients x rows x columns) weighted
// by the coefficients. They are interpolated at the pixels of the image, where those inside the box
// with a positive logit belong to the mask: a mask that is decided at the resolution of the
// prototypes and then scaled up would have corners of several pixels.
std::vector<Eigen::Vector2d> FindInstanceOutline(const Candidate& candidate,
                                                 const cv::Mat& prototypes,
                                                 const Letterbox& letterbox);

// The corners of the box, cut at the border of the image, in the same pixels.
std::vector<Eigen::Vector2d> BoxOutline(const Candidate& candidate, const Letterbox& letterbox);

}  // namespace hullslam
