// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/masks/mask_source.h"

namespace hullslam {

constexpr size_t kMostInstances = 1'000;            // limit for one frame
constexpr size_t kMostOutlinePoints = 100'000;      // limit for one polygon
constexpr size_t kMostFrameFileBytes = 16'000'000;  // limit for the text file of one frame
constexpr size_t kMostJsonFileBytes = 512'000'000;  // limit for a JSON file of all frames
constexpr double kMostBeyondImage = 1.0;  // px; how far an outline may extend beyond the border

// The file name without folders and without an extension of letters: "rgb/12.5.png" and "12.5" both
// give 12.5.
std::string ImageStem(std::string_view name);

// Whether a point, in pixels with integer centres, is in the image or at most kMostBeyondImage
// outside.
bool IsNearImage(const Eigen::Vector2d& point, const MaskRequest& request);

// The part of a rectangle inside the image, as an outline. The arguments are coordinates in which
// the **edges** of pixels are integers, so that the image extends from 0 to its width; in the
// outline the centres of pixels are integers. Without a part inside, the area of the outline is 0.
std::vector<Eigen::Vector2d> BoxOutline(double left, double top, double right, double bottom,
                                        const MaskRequest& request);

// Adds an instance with its outlines sorted by area. Outlines smaller than kSmallestOutlineArea are
// removed; an instance without any outline left is only counted.
void AddInstance(InstanceMask instance, FrameMasks& frame);
// Whether there are more instances than kMostInstances, including those that were left out.
bool HasTooMany(const FrameMasks& frame);

}  // namespace hullslam
