// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/resized_images.h"

#include <fmt/format.h>

#include <charconv>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <utility>

#include "hullslam/util/error.h"
#include "sequences/image_file.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

void Resize(int interpolation, const PinholeCamera& camera, cv::Mat& image) {
  if (!image.empty()) {
    cv::Mat resized;
    cv::resize(image, resized, {camera.width, camera.height}, 0.0, 0.0, interpolation);
    image = resized;
  }
}

// Averages where the image becomes smaller.
int InterpolationFor(int read_width, const PinholeCamera& camera) {
  return camera.width < read_width ? cv::INTER_AREA : cv::INTER_LINEAR;
}

bool ParsePixels(std::string_view text, int& pixels) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), pixels);
  return error == std::errc() && end == text.data() + text.size() && pixels > 0;
}

}  // namespace

void ResizeImages(int read_width, int read_height, const PinholeCamera& camera,
                  ImageSequence& sequence) {
  sequence.choices["resized_from"] = fmt::format("{}x{}", read_width, read_height);
  sequence.read_width = read_width;
  sequence.read_height = read_height;
  sequence.load = [load = std::move(sequence.load), read_width, read_height](
                      const FramePaths& frame, const PinholeCamera& resized) {
    PinholeCamera as_read = resized;
    as_read.width = read_width;
    as_read.height = read_height;
    ImageInput image = load(frame, as_read);
    const int interpolation = InterpolationFor(read_width, resized);
    Resize(interpolation, resized, image.grey);
    Resize(interpolation, resized, image.right);
    Resize(cv::INTER_NEAREST, resized, image.depth);
    return image;
  };
  sequence.load_colour = [load = std::move(sequence.load_colour), read_width,
                          camera](const FramePaths& frame) {
    cv::Mat image = load != nullptr ? load(frame) : ReadColourImage(frame.image);
    Resize(InterpolationFor(read_width, camera), camera, image);
    return image;
  };
  for (auto* const fit_mask_all : {&sequence.fit_mask_all, &sequence.fit_right_mask_all}) {
    *fit_mask_all = [fit = std::move(*fit_mask_all), camera](const cv::Mat& mask) {
      cv::Mat resized = fit != nullptr ? fit(mask) : mask;
      Resize(cv::INTER_NEAREST, camera, resized);
      return resized;
    };
  }
  const Eigen::Vector2d scale(static_cast<double>(camera.width) / read_width,
                              static_cast<double>(camera.height) / read_height);
  for (auto* const fit_mask : {&sequence.fit_mask, &sequence.fit_right_mask}) {
    *fit_mask = [fit = std::move(*fit_mask), scale](InstanceMask& mask) {
      if (fit != nullptr) {
        fit(mask);
      }
      for (std::vector<Eigen::Vector2d>& outline : mask.outlines) {
        for (Eigen::Vector2d& point : outline) {
          point = (point.array() + 0.5) * scale.array() - 0.5;
        }
      }
    };
  }
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
