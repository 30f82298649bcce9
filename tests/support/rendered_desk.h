// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {

// The first frames of the scene `desk` of make_synthetic. Rendering takes 0.1 s per frame.
// `readout_time` (s) is that of the camera's shutter.
class RenderedDesk {
 public:
  explicit RenderedDesk(int frames, double readout_time = 0.0) : path_(folder_.path() / "desk") {
    const ProgramResult result =
        RunProgram("make_synthetic", {path_, "--frames", std::to_string(frames), "--readout-time",
                                      std::to_string(readout_time), "--quiet"});
    if (result.exit_code != 0) {
      throw std::runtime_error(result.errors);
    }
  }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path settings() const { return path_ / "camera.yaml"; }
  PinholeCamera camera() const { return ReadSettings(settings()).camera; }
  // The colour images; the ground truth is that of the camera.
  ImageSequence images() const { return OpenTumSequence(path_, {.use_depth = false}); }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace hullslam
