// SPDX-License-Identifier: GPL-3.0-or-later
// Example 3: maps a sequence of a stereo camera of any data set, and prints the poses.
//
//   03_stereo SEQUENCE
#include <cstdio>

#include "hullslam/datasets/dataset.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace {

void Run(const char* path) {
  const hullslam::FoundDataset found = hullslam::FindDataset(path, hullslam::SensorKind::kStereo);
  const auto [settings, sequence, notes] =
      hullslam::OpenDataset(*found.dataset, {.path = path, .sensor = found.sensor});

  hullslam::System slam(settings.options, hullslam::PipelineKind::kThreaded);
  for (const hullslam::FramePaths& paths : sequence.frames) {
    const hullslam::ImageInput frame = sequence.load(paths, settings.options.camera);
    slam.Track(frame.timestamp, frame.grey, frame.right);  // both images are rectified
  }
  slam.Finish();

  for (const hullslam::StampedPose& pose : slam.trajectory()) {
    const Eigen::Vector3d& position = pose.world_from_cam.translation;
    std::printf("%.3f s: %.3f %.3f %.3f m\n", pose.timestamp, position.x(), position.y(),
                position.z());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: 03_stereo SEQUENCE\n");
    return 2;
  }
  Run(argv[1]);
} catch (const hullslam::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
