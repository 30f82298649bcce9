// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/input_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "frame/dynamic_mask.h"
#include "run/messages.h"
#include "util/median.h"

namespace hullslam {
namespace {

// The median of the known values of a depth image, in its units.
template <typename Value>
std::optional<double> MedianOf(const cv::Mat& depth) {
  std::vector<Value> known;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* const row = depth.ptr<Value>(y);
    std::copy_if(row, row + depth.cols, std::back_inserter(known),
                 [](Value value) { return value > Value(0); });
  }
  return known.empty() ? std::nullopt : std::optional<double>(Median(std::move(known)));
}

// Warns about the classes of a setting that no mask has.
void WarnOfClassesWithoutMasks(const char* key, std::set<std::string> classes,
                               const std::set<std::string>& labels) {
  for (const std::string& label : labels) {
    classes.erase(label);
  }
  if (!classes.empty()) {
    PrintError("warning: {} has '{}', but no mask has this class; {}\n", key,
               fmt::join(classes, "', '"),
               labels.empty() ? std::string("there are no masks")
                              : fmt::format("classes of the masks: {}", fmt::join(labels, ", ")));
  }
}

void PrintWarnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    PrintError("warning: {}\n", warning);
  }
}

}  // namespace

SystemOptions LoadSettings(const std::filesystem::path& file,
                           std::span<const std::string> overrides, NegativeFy negative_fy) {
  std::vector<std::string> warnings;
  SystemOptions options = ReadSettings(file, overrides, negative_fy, &warnings);
  PrintWarnings(warnings);
  return options;
}

SystemOptions LoadSettings(const CameraCalibration& calibration, const std::string& source,
                           std::span<const std::string> overrides) {
  std::vector<std::string> warnings;
  SystemOptions options = MakeSettings(calibration, source, overrides, &warnings);
  PrintWarnings(warnings);
  return options;
}

void WarnOfImplausibleDepth(const std::filesystem::path& file, const cv::Mat& depth,
                            const DepthOptions& options) {
  constexpr double kNearest = 0.2;    // m
  constexpr double kFarthest = 20.0;  // m
  const bool is_in_units = depth.type() == CV_16UC1;
  if (!is_in_units && depth.type() != CV_32FC1) {
    return;
  }
  const std::optional<double> median =
      is_in_units ? MedianOf<uint16_t>(depth) : MedianOf<float>(depth);
  const double metres = median.value_or(0.0) / (is_in_units ? options.units_per_metre : 1.0);
  if (!median || (metres >= kNearest && metres <= kFarthest)) {
    return;
  }
  const std::string reason = is_in_units
                                 ? fmt::format("with DepthMapFactor {:g}", options.units_per_metre)
                                 : std::string("in the units of the file");
  PrintError("warning: {}: the median depth is {:.3g} m {}, expected {} to {} m; is {} right?\n",
             file.string(), metres, reason, kNearest, kFarthest,
             is_in_units ? "DepthMapFactor" : "its unit (--povray-units)");
}

void WarnOfUnknownClasses(const TrackingOptions& tracking, const ObjectOptions& objects,
                          const SequenceMasks& masks) {
  std::set<std::string> dynamic = SplitNames(tracking.dynamic_classes);
  for (const std::string& name : SplitNames(TrackingOptions().dynamic_classes)) {
    dynamic.erase(name);
  }
  std::set<std::string> sized;
  for (const auto& [name, size] : objects.sizes) {
    sized.insert(name);
  }
  if (dynamic.empty() && sized.empty()) {
    return;
  }
  const std::set<std::string> labels = masks.Labels();
  WarnOfClassesWithoutMasks("tracking.dynamic_classes", dynamic, labels);
  WarnOfClassesWithoutMasks("objects.sizes", sized, labels);
}

void WarnOfLastFrame(const FrameSelection& selection, const ImageSequence& sequence) {
  if (selection.last != std::numeric_limits<size_t>::max() &&
      selection.last >= sequence.available) {
    PrintError("warning: --last is '{}', but the last frame of the sequence is {}\n",
               selection.last, sequence.available - 1);
  }
}

}  // namespace hullslam
