// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings_orb_slam3.h"

#include <algorithm>
#include <array>

namespace hullslam {
namespace {

using Kind = Orb3Setting::Kind;

struct Entry {
  std::string_view name;
  Kind kind;
  std::string_view key = {};
  std::string_view why = {};
};

constexpr std::array<Entry, 22> kEntries = {{
    {"File.version", Kind::kVersion},
    {"Camera.type", Kind::kModel},
    {"Camera1.fx", Kind::kRenamed, "Camera.fx"},
    {"Camera1.fy", Kind::kRenamed, "Camera.fy"},
    {"Camera1.cx", Kind::kRenamed, "Camera.cx"},
    {"Camera1.cy", Kind::kRenamed, "Camera.cy"},
    {"Camera1.k1", Kind::kRenamed, "Camera.k1"},
    {"Camera1.k2", Kind::kRenamed, "Camera.k2"},
    {"Camera1.k3", Kind::kRenamed, "Camera.k3"},
    {"Camera1.p1", Kind::kRenamed, "Camera.p1"},
    {"Camera1.p2", Kind::kRenamed, "Camera.p2"},
    {"Camera.newWidth", Kind::kSize, "Camera.width"},
    {"Camera.newHeight", Kind::kSize, "Camera.height"},
    {"RGBD.DepthMapFactor", Kind::kRenamed, "DepthMapFactor"},
    {"Stereo.ThDepth", Kind::kRenamed, "ThDepth"},
    {"Stereo.b", Kind::kBaseline},
    {"Stereo.T_c1_c2", Kind::kRefused, {}, "HullSLAM uses a single camera with depth images"},
    {"System.thFarPoints", Kind::kRefused, {}, "HullSLAM has no limit for far points"},
    {"System.LoadAtlasFromFile", Kind::kRefused, {}, "HullSLAM cannot load maps of ORB-SLAM3"},
    {"System.SaveAtlasToFile", Kind::kRefused, {}, "HullSLAM cannot save maps of ORB-SLAM3"},
    {"Viewer.imageViewScale", Kind::kIgnored},
    {"loopClosing", Kind::kIgnored},
}};

}  // namespace

std::optional<Orb3Setting> FindOrb3Setting(std::string_view key) {
  const auto* const entry =
      std::find_if(kEntries.begin(), kEntries.end(), [&](const Entry& e) { return e.name == key; });
  if (entry != kEntries.end()) {
    return Orb3Setting{entry->kind, std::string(entry->key), std::string(entry->why)};
  }
  if (key.starts_with("Camera2.")) {
    return Orb3Setting{Kind::kRefused, "", "HullSLAM uses a single camera with depth images"};
  }
  if (key.starts_with("IMU.")) {
    return Orb3Setting{Kind::kIgnored, "", ""};
  }
  return std::nullopt;
}

}  // namespace hullslam
