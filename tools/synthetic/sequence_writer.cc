// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sequence_writer.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "camera/wide_lens.h"
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

// The coefficients are about those of a lens of 180 degrees and more (TUM-VI). The virtual stereo
// camera keeps its baseline.
PinholeCamera FisheyeOf(const PinholeCamera& pinhole, double field_of_view) {
  PinholeCamera camera = pinhole;
  camera.lens = LensModel::kKannalaBrandt;
  camera.k1 = 0.0035;
  camera.k2 = 0.0007;
  camera.k3 = -0.002;
  camera.k4 = 0.0002;
  const double half = 0.5 * field_of_view * std::numbers::pi / 180.0;
  camera.fx = camera.fy = 0.5 * camera.width / RadiusOfAngle(camera, half);
  camera.bf = pinhole.bf / pinhole.fx * camera.fx;
  return camera;
}

// The baseline of the camera's settings is that of the stereo pair, if it is one.
PinholeCamera CameraWith(const PinholeCamera& pinhole, double stereo_baseline, double fisheye) {
  PinholeCamera camera = fisheye > 0.0 ? FisheyeOf(pinhole, fisheye) : pinhole;
  camera.bf = stereo_baseline > 0.0 ? stereo_baseline * camera.fx : camera.bf;
  return camera;
}

SequencePlan MakePlan(const SequenceOptions& options) {
  return {.name = std::string(SceneName(options.scene)),
          .seed = options.seed,
          .rearranged = options.rearranged,
          .scene = BuildScene(options.scene, options.frames, options.seed, options.rearranged),
          .frames = options.frames,
          .camera = CameraWith(options.camera.value_or(CameraOf(options.scene)),
                               options.stereo_baseline, options.fisheye),
          .stereo_baseline = options.stereo_baseline,
          .readout_time = options.readout_time,
          .sensor = {.noise = options.noise},
          .sensor_seed = VisitSeed(options.seed, options.rearranged),
          .layout = {}};
}

}  // namespace

PinholeCamera SyntheticCamera() { return CameraOf(SceneKind::kDesk); }

PinholeCamera SyntheticFisheye(double field_of_view) {
  return FisheyeOf(SyntheticCamera(), field_of_view);
}

bool WriteSequence(const fs::path& folder, const SequenceOptions& options,
                   const std::function<bool(int)>& progress) {
  Check(options.frames > 0 && options.threads >= 0, "a sequence needs at least one frame");
  const FormerOutput former{"a sequence", IsFormerSequence, options.force};
  return WriteStaged(folder, former, [&](const fs::path& content) {
    return RenderSequence(content, MakePlan(options), options.threads, progress);
  });
}

}  // namespace hullslam::synthetic
