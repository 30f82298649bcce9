// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/ply_points.h"

#include <charconv>
#include <string>
#include <string_view>

#include "files/bytes.h"
#include "files/read_file.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr size_t kMostBytes = 2'000'000'000;
constexpr std::string_view kStart = "ply\nformat binary_little_endian 1.0\nelement vertex ";
constexpr std::string_view kProperties =
    "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\n";
constexpr std::string_view kEnd = "end_header\n";
constexpr size_t kBytesPerVertex = 15;

[[noreturn]] void Fail(const std::filesystem::path& path, const char* reason) {
  throw InputError(path.string() + ": " + reason);
}

}  // namespace

PlyPoints ReadPlyPoints(const std::filesystem::path& path) {
  const std::string content = ReadFile(path, kMostBytes);
  std::string_view rest = content;
  size_t count = 0;
  bool is_good = rest.starts_with(kStart);
  if (is_good) {
    rest.remove_prefix(kStart.size());
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), count);
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    is_good = error == std::errc() && rest.starts_with(kProperties);
  }
  const size_t end = rest.find(kEnd);
  if (!is_good || end == std::string_view::npos) {
    Fail(path,
         "expected a binary little-endian PLY file whose vertices have float x y z and uchar red "
         "green blue");
  }
  rest.remove_prefix(end + kEnd.size());
  if (count > rest.size() / kBytesPerVertex) {
    Fail(path, "is cut off, it has fewer vertices than its header says");
  }
  ByteReader reader(rest, path.string());
  PlyPoints points;
  constexpr float kMost = 1e6f;
  for (size_t i = 0; i < count; ++i) {
    Eigen::Vector3f position;
    for (float& coordinate : position) {
      coordinate = reader.Get<float>();
    }
    std::array<uint8_t, 3> colour{};
    for (uint8_t& channel : colour) {
      channel = reader.Get<uint8_t>();
    }
    if (position.allFinite() && position.cwiseAbs().maxCoeff() <= kMost) {
      points.positions.push_back(position);
      points.colours.push_back(colour);
    } else {
      ++points.left_out;
    }
  }
  return points;
}

PlyPoints ReadMapLandmarks(const std::filesystem::path& path) {
  PlyPoints points = ReadPlyPoints(path);
  while (!points.colours.empty() && points.colours.back() == kKeyframeColour) {
    points.colours.pop_back();
    points.positions.pop_back();
  }
  return points;
}

}  // namespace hullslam
