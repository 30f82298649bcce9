// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/instance_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

bool HasDirection(const std::vector<float>& vector) {
  const auto is_finite = [](float element) { return std::isfinite(element); };
  const auto is_zero = [](float element) { return element == 0.0F; };
  return std::all_of(vector.begin(), vector.end(), is_finite) &&
         !std::all_of(vector.begin(), vector.end(), is_zero);
}

// The fault of the mask; empty if it has none.
std::string FindFault(const InstanceMask& mask, int width, int height) {
  if (mask.label.empty()) {
    return "the label is empty, expected the name of a class";
  }
  // The comparisons are written so that NaN does not fulfil them.
  if (!(mask.score >= 0.0 && mask.score <= 1.0)) {
    return fmt::format("the score is {}, expected a number from 0 to 1", mask.score);
  }
  const auto is_near = [](double value, int size) { return value >= -size && value <= 2.0 * size; };
  for (const std::vector<Eigen::Vector2d>& outline : mask.outlines) {
    if (outline.size() < 3) {
      return fmt::format("an outline has {} point(s), expected at least 3", outline.size());
    }
    for (const Eigen::Vector2d& point : outline) {
      if (!is_near(point.x(), width) || !is_near(point.y(), height)) {
        return fmt::format("an outline has the point ({}, {}), expected pixels of the {}x{} image",
                           point.x(), point.y(), width, height);
      }
    }
  }
  if (!mask.embedding.empty() && !HasDirection(mask.embedding)) {
    return fmt::format(
        "the embedding of {} numbers is zero or not finite, expected a vector with a direction",
        mask.embedding.size());
  }
  return {};
}

}  // namespace

void ValidateMasks(std::span<const InstanceMask> masks, int width, int height) {
  for (size_t i = 0; i < masks.size(); ++i) {
    if (const std::string fault = FindFault(masks[i], width, height); !fault.empty()) {
      throw InputError(fmt::format("mask {} ('{}'): {}", i, masks[i].label, fault));
    }
  }
}

}  // namespace hullslam
