// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace hullslam {

// The colour of the centres of keyframes in map.ply.
inline constexpr std::array<uint8_t, 3> kKeyframeColour = {255, 128, 0};

// The vertices of a PLY file of FormatMapPly() (results/ply_file.h).
struct PlyPoints {
  std::vector<Eigen::Vector3f> positions;       // m
  std::vector<std::array<uint8_t, 3>> colours;  // red, green, blue; one per position
  size_t left_out = 0;  // vertices that are not finite or more than 1e6 m from the origin
};

// Reads the vertices of a binary little-endian PLY file with the properties `float x y z, uchar red
// green blue`. Throws InputError with the name of the file if it has another format or is cut off.
PlyPoints ReadPlyPoints(const std::filesystem::path& path);

// The landmarks of map.ply: all vertices but the centres of the keyframes, which come last and have
// a colour of their own. Throws as above.
PlyPoints ReadMapLandmarks(const std::filesystem::path& path);

}  // namespace hullslam
