// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "synthetic/scenes.h"

namespace hullslam::synthetic {
namespace {

constexpr double kFirstTumStamp = 1000.0;  // seconds

template <size_t N>
bool Contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string_view DatasetName(DatasetForm form) { return form == DatasetForm::kTum ? "tum" : "icl"; }

double SequenceLayout::Stamp(int frame) const {
  const double first = form == DatasetForm::kTum ? kFirstTumStamp : 0.0;
  return first + std::round(frame / kFramesPerSecond * 1e6) * 1e-6;
}

std::string SequenceLayout::Stem(int frame) const {
  return form == DatasetForm::kTum ? fmt::format("{:.6f}", Stamp(frame)) : std::to_string(frame);
}

std::filesystem::path SequenceLayout::TumFolder() const {
  return form == DatasetForm::kTum ? "" : "tum";
}

std::string SequenceLayout::ImagesFromTumFolder() const {
  return form == DatasetForm::kTum ? "" : "../";
}

bool SequenceLayout::IsEntry(std::string_view entry, std::string_view name) const {
  static constexpr std::array<std::string_view, 10> kTumEntries = {
      "rgb",       "depth",       "masks",           "rgb.txt",
      "depth.txt", "camera.yaml", "groundtruth.txt", "groundtruth_objects.json",
      "right",     "masks_right"};
  static constexpr std::array<std::string_view, 6> kIclEntries = {
      "rgb", "depth", "right", "masks_right", "associations.txt", "tum"};
  return form == DatasetForm::kTum
             ? Contains(kTumEntries, entry)
             : Contains(kIclEntries, entry) || entry == std::string(name) + ".gt.freiburg";
}

}  // namespace hullslam::synthetic
