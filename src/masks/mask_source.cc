// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/masks/mask_source.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "hullslam/util/error.h"
#include "masks/mask_checks.h"

namespace hullslam {

std::vector<MaskFrame> MaskFrames(const ImageSequence& sequence) {
  std::vector<MaskFrame> frames;
  // The frames of a video are named VIDEO/000012.
  std::error_code error;
  const bool is_video =
      !sequence.frames.empty() &&
      std::filesystem::is_regular_file(sequence.frames.front().image.parent_path(), error);
  for (const FramePaths& frame : sequence.frames) {
    frames.push_back({ImageStem(frame.image.string()), frame.number});
    if (is_video) {
      frames.back().video_name =
          fmt::format("{}_{}", frame.image.parent_path().stem().string(), frame.number + 1);
    }
  }
  return frames;
}

std::vector<MaskFrame> RightMaskFrames(const ImageSequence& sequence) {
  std::vector<MaskFrame> frames = MaskFrames(sequence);
  for (size_t i = 0; i < frames.size(); ++i) {
    if (const std::filesystem::path& image = sequence.frames[i].right; !image.empty()) {
      frames[i].stem = ImageStem(image.string());
    }
  }
  return frames;
}

namespace {

void Validate(const FrameMasks& masks, const MaskFrame& frame, const MaskRequest& size) {
  try {
    ValidateMasks(masks.masks, size.width, size.height);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: frame {}: {}", size.path.string(), frame.stem, error.what()));
  }
}

}  // namespace

MaskCounts CheckMasks(const MaskSource& source, std::span<const MaskFrame> frames,
                      const MaskRequest& size) {
  MaskCounts counts;
  for (const MaskFrame& frame : frames) {
    const FrameMasks masks = source.Read(frame);
    counts.missing += masks.is_missing ? 1 : 0;
    counts.without_masks += masks.masks.empty() ? 1 : 0;
    counts.without_area += masks.without_area;
    if (size.width > 0) {
      Validate(masks, frame, size);
    }
  }
  return counts;
}

}  // namespace hullslam
