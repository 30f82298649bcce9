// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/stereo_loading.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "images/image_file.h"
#include "sequences/image_list.h"

namespace hullslam {
namespace {

cv::Mat Half(const cv::Mat& both, int half) {
  const int width = both.cols / 2;
  return both.colRange(half * width, (half + 1) * width).clone();
}

}  // namespace

void LoadWithoutDepth(ImageSequence& sequence) {
  std::vector<std::filesystem::path> images;
  for (const FramePaths& frame : sequence.frames) {
    images.push_back(frame.image);
    if (!frame.right.empty()) {
      images.push_back(frame.right);
    }
  }
  const uint16_t brightest = BrightestOf(images);
  sequence.load = [brightest](const FramePaths& frame, const PinholeCamera& camera) {
    ImageInput image{frame.timestamp, ReadGreyImage(frame.image, brightest), cv::Mat()};
    image.right = frame.right.empty() ? cv::Mat() : ReadGreyImage(frame.right, brightest);
    CheckImageSize(frame.image.string(), image.grey, camera);
    if (!frame.right.empty()) {
      CheckImageSize(frame.right.string(), image.right, camera);
    }
    return image;
  };
  sequence.load_colour = [brightest](const FramePaths& frame) {
    return ReadColourImage(frame.image, brightest);
  };
}

void SplitHalves(ImageSequence& sequence) {
  sequence.load = [load = sequence.load](const FramePaths& frame, const PinholeCamera& camera) {
    PinholeCamera of_both = camera;
    of_both.width *= 2;
    ImageInput pair = load(frame, of_both);
    pair.right = Half(pair.grey, 1);
    pair.grey = Half(pair.grey, 0);
    return pair;
  };
  sequence.load_colour = [load = sequence.load_colour](const FramePaths& frame) {
    return Half(load(frame), 0);
  };
}

void RectifyPairs(const std::shared_ptr<const StereoRectifier>& rectifier,
                  ImageSequence& sequence) {
  if (rectifier == nullptr) {
    return;
  }
  const Rigid3& turn = rectifier->rectified_from_left();
  const Eigen::Quaterniond& q = turn.rotation;
  const bool is_turned = q.w() != 1.0;  // not if the pair is rectified as read
  AddWarp({.choice = {"rectified_from_left",
                      fmt::format("{:.9f} {:.9f} {:.9f} {:.9f}", q.x(), q.y(), q.z(), q.w())},
           .image = [rectifier](const cv::Mat& image, ImageSide side,
                                bool /*is_nearest*/) { return rectifier->Rectify(image, side); },
           .pixel = [rectifier](const Eigen::Vector2d& pixel,
                                ImageSide side) { return rectifier->Rectify(pixel, side); },
           .after_from_before = is_turned ? std::optional(turn) : std::nullopt},
          sequence);
}

}  // namespace hullslam
