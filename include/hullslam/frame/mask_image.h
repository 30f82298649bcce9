// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hullslam/frame/instance_mask.h"

namespace hullslam {

// Masks from images of a segmentation network. Both functions give outlines that run halfway
// between the centres of inside and outside pixels, so no half pixel has to be added or subtracted.

// The mask of one object. `inside` is CV_8UC1 (also a cv::Mat of bool) and has the size of the
// colour image; it is not 0 at the pixels of the object. The mask has no outline if no part of it
// has an area of 1 px^2. Throws InputError for another type.
InstanceMask MaskFromImage(const cv::Mat& inside, std::string label, double score = 1.0);

// The class and score of an instance in a label image.
struct InstanceClass {
  std::string label;
  double score = 1.0;
};

// The masks in an image of labels (CV_8UC1, CV_16UC1 or CV_32SC1): a pixel has the number of the
// instance that it shows, or 0. The masks come in the order of the numbers, and those without an
// outline are left out. Throws InputError for another type, and for a number that `classes` does
// not have.
std::vector<InstanceMask> MasksFromLabels(const cv::Mat& labels,
                                          const std::map<int, InstanceClass>& classes);

}  // namespace hullslam
