// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/mask_image.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <utility>

#include "frame/detection/mask_outline.h"
#include "hullslam/util/error.h"

namespace hullslam {

InstanceMask MaskFromImage(const cv::Mat& inside, std::string label, double score) {
  if (inside.type() != CV_8UC1) {
    throw InputError("the image of the mask is not CV_8UC1");
  }
  InstanceMask mask{
      .label = std::move(label), .score = score, .outlines = FindMaskOutlines(inside)};
  SortByArea(mask.outlines);
  return mask;
}

std::vector<InstanceMask> MasksFromLabels(const cv::Mat& labels,
                                          const std::map<int, InstanceClass>& classes) {
  if (labels.type() != CV_8UC1 && labels.type() != CV_16UC1 && labels.type() != CV_32SC1) {
    throw InputError("the image of labels is neither CV_8UC1 nor CV_16UC1 nor CV_32SC1");
  }
  std::vector<InstanceMask> masks;
  for (auto& [number, outlines] : FindLabelOutlines(labels)) {
    const auto entry = classes.find(number);
    if (entry == classes.end()) {
      throw InputError(
          fmt::format("the image of labels has the instance {}, which has no class", number));
    }
    InstanceMask mask{.label = entry->second.label,
                      .score = entry->second.score,
                      .outlines = std::move(outlines)};
    SortByArea(mask.outlines);
    if (!mask.outlines.empty()) {
      masks.push_back(std::move(mask));
    }
  }
  return masks;
}

}  // namespace hullslam
