// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include "files/staged_file.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace hullslam {

// The first frames of the scene `desk` of make_synthetic. `readout_time` (s) is that of the
// camera's shutter. Rendering takes 0.1 s per frame, so all tests of a build share the rendered
// folder. Each has a copy, which it may change.
class RenderedDesk {
 public:
  explicit RenderedDesk(int frames, double readout_time = 0.0) : path_(folder_.path() / "desk") {
    const std::string name = fmt::format("desk_{}_{}", frames, readout_time);
    const std::filesystem::path shared = ProgramFolder() / ".." / "rendered" / name;
    const std::filesystem::path turn = shared.string() + ".turn";
    std::filesystem::create_directories(turn);
    const FolderLock lock(turn);  // tests that need the same desk wait for it
    if (!IsUpToDate(shared)) {
      const std::filesystem::path rendered = folder_.path() / "rendered";
      const ProgramResult result =
          RunProgram("make_synthetic", {rendered, "--frames", std::to_string(frames),
                                        "--readout-time", std::to_string(readout_time), "--quiet"});
      if (result.exit_code != 0) {
        throw std::runtime_error(result.errors);
      }
      Share(rendered, shared);
    }
    std::filesystem::copy(shared, path_, std::filesystem::copy_options::recursive);
  }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path settings() const { return path_ / "camera.yaml"; }
  PinholeCamera camera() const { return ReadSettings(settings()).camera; }
  // The colour images; the ground truth is that of the camera.
  ImageSequence images() const { return OpenTumSequence(path_, {.use_depth = false}); }

 private:
  // Whether the folder was rendered by this build of the renderer.
  static bool IsUpToDate(const std::filesystem::path& shared) {
    std::error_code error;
    const auto rendered = std::filesystem::last_write_time(shared, error);
    return !error && rendered > std::filesystem::last_write_time(ProgramPath("make_synthetic"));
  }

  // Copies the folder beside its place, and gives it its name when it is complete: a test that is
  // ended leaves no part of a folder there.
  static void Share(const std::filesystem::path& rendered, const std::filesystem::path& shared) {
    namespace fs = std::filesystem;
    const fs::path copy = shared.string() + ".part";
    fs::remove_all(copy);
    fs::copy(rendered, copy, fs::copy_options::recursive);
    fs::remove_all(shared);
    fs::rename(copy, shared);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace hullslam
