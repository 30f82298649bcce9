// SPDX-License-Identifier: GPL-3.0-or-later
// Example 4: a network makes masks while frames are tracked. It is slower than the camera, so it
// gets the image of the newest keyframe when it is free, and its masks are added when they are
// ready.
//
//   04_late_masks SEQUENCE NETWORK
#include <cstdio>

#include "hullslam/segmentation/late_masks.h"
#include "hullslam/segmentation/segmenter.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "hullslam/system/system.h"
#include "hullslam/util/error.h"

namespace {

void Run(const char* folder, const char* network) {
  const hullslam::SystemOptions settings =
      hullslam::ReadSettings(hullslam::FindDefaultSettings(folder, hullslam::FindConfigFolder()));
  const hullslam::ImageSequence sequence = hullslam::OpenTumSequence(folder);
  hullslam::Segmenter segmenter(network);

  hullslam::System slam(settings, hullslam::PipelineKind::kThreaded);
  hullslam::LateMasks masks(
      hullslam::LateMasks::Pace::kNeverWait,
      [&segmenter](const cv::Mat& image) { return segmenter.Segment(image); }, slam);
  for (const hullslam::FramePaths& paths : sequence.frames) {
    const hullslam::TrackedFrame result = slam.Track(sequence.load(paths, settings.camera));
    masks.AfterFrame(result, sequence.load_colour(paths));
  }
  masks.Finish();
  slam.Finish();

  std::printf("%zu of %zu frames have a pose\n", slam.trajectory().size(), sequence.frames.size());
  std::printf("%zu detections of objects\n", slam.object_counts().detections);
  for (const auto& [id, object] : slam.map()->objects()) {
    std::printf("%s with %zu observations\n", object.Label().c_str(), object.observations.size());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 04_late_masks SEQUENCE NETWORK\n");
    return 2;
  }
  Run(argv[1], argv[2]);
} catch (const hullslam::InputError& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
