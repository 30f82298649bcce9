// SPDX-License-Identifier: GPL-3.0-or-later
// Example 2: maps an RGB-D sequence in TUM's format with the masks of its objects, writes the
// trajectory, measures its error and prints the objects.
//
//   02_rgbd_with_masks SEQUENCE MASKS TRAJECTORY
#include <cstdio>
#include <memory>
#include <vector>

#include "hullslam/eval/ate.h"
#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace {

void PrintObjects(const hullslam::Map& map) {
  for (const auto& [id, object] : map.objects()) {
    if (object.state == hullslam::ObjectState::kMapped) {  // the others are candidates
      const Eigen::Vector3d& center = object.ellipsoid.world_from_object.translation;
      const Eigen::Vector3d& axes = object.ellipsoid.half_axes;
      std::printf("%s at %.3f %.3f %.3f m, half axes %.3f %.3f %.3f m, seen by %zu keyframes\n",
                  object.Label().c_str(), center.x(), center.y(), center.z(), axes.x(), axes.y(),
                  axes.z(), object.observations.size());
    }
  }
}

void Run(const char* folder, const char* mask_folder, const char* output) {
  hullslam::SystemOptions settings =
      hullslam::ReadSettings(hullslam::FindDefaultSettings(folder, hullslam::FindConfigFolder()));
  settings.vocabulary = std::make_shared<const hullslam::Vocabulary>(  // for loops
      hullslam::ReadVocabulary(hullslam::FindDefaultVocabulary()));
  const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(folder);
  const std::vector<hullslam::MaskFrame> names = hullslam::MaskFrames(sequence);
  const auto masks =
      hullslam::OpenMasks({mask_folder, "", settings.camera.width, settings.camera.height}, names);

  hullslam::System slam(settings, hullslam::PipelineKind::kSequential);
  for (size_t i = 0; i < names.size(); ++i) {
    hullslam::ImageInput frame = sequence.load(sequence.frames[i], settings.camera);
    frame.masks = masks->Read(names[i]).masks;
    const hullslam::TrackedFrame result = slam.Track(frame);
    if (result.state != hullslam::TrackingState::kTracked) {
      std::printf("%s is not tracked\n", names[i].stem.c_str());
    }
  }
  slam.Finish();

  const hullslam::Trajectory trajectory = slam.trajectory();
  hullslam::WriteTrajectory(output, trajectory);
  std::printf("%zu of %zu frames have a pose\n", trajectory.size(), names.size());
  PrintObjects(*slam.map());
  if (const auto groundtruth = hullslam::ReadGroundtruth(sequence)) {
    const hullslam::AteResult errors = hullslam::EvaluateAte(*groundtruth, trajectory);
    std::printf("error %.4f m over %zu poses\n", errors.errors.rmse, errors.pairs);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) {
    std::fprintf(stderr, "usage: 02_rgbd_with_masks SEQUENCE MASKS TRAJECTORY\n");
    return 2;
  }
  Run(argv[1], argv[2], argv[3]);
} catch (const hullslam::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
