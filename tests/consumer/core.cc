// SPDX-License-Identifier: GPL-3.0-or-later
// The program of a user, which links the installed hullslam::core and uses it. It calls functions
// of several modules, so that CMake must also find the packages that these modules link.
#include "core.h"

#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hullslam/system/options.h"
#include "hullslam/system/system.h"

namespace {

bool OptionsAreNamed() {
  hullslam::SystemOptions options;
  options.Bind().Set("ORBextractor.nFeatures", "700", "consumer");
  return options.features.feature_count == 700;
}

// Tracks a camera that stands still in front of a textured wall, 2 m away.
bool FramesAreTracked() {
  hullslam::SystemOptions options;
  options.camera.fx = options.camera.fy = 500.0;
  options.camera.cx = 320.0;
  options.camera.cy = 240.0;
  cv::Mat small(60, 80, CV_8UC1);
  cv::RNG(1).fill(small, cv::RNG::UNIFORM, 0, 256);
  cv::Mat grey;
  cv::resize(small, grey, {640, 480}, 0, 0, cv::INTER_NEAREST);
  const cv::Mat depth(480, 640, CV_32FC1, cv::Scalar(2.0));
  hullslam::System system(options, hullslam::PipelineKind::kThreaded);
  for (int i = 0; i < 5; ++i) {
    system.Track(1.0 + 0.1 * i, grey, depth);
  }
  system.Finish();
  const hullslam::Trajectory trajectory = system.trajectory();
  return trajectory.size() == 5 && trajectory.back().world_from_cam.translation.norm() < 0.005;
}

}  // namespace

bool Report(bool good, const char* what) {
  std::cout << (good ? "ok: " : "failed: ") << what << "\n";
  return good;
}

bool CoreWorks() {
  const bool good = Report(OptionsAreNamed(), "options");
  return Report(FramesAreTracked(), "tracking") && good;
}
