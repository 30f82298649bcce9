// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/input_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/messages.h"
#include "hullslam/frame/dynamic_mask.h"

namespace hullslam {
namespace {

// The median of the known values of a 16-bit depth image, in its units.
std::optional<double> MedianUnits(const cv::Mat& depth) {
  std::vector<uint16_t> known;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* const row = depth.ptr<uint16_t>(y);
    std::copy_if(row, row + depth.cols, std::back_inserter(known),
                 [](uint16_t units) { return units != 0; });
  }
  if (known.empty()) {
    return std::nullopt;
  }
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return *middle;
}

}  // namespace

void WarnOfImplausibleDepth(const std::filesystem::path& file, const cv::Mat& depth,
                            const DepthOptions& options) {
  constexpr double kNearest = 0.2;    // m
  constexpr double kFarthest = 20.0;  // m
  if (depth.type() != CV_16UC1) {
    return;
  }
  const std::optional<double> units = MedianUnits(depth);
  const double metres = units.value_or(0.0) / options.units_per_metre;
  if (units && (metres < kNearest || metres > kFarthest)) {
    PrintError(
        "warning: {}: the median depth is {:.3g} m with DepthMapFactor {:g}, expected {} to {} m; "
        "is "
        "DepthMapFactor right?\n",
        file.string(), metres, options.units_per_metre, kNearest, kFarthest);
  }
}

void WarnOfUnknownClasses(const TrackingOptions& options, const SequenceMasks& masks) {
  std::set<std::string> unknown = SplitNames(options.dynamic_classes);
  for (const std::string& name : SplitNames(TrackingOptions().dynamic_classes)) {
    unknown.erase(name);
  }
  if (unknown.empty()) {
    return;
  }
  const std::set<std::string> labels = masks.Labels();
  for (const std::string& label : labels) {
    unknown.erase(label);
  }
  if (!unknown.empty()) {
    PrintError("warning: tracking.dynamic_classes has '{}', but no mask has this class; {}\n",
               fmt::join(unknown, "', '"),
               labels.empty() ? std::string("there are no masks")
                              : fmt::format("classes of the masks: {}", fmt::join(labels, ", ")));
  }
}

void WarnOfLastFrame(const FrameSelection& selection, const ImageSequence& sequence) {
  if (selection.last != std::numeric_limits<size_t>::max() &&
      selection.last >= sequence.available) {
    PrintError("warning: --last is '{}', but the last frame of the sequence is {}\n",
               selection.last, sequence.available - 1);
  }
}

}  // namespace hullslam
