// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/frame/instance_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hullslam/util/error.h"

namespace hullslam {
namespace {

bool HasDirection(const std::vector<float>& vector) {
  const auto is_finite = [](float element) { return std::isfinite(element); };
  const auto is_zero = [](float element) { return element == 0.0F; };
  return std::all_of(vector.begin(), vector.end(), is_finite) &&
         !std::all_of(vector.begin(), vector.end(), is_zero);
}

// Points of one outline; also a bound for the memory that a polygon takes.
constexpr size_t kMostPoints = 100'000;

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
    if (outline.size() < 3 || outline.size() > kMostPoints) {
      return fmt::format("an outline has {} point(s), expected 3 to {}", outline.size(),
                         kMostPoints);
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

// The largest sum of the squares of the crossings of an outline with the rows of the image, over
// all outlines of an image. cv::fillPoly() sorts the crossings of each row by exchanging
// neighbours, so n crossings take up to n^2 steps, and 1e9 steps take about 0.1 s (measured: 16000
// points up and down over 480 rows, 1.2e11, took 12 s). An object with 100 crossings in each of 480
// rows has 5e6.
constexpr double kMostSquaredCrossings = 1e9;

double SquaredCrossings(std::span<const Eigen::Vector2d> outline, int height) {
  const auto row = [&](double y) {
    return static_cast<size_t>(std::clamp(std::round(y), 0.0, static_cast<double>(height)));
  };
  std::vector<int> changes(static_cast<size_t>(height) + 1);
  for (size_t i = 0; i < outline.size(); ++i) {
    const size_t from = row(outline[i].y());
    const size_t to = row(outline[(i + 1) % outline.size()].y());
    ++changes[std::min(from, to)];
    --changes[std::max(from, to)];
  }
  double sum = 0.0;
  double crossings = 0.0;
  for (const int change : changes) {
    crossings += change;
    sum += crossings * crossings;
  }
  return sum;
}

// Throws InputError if all points of all masks are within one pixel: they are shares of the width
// and the height. Masks of one pixel have points around its centre, so also below 0.
void RefuseShares(std::span<const InstanceMask> masks, int width, int height) {
  bool has_points = false;
  for (const InstanceMask& mask : masks) {
    for (const std::vector<Eigen::Vector2d>& outline : mask.outlines) {
      for (const Eigen::Vector2d& point : outline) {
        has_points = true;
        if (point.minCoeff() < 0.0 || point.maxCoeff() > 1.0) {
          return;
        }
      }
    }
  }
  if (has_points) {
    throw InputError(fmt::format(
        "mask 0 ('{}'): all points of the outlines are from 0 to 1, expected pixels of the {}x{} "
        "image: shares must be multiplied by its width and height",
        masks.front().label, width, height));
  }
}

}  // namespace

void ValidateMasks(std::span<const InstanceMask> masks, int width, int height) {
  double squared_crossings = 0.0;
  for (size_t i = 0; i < masks.size(); ++i) {
    if (const std::string fault = FindFault(masks[i], width, height); !fault.empty()) {
      throw InputError(fmt::format("mask {} ('{}'): {}", i, masks[i].label, fault));
    }
    for (const std::vector<Eigen::Vector2d>& outline : masks[i].outlines) {
      squared_crossings += SquaredCrossings(outline, height);
      if (squared_crossings > kMostSquaredCrossings) {
        throw InputError(fmt::format(
            "mask {} ('{}'): an outline of {} points goes up and down through the image so often "
            "that filling it would take too long, expected the outline of an object",
            i, masks[i].label, outline.size()));
      }
    }
  }
  RefuseShares(masks, width, height);
}

}  // namespace hullslam
