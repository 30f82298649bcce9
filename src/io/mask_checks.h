// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/io/mask_source.h"

namespace hullslam {

constexpr size_t kMostInstances = 10'000;           // of a frame
constexpr size_t kMostFrameFileBytes = 16'000'000;  // of the text of one frame
constexpr size_t kMostJsonFileBytes = 512'000'000;  // of a JSON file of all frames
constexpr double kMostBeyondImage = 1.0;            // px, that an outline may reach over the border
constexpr double kSmallestArea = 1.0;               // px^2

// Throws InputError where the file has more bytes. (What cannot be asked is told by who reads it.)
void CheckFileSize(const std::filesystem::path& path, size_t most_bytes);

// File name without folders and without an extension of letters: "rgb/12.5.png" and "12.5" are
// both 12.5.
std::string ImageStem(std::string_view name);

// Whether a point, in pixels with integer centres, is in the image or next to it.
bool IsNearImage(const Eigen::Vector2d& point, const MaskRequest& request);

// A rectangle's part in the image as an outline; the arguments are coordinates of pixels'
// **edges**, so that the image runs from 0 to its width, the outline's of their centres. No area
// outside.
std::vector<Eigen::Vector2d> BoxOutline(double left, double top, double right, double bottom,
                                        const MaskRequest& request);

// Adds an instance with its outlines sorted by area; those without area are left out, and counted
// where none remains.
void AddInstance(InstanceMask instance, FrameMasks& frame);
// More instances than kMostInstances, those that were left out included.
bool HasTooMany(const FrameMasks& frame);

}  // namespace hullslam
