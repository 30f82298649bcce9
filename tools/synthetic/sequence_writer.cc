// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_writer.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "hullslam/util/check.h"
#include "synthetic/scenes.h"
#include "synthetic/sequence_renderer.h"
#include "synthetic/staged_output.h"

namespace hullslam::synthetic {
namespace {

namespace fs = std::filesystem;

bool IsFormerSequence(const fs::path& folder) {
  const SequenceLayout layout;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!layout.IsEntry(entry.path().filename().string(), "")) {
      return false;
    }
  }
  std::ifstream file(folder / "groundtruth_objects.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  return json.is_object() && json.contains("generator") && json["generator"] == "make_synthetic";
}

// The baseline of the camera's settings is that of the stereo pair, if it is one.
PinholeCamera CameraWith(double stereo_baseline) {
  PinholeCamera camera = SyntheticCamera();
  camera.bf = stereo_baseline > 0.0 ? stereo_baseline * camera.fx : camera.bf;
  return camera;
}

SequencePlan MakePlan(const SequenceOptions& options) {
  return {.name = std::string(SceneName(options.scene)),
          .seed = options.seed,
          .rearranged = options.rearranged,
          .scene = BuildScene(options.scene, options.frames, options.seed, options.rearranged),
          .frames = options.frames,
          .camera = CameraWith(options.stereo_baseline),
          .stereo_baseline = options.stereo_baseline,
          .readout_time = options.readout_time,
          .sensor = {.noise = options.noise},
          .sensor_seed = VisitSeed(options.seed, options.rearranged),
          .layout = {}};
}

}  // namespace

PinholeCamera SyntheticCamera() { return {.fx = 535.4, .fy = 539.2, .cx = 320.1, .cy = 247.6}; }

bool WriteSequence(const fs::path& folder, const SequenceOptions& options,
                   const std::function<bool(int)>& progress) {
  Check(options.frames > 0 && options.threads >= 0, "a sequence needs at least one frame");
  const FormerOutput former{"a sequence", IsFormerSequence, options.force};
  return WriteStaged(folder, former, [&](const fs::path& content) {
    return RenderSequence(content, MakePlan(options), options.threads, progress);
  });
}

}  // namespace hullslam::synthetic
