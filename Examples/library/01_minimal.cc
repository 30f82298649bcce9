// SPDX-License-Identifier: GPL-3.0-or-later
// Example 1: gives a System images from memory and prints the poses. The camera looks at a plane
// with a random texture, 1 m away, and moves to the right by 1 cm per frame.
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hullslam/system/system.h"

int main() {
  hullslam::SystemOptions options;
  options.camera.fx = options.camera.fy = 500.0;
  options.camera.cx = 319.5;
  options.camera.cy = 239.5;
  hullslam::System slam(options, hullslam::PipelineKind::kSequential);

  cv::Mat texture(60, 100, CV_8UC1);
  cv::setRNGSeed(1);
  cv::randu(texture, 0, 256);
  cv::resize(texture, texture, cv::Size(800, 480), 0.0, 0.0, cv::INTER_CUBIC);
  const cv::Mat depth(480, 640, CV_32FC1, cv::Scalar(1.0));
  for (int i = 0; i < 20; ++i) {
    const cv::Mat image = texture(cv::Rect(5 * i, 0, 640, 480));  // 5 px correspond to 1 cm
    slam.Track(i / 30.0, image, depth);
  }
  slam.Finish();
  for (const hullslam::StampedPose& pose : slam.trajectory()) {
    const Eigen::Vector3d& position = pose.world_from_cam.translation;
    std::printf("%.3f s: %.4f %.4f %.4f m\n", pose.timestamp, position.x(), position.y(),
                position.z());
  }
}
