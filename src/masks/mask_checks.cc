// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_checks.h"

#include <algorithm>
#include <utility>

#include "frame/detection/mask_outline.h"
#include "util/text.h"

namespace hullslam {
std::string ImageStem(std::string_view name) {
  name.remove_prefix(std::min(name.find_last_of("/\\") + 1, name.size()));
  const size_t dot = name.find_last_of('.');
  if (dot == std::string_view::npos || dot + 1 == name.size()) {
    return std::string(name);
  }
  const std::string_view extension = name.substr(dot + 1);
  const bool is_extension = std::all_of(extension.begin(), extension.end(), IsLetter);
  return std::string(is_extension ? name.substr(0, dot) : name);
}

bool IsNearImage(const Eigen::Vector2d& point, const MaskRequest& request) {
  const auto is_near = [](double value, int size) {
    return value >= -0.5 - kMostBeyondImage && value <= size - 0.5 + kMostBeyondImage;
  };
  return is_near(point.x(), request.width) && is_near(point.y(), request.height);
}

std::vector<Eigen::Vector2d> BoxOutline(double left, double top, double right, double bottom,
                                        const MaskRequest& request) {
  const auto clip = [](double edge, int size) {
    return std::clamp(edge, 0.0, static_cast<double>(size)) - 0.5;
  };
  const Eigen::Vector2d low(clip(left, request.width), clip(top, request.height));
  const Eigen::Vector2d high(clip(right, request.width), clip(bottom, request.height));
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

void AddInstance(InstanceMask instance, FrameMasks& frame) {
  instance.label = Printable(instance.label);
  SortByArea(instance.outlines);
  if (instance.outlines.empty()) {
    ++frame.without_area;
  } else {
    frame.rows.push_back(frame.masks.size() + frame.without_area);
    frame.masks.push_back(std::move(instance));
  }
}

bool HasTooMany(const FrameMasks& frame) {
  return frame.masks.size() + frame.without_area + frame.crowds > kMostInstances;
}

}  // namespace hullslam
