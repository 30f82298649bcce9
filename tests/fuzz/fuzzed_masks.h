// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>

#include "frame/detection/detection_builder.h"
#include "fuzz/fuzzed_input.h"
#include "hullslam/masks/open_masks.h"

namespace hullslam {

// The size of the images, px, and the only frame.
inline constexpr int kFuzzedWidth = 64;
inline constexpr int kFuzzedHeight = 48;
inline const std::array<MaskFrame, 1> kFuzzedFrames = {{{"1.5", 0}}};

// Reads the masks of a frame as a run does, and makes detections of them.
inline void TryMasks(const fs::path& path, const std::string& format) {
  Try([&] {
    const auto source =
        OpenMasks({.path = path, .format = format, .width = kFuzzedWidth, .height = kFuzzedHeight},
                  kFuzzedFrames);
    CheckMasks(*source, kFuzzedFrames);
    const FrameMasks frame = source->Read(kFuzzedFrames[0]);
    const PinholeCamera camera{.fx = 50.0,
                               .fy = 50.0,
                               .cx = 32.0,
                               .cy = 24.0,
                               .width = kFuzzedWidth,
                               .height = kFuzzedHeight};
    DetectionOptions options;
    options.min_keypoints = 0;
    const DetectionResult result =
        DetectionBuilder(camera, 5000.0, options).Build(frame.masks, cv::Mat(), {});
    Expect(result.rejections.size() == frame.masks.size(), "masks without a result");
  });
}

inline void TryMaskFile(std::string_view bytes, const std::string& format) {
  static const InputFolder folder("masks.json");
  folder.Write(bytes);
  TryMasks(folder.path() / "masks.json", format);
}

inline void TryMaskFolder(std::string_view bytes, const std::string& name,
                          const std::string& format) {
  static const InputFolder folder(name);  // a process runs one reader, so there is one name
  folder.Write(bytes);
  TryMasks(folder.path(), format);
}

}  // namespace hullslam
