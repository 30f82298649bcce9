// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/yolo_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "files/text_rows.h"
#include "hullslam/util/check.h"

namespace hullslam {
namespace {

std::string ShareText(double coordinate, int size) {
  return fmt::format("{:.6g}", std::clamp(coordinate / size, 0.0, 1.0));
}

std::string ScoreText(double score) { return fmt::format("{:.4f}", score); }

double ValueOf(const std::string& text) {
  double value = 0.0;
  Check(ParseFinite(text, value), "the text of a mask is no number");
  return value;
}

void AddShares(double x, double y, const cv::Size& image, std::string& text) {
  text += ' ' + ShareText(x, image.width) + ' ' + ShareText(y, image.height);
}

// The corners of a box are as in BoxOutline(): pixels with integer centres. The shares of a box
// begin at the edge of the first pixel.
void AddBox(const std::vector<Eigen::Vector2d>& corners, const cv::Size& image, std::string& text) {
  const Eigen::Vector2d centre = 0.5 * (corners[0] + corners[2]);
  const Eigen::Vector2d size = corners[2] - corners[0];
  AddShares(centre.x() + 0.5, centre.y() + 0.5, image, text);
  AddShares(size.x(), size.y(), image, text);
}

}  // namespace

std::string YoloText(std::span<const InstanceMask> masks, const std::vector<std::string>& classes,
                     const cv::Size& image) {
  std::string text;
  for (const InstanceMask& mask : masks) {
    const auto found = std::ranges::find(classes, mask.label);
    Check(found != classes.end() && !mask.outlines.empty(), "the mask has no class or no outline");
    text += std::to_string(found - classes.begin());
    if (mask.shape == MaskShape::kBox) {
      AddBox(mask.outlines.front(), image, text);
    } else {
      for (const Eigen::Vector2d& point : mask.outlines.front()) {
        AddShares(point.x(), point.y(), image, text);
      }
    }
    text += ' ' + ScoreText(mask.score) + '\n';
  }
  return text;
}

void RoundAsYoloText(const cv::Size& image, std::vector<InstanceMask>& masks) {
  for (InstanceMask& mask : masks) {
    mask.score = ValueOf(ScoreText(mask.score));
    for (Eigen::Vector2d& point : mask.outlines.front()) {
      point.x() = ValueOf(ShareText(point.x(), image.width)) * image.width;
      point.y() = ValueOf(ShareText(point.y(), image.height)) * image.height;
    }
  }
}

}  // namespace hullslam
