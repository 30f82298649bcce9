// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/map_file.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>

#include "hullslam/io/atomic_file.h"

namespace hullslam {
namespace {

using Colour = std::array<uint8_t, 3>;

void AppendFloat(std::string& bytes, float value) {
  const auto bits = std::bit_cast<uint32_t>(value);
  for (int shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>(bits >> shift & 0xff);
  }
}

void AppendPoints(std::string& bytes, std::span<const Eigen::Vector3d> points,
                  const Colour& colour) {
  for (const Eigen::Vector3d& point : points) {
    for (const double coordinate : point) {
      AppendFloat(bytes, static_cast<float>(coordinate));
    }
    bytes.append(colour.begin(), colour.end());
  }
}

}  // namespace

std::string FormatPly(std::span<const Eigen::Vector3d> landmarks,
                      std::span<const Eigen::Vector3d> keyframes) {
  constexpr Colour kGrey = {128, 128, 128};
  constexpr Colour kOrange = {255, 128, 0};
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
      landmarks.size() + keyframes.size());
  AppendPoints(bytes, landmarks, kGrey);
  AppendPoints(bytes, keyframes, kOrange);
  return bytes;
}

void WritePly(const std::filesystem::path& path, std::span<const Eigen::Vector3d> landmarks,
              std::span<const Eigen::Vector3d> keyframes) {
  WriteFileAtomically(path, FormatPly(landmarks, keyframes));
}

}  // namespace hullslam
