// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/masks/open_masks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "masks/embedded_masks.h"
#include "masks/mask_checks.h"
#include "masks/mask_format.h"
#include "masks/mask_probe.h"

namespace hullslam {
namespace {

// The table of all formats. A new format needs a row here.
constexpr std::array kFormats = {&kYoloSegFormat,  &kCocoFormat,  &kJsonFolderFormat,
                                 &kLabelPngFormat, &kPaperFormat, &kOaSlamFormat,
                                 &kBoxesFormat};

std::vector<std::string_view> JsonKeys() {
  std::vector<std::string_view> keys;
  for (const MaskFormat* const format : kFormats) {
    keys.insert(keys.end(), format->json_keys.begin(), format->json_keys.end());
  }
  return keys;
}

// For messages: "'annotations', 'image_id' (coco) and 'detections' (oa-slam)".
std::string DescribeJsonKeys() {
  std::vector<std::string> described;
  for (const MaskFormat* const format : kFormats) {
    if (!format->json_keys.empty()) {
      described.push_back(
          fmt::format("'{}' ({})", fmt::join(format->json_keys, "', '"), format->name));
    }
  }
  return fmt::format("{}", fmt::join(described, " and "));
}

bool Fits(const MaskFormat& format, const MaskProbe& probe) {
  if (probe.is_folder) {
    return format.is_meant != nullptr && format.is_meant(probe);
  }
  return std::find(format.json_keys.begin(), format.json_keys.end(), probe.json_key) !=
         format.json_keys.end();
}

const MaskFormat& FindFormat(const std::string& name) {
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(),
                                         [&](const auto* format) { return format->name == name; });
  if (found == kFormats.end()) {
    throw InputError(fmt::format("--masks-format is '{}', expected one of: {}", name,
                                 fmt::join(MaskFormatNames(), ", ")));
  }
  return **found;
}

const MaskFormat& DetectFormat(const std::filesystem::path& path,
                               std::span<const MaskFrame> frames) {
  const MaskProbe probe = ProbeMasks(path, JsonKeys(), frames);
  std::vector<const MaskFormat*> fitting;
  std::vector<std::string_view> names;
  for (const MaskFormat* const format : kFormats) {
    if (Fits(*format, probe)) {
      fitting.push_back(format);
      names.push_back(format->name);
    }
  }
  if (fitting.empty()) {
    throw InputError(
        fmt::format("{}: {}", path.string(), DescribeMisfit(probe, DescribeJsonKeys())));
  }
  if (fitting.size() > 1) {
    throw InputError(
        fmt::format("{}: the format of the masks is not clear, {} fit; give --masks-format",
                    path.string(), fmt::join(names, " and ")));
  }
  return *fitting.front();
}

void CheckSomeFrameHasMasks(const std::filesystem::path& path, const MaskSource& source,
                            std::span<const MaskFrame> frames) {
  const bool found = std::any_of(frames.begin(), frames.end(),
                                 [&](const MaskFrame& frame) { return source.Contains(frame); });
  if (!found) {
    const std::string example = source.Example();
    throw InputError(fmt::format(
        "{}: no masks ({}) for any of the {} frames: there is {}, and a frame is '{}'{}",
        path.string(), source.format(), frames.size(),
        example.empty() ? std::string("nothing") : '\'' + example + '\'', frames.front().stem,
        frames.front().video_name.empty()
            ? std::string()
            : fmt::format(" or, in text files, '{}'", frames.front().video_name)));
  }
}

}  // namespace

std::vector<std::string> MaskFormatNames() {
  std::vector<std::string> names;
  for (const MaskFormat* const format : kFormats) {
    names.emplace_back(format->name);
  }
  return names;
}

std::unique_ptr<const MaskSource> OpenMasks(const MaskRequest& request,
                                            std::span<const MaskFrame> frames) {
  Check(!frames.empty() && request.width > 0 && request.height > 0,
        "masks need frames and the size of their images");
  const MaskFormat& format =
      request.format.empty() ? DetectFormat(request.path, frames) : FindFormat(request.format);
  std::unique_ptr<const MaskSource> source = format.open(request);
  CheckSomeFrameHasMasks(request.path, *source, frames);
  return AddEmbeddings(std::move(source), EmbeddingFolder(request.path), frames);
}

}  // namespace hullslam
