// SPDX-License-Identifier: GPL-3.0-or-later
// Example 6: maps the first half of a sequence in TUM's format, saves the map, and finds the poses
// of the second half in it without changing it.
//
//   06_localisation SEQUENCE MAP
#include <cstdio>
#include <memory>
#include <utility>

#include "hullslam/map_files/map_file.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace {

void Run(const char* folder, const char* map_file) {
  hullslam::SystemOptions settings =
      hullslam::ReadSettings(hullslam::FindDefaultSettings(folder, hullslam::FindConfigFolder()));
  settings.vocabulary = std::make_shared<const hullslam::Vocabulary>(
      hullslam::ReadVocabulary(hullslam::FindDefaultVocabulary()));
  const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(folder);
  const size_t half = sequence.frames.size() / 2;

  hullslam::System first(settings, hullslam::PipelineKind::kSequential);
  for (size_t i = 0; i < half; ++i) {
    first.Track(sequence.load(sequence.frames[i], settings.camera));
  }
  first.Finish();
  hullslam::WriteMap(map_file, *first.map(), hullslam::MapSettingsOf(settings));

  hullslam::SystemStart start;
  start.map = hullslam::ReadMap(map_file, settings);
  start.session_name = "second visit";
  start.localization_only = true;
  hullslam::System second(settings, hullslam::PipelineKind::kSequential, std::move(start));
  for (size_t i = half; i < sequence.frames.size(); ++i) {
    const hullslam::TrackedFrame result =
        second.Track(sequence.load(sequence.frames[i], settings.camera));
    if (result.state == hullslam::TrackingState::kTracked) {
      const Eigen::Vector3d position = result.world_from_cam().translation;
      std::printf("%.3f s: %.4f %.4f %.4f m\n", result.timestamp, position.x(), position.y(),
                  position.z());
    }
  }
  second.Finish();
  std::printf("%zu of %zu frames found in a map of %zu keyframes\n", second.trajectory().size(),
              sequence.frames.size() - half, second.map()->keyframes().size());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 06_localisation SEQUENCE MAP\n");
    return 2;
  }
  Run(argv[1], argv[2]);
} catch (const hullslam::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
