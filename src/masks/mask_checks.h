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

// Whether a point is in the image or at most kMostBeyondImage outside. In its coordinates (px) the
// centres of pixels are integers.
bool IsNearImage(const Eigen::Vector2d& point, const MaskRequest& request);

// The part of a rectangle that is inside the image, as an outline. In the coordinates of the
// arguments the **edges** of pixels are integers, so the image extends from 0 to its width. In the
// coordinates of the outline the centres of pixels are integers. If no part is inside, the area of
// the outline is 0.
std::vector<Eigen::Vector2d> BoxOutline(double left, double top, double right, double bottom,
                                        const MaskRequest& request);

// Adds an instance with its label in printable characters and its outlines sorted by area. Outlines
// smaller than kSmallestOutlineArea are removed; an instance without any outline left is only
// counted.
void AddInstance(InstanceMask instance, FrameMasks& frame);
// Whether the frame has more than kMostInstances instances, including those that are only counted.
bool HasTooMany(const FrameMasks& frame);

}  // namespace hullslam
