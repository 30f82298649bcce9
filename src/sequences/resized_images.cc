// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/resized_images.h"

#include <fmt/format.h>

#include <charconv>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <utility>

#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

bool ParsePixels(std::string_view text, int& pixels) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), pixels);
  return error == std::errc() && end == text.data() + text.size() && pixels > 0;
}

}  // namespace

void ResizeImages(int read_width, int read_height, const PinholeCamera& camera,
                  ImageSequence& sequence) {
  const cv::Size size(camera.width, camera.height);
  // Averages where the image becomes smaller.
  const int smooth = camera.width < read_width ? cv::INTER_AREA : cv::INTER_LINEAR;
  const Eigen::Array2d scale(static_cast<double>(camera.width) / read_width,
                             static_cast<double>(camera.height) / read_height);
  AddWarp({.choice = {"resized_from", fmt::format("{}x{}", read_width, read_height)},
           .image =
               [size, smooth](const cv::Mat& image, ImageSide /*side*/, bool is_nearest) {
                 cv::Mat resized;
                 cv::resize(image, resized, size, 0.0, 0.0,
                            is_nearest ? cv::INTER_NEAREST : smooth);
                 return resized;
               },
           .pixel =
               [scale](const Eigen::Vector2d& pixel, ImageSide /*side*/) {
                 return Eigen::Vector2d((pixel.array() + 0.5) * scale - 0.5);
               },
           .size_before = {read_width, read_height}},
          sequence);
}

void ResizeImages(const std::string& size, const PinholeCamera& camera, ImageSequence& sequence) {
  if (size.empty()) {
    return;
  }
  const std::string_view text = size;
  const size_t cross = text.find('x');
  int width = 0;
  int height = 0;
  if (cross == std::string_view::npos || !ParsePixels(text.substr(0, cross), width) ||
      !ParsePixels(text.substr(cross + 1), height)) {
    throw InputError(
        fmt::format("resized_from is '{}', expected a size such as 1280x720", ShowText(size)));
  }
  ResizeImages(width, height, camera, sequence);
}

}  // namespace hullslam
