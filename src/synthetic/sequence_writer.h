// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "hullslam/camera/pinhole.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {

struct SequenceOptions {
  SceneKind scene = SceneKind::kDesk;
  int frames = 300;
  uint64_t seed = 0;
  bool force = false;  // may replace a folder that an earlier run has written
  bool noise = true;   // of the sensor
  int threads = 0;     // 0: as many as the machine has
};

// 640x480, the intrinsics of TUM's freiburg3 without distortion.
PinholeCamera SyntheticCamera();

// Time stamp in seconds of a frame, as it is written: 1000 and 30 frames a second.
double FrameStamp(int frame);

// Renders a scene and writes a TUM folder with ground truth (docs/synthetic.md). The same options
// but for `threads` give the same bytes. All is written next to `folder` under another name and
// moved there at the end; when something fails, nothing is left and what was there is untouched.
//
// `progress` is called after each frame with the number done, by one thread at a time; it returns
// false to give up. Returns whether the sequence was finished. Throws InputError when `folder`
// exists and may not be replaced or cannot be written.
bool WriteSequence(const std::filesystem::path& folder, const SequenceOptions& options,
                   const std::function<bool(int)>& progress);

}  // namespace hullslam::synthetic
