// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "hullslam/results/trajectory_file.h"
#include "support/rendered_desk.h"
#include "support/temporary_folder.h"

namespace hullslam {

// A camera sees the left half of a desk, then nothing, then the right half on the way back, and
// last the whole desk. So no image shows what was seen before the gap until both parts are mapped.
class InterruptedDesk {
 public:
  static constexpr int kFrames = 30;  // of each part

  struct Options {
    int blank = 8;            // black images between the halves
    bool shows_whole = true;  // without the last part, the halves cannot be joined
    bool has_depth = false;
  };

  explicit InterruptedDesk(const Options& options) : options_(options) {
    std::filesystem::create_directory(path() / "rgb");
    std::filesystem::create_directory(path() / "depth");
    std::filesystem::copy(desk_.path() / "camera.yaml", path() / "camera.yaml");
    for (int i = 0; i < kFrames; ++i) {
      Add(i, Side::kLeft);
    }
    for (int i = 0; i < options.blank; ++i) {
      AddImages(cv::Mat::zeros(480, 640, CV_8UC3), cv::Mat::zeros(480, 640, CV_16UC1));
    }
    for (int i = kFrames - 1; i >= 0; --i) {
      Add(i, Side::kRight);
    }
    for (int i = 0; i < kFrames && options.shows_whole; ++i) {
      Add(i, Side::kBoth);
    }
    folder_.Write("rgb.txt", Lines("rgb"));
    if (options.has_depth) {
      folder_.Write("depth.txt", Lines("depth"));
    }
    folder_.Write("groundtruth.txt", FormatTrajectory(truth_));
  }

  const std::filesystem::path& path() const { return folder_.path(); }
  int size() const { return size_; }

 private:
  enum class Side { kLeft, kRight, kBoth };

  // One half of an image; the other one is black, and brightness falls off between them.
  static cv::Mat HalfOf(const cv::Mat& image, Side side) {
    constexpr int kRamp = 48;  // px
    cv::Mat half = image.clone();
    for (int x = 0; x < half.cols && side != Side::kBoth; ++x) {
      const int inside = side == Side::kLeft ? half.cols / 2 - x : x - half.cols / 2;
      half.col(x) *= std::clamp(inside / static_cast<double>(kRamp), 0.0, 1.0);
    }
    return half;
  }

  static double StampOf(int frame) { return 100.0 + frame / 30.0; }

  void Add(int frame, Side side) {
    const auto index = static_cast<size_t>(frame);
    truth_.push_back({StampOf(size_), desk_truth_.at(index).world_from_cam});
    AddImages(HalfOf(cv::imread(images_.frames.at(index).image.string()), side),
              cv::imread(images_.frames.at(index).depth.string(), cv::IMREAD_UNCHANGED));
  }
  void AddImages(const cv::Mat& image, const cv::Mat& depth) {
    cv::imwrite((path() / fmt::format("rgb/{}.png", size_)).string(), image);
    if (options_.has_depth) {
      cv::imwrite((path() / fmt::format("depth/{}.png", size_)).string(), depth);
    }
    ++size_;
  }
  std::string Lines(const std::string& folder) const {
    std::string lines;
    for (int i = 0; i < size_; ++i) {
      lines += fmt::format("{:.6f} {}/{}.png\n", StampOf(i), folder, i);
    }
    return lines;
  }

  const Options options_;
  RenderedDesk desk_{kFrames};
  ImageSequence images_ = OpenTumSequence(desk_.path(), {});
  Trajectory desk_truth_ = ReadTrajectory(desk_.path() / "groundtruth.txt");
  TemporaryFolder folder_;
  Trajectory truth_;
  int size_ = 0;
};

}  // namespace hullslam
