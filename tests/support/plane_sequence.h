// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/temporary_folder.h"

namespace hullslam {

// A small sequence in TUM format with images of 640 x 480 px, which takes little time to draw. A
// camera without distortion looks at a plane with a random texture, 1 m away, and moves to the
// right by 1 cm per frame. Files: rgb/00.png ... and depth/00.png ..., rgb.txt and depth.txt,
// groundtruth.txt, camera.yaml and associations.txt.
class PlaneSequence {
 public:
  // `shift` in px per frame; 500 px are 1 m. The texture repeats after `period` px, a multiple of
  // 8; 0: it does not repeat.
  explicit PlaneSequence(int frames = 12, double seconds_a_frame = 0.1, int shift = 5,
                         int period = 0)
      : seconds_a_frame_(seconds_a_frame), shift_(shift), period_(period) {
    folder_.Write("camera.yaml",
                  "%YAML:1.0\nCamera.fx: 500.0\nCamera.fy: 500.0\nCamera.cx: 319.5\n"
                  "Camera.cy: 239.5\nCamera.width: 640\nCamera.height: 480\nCamera.fps: 30.0\n"
                  "Camera.bf: 40.0\nThDepth: 40.0\nDepthMapFactor: 5000.0\n"
                  "ORBextractor.nFeatures: 600\n");
    std::filesystem::create_directory(path() / "rgb");
    std::filesystem::create_directory(path() / "depth");
    DrawImages(frames);
    WriteLists(frames);
  }

  const std::filesystem::path& path() const { return folder_.path(); }
  double Stamp(int frame) const { return 1000.0 + seconds_a_frame_ * frame; }  // s

 private:
  void DrawImages(int frames) const {
    cv::Mat texture(60, (640 + shift_ * frames) / 8 + 1, CV_8UC1);
    cv::RNG(1).fill(texture, cv::RNG::UNIFORM, 0, 256);
    for (int column = period_ / 8; period_ > 0 && column < texture.cols; ++column) {
      texture.col(column - period_ / 8).copyTo(texture.col(column));
    }
    cv::resize(texture, texture, cv::Size(8 * texture.cols, 480), 0.0, 0.0, cv::INTER_CUBIC);
    const cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(5000));
    for (int i = 0; i < frames; ++i) {
      const std::string name = fmt::format("{:02}.png", i);
      cv::imwrite((path() / "rgb" / name).string(), texture(cv::Rect(shift_ * i, 0, 640, 480)));
      cv::imwrite((path() / "depth" / name).string(), depth);
    }
  }

  void WriteLists(int frames) const {
    std::string rgb;
    std::string depth;
    std::string truth;
    std::string associations;
    for (int i = 0; i < frames; ++i) {
      const std::string of_rgb = fmt::format("{:.6f} rgb/{:02}.png", Stamp(i), i);
      const std::string of_depth = fmt::format("{:.6f} depth/{:02}.png", Stamp(i) + 0.005, i);
      rgb += of_rgb + '\n';
      depth += of_depth + '\n';
      truth += fmt::format("{:.6f} {:.3f} 0 0 0 0 0 1\n", Stamp(i), 0.002 * shift_ * i);
      associations += fmt::format("{} {}\n", of_rgb, of_depth);
    }
    folder_.Write("rgb.txt", rgb);
    folder_.Write("depth.txt", depth);
    folder_.Write("groundtruth.txt", truth);
    folder_.Write("associations.txt", associations);
  }

  double seconds_a_frame_;
  int shift_;
  int period_;
  TemporaryFolder folder_;
};

}  // namespace hullslam
