// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "hullslam/camera/pinhole.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {

struct SequenceOptions {
  SceneKind scene = SceneKind::kDesk;
  int frames = 300;
  uint64_t seed = 0;
  std::optional<uint64_t> rearranged = std::nullopt;  // seed of a rearrangement (BuildScene)
  bool force = false;         // allows replacing a folder that an earlier run wrote
  bool noise = true;          // whether the sensor has noise
  double readout_time = 0.0;  // s, from the top to the bottom row of an image (rolling shutter)
  // m; above 0, a stereo camera has a second camera with the same directions as far to the right
  double stereo_baseline = 0.0;
  // Degrees; above 0, a Kannala-Brandt lens has this field of view across the width of the image.
  double fisheye = 0.0;
  std::optional<PinholeCamera> camera = std::nullopt;  // in place of the scene's, with any lens
  int threads = 0;                                     // 0: as many as the CPU supports
};

// A camera with 640x480 px, the intrinsics of TUM freiburg3, and no distortion.
PinholeCamera SyntheticCamera();

// The same image through a Kannala-Brandt lens with this field of view across its width, degrees.
PinholeCamera SyntheticFisheye(double field_of_view);

// Renders a scene and writes a folder in TUM's format with ground truth (docs/synthetic.md). The
// result does not depend on `threads`: the same options give the same bytes. Everything is written
// to a temporary folder next to `folder`, which is moved to its final path at the end. So a failed
// run leaves nothing, and an earlier sequence is unchanged.
//
// `progress` is called after each frame with the number of finished frames, by one thread at a
// time; it returns false to stop. Returns whether the sequence was completed. Throws InputError if
// `folder` exists and may not be replaced, if it cannot be written, or if the scene cannot be
// rearranged.
bool WriteSequence(const std::filesystem::path& folder, const SequenceOptions& options,
                   const std::function<bool(int)>& progress);

}  // namespace hullslam::synthetic
