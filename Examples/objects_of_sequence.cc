// SPDX-License-Identifier: GPL-3.0-or-later
// Uses HullSLAM as a library: tracks a sequence in TUM's format with its masks, prints at what
// times objects are seen, and prints the mapped objects.
//
//   objects_of_sequence SEQUENCE SETTINGS MASKS
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <vector>

#include "hullslam/masks/open_masks.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/system.h"

namespace {

size_t CountSeen(const hullslam::FrameReport& report) {
  size_t count = 0;
  for (const hullslam::ObjectId id : report.objects) {
    count += id.IsValid() ? 1 : 0;  // a detection that shows no mapped object has an invalid id
  }
  return count;
}

void PrintObjects(const hullslam::Map& map) {
  for (const auto& [id, object] : map.objects()) {
    if (object.state != hullslam::ObjectState::kMapped) {
      continue;
    }
    const Eigen::Vector3d& center = object.ellipsoid.world_from_object.translation;
    const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
    std::printf("object %u: %s at %.3f %.3f %.3f m, half axes %.3f %.3f %.3f m\n", id.value,
                object.Label().c_str(), center.x(), center.y(), center.z(), axes.x(), axes.y(),
                axes.z());
    for (const hullslam::ObjectObservation& observation : object.observations) {
      const hullslam::Keyframe& keyframe = map.keyframes().At(observation.keyframe);
      const hullslam::Detection& seen = keyframe.frame->detections.at(observation.detection);
      std::printf("  seen at %.3f s with score %.2f\n", keyframe.frame->timestamp, seen.score);
    }
  }
}

void Run(const char* sequence_folder, const char* settings, const char* mask_folder) {
  const hullslam::SystemOptions options = hullslam::ReadSettings(settings);
  const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(sequence_folder);
  const std::vector<hullslam::MaskFrame> names = hullslam::MaskFrames(sequence);
  const auto masks =
      hullslam::OpenMasks({mask_folder, "", options.camera.width, options.camera.height}, names);

  hullslam::System system(options, hullslam::PipelineKind::kSequential);
  size_t most_seen = 0;
  system.SetFrameCallback([&](const hullslam::FrameReport& report) {
    if (const size_t seen = CountSeen(report); seen > most_seen) {
      most_seen = seen;
      std::printf("%.3f s: %zu mapped objects are in view\n", report.tracked.timestamp, seen);
    }
  });
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    hullslam::ImageInput image = sequence.load(sequence.frames[i], options.camera);
    image.masks = masks->Read(names[i]).masks;
    system.Track(image);
  }
  system.Finish();
  if (const std::shared_ptr<const hullslam::Map> map = system.map()) {
    PrintObjects(*map);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: objects_of_sequence SEQUENCE SETTINGS MASKS\n");
    return 2;
  }
  try {
    Run(argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
