// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/letterbox.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hullslam {
namespace {

constexpr int kStride = 32;
constexpr int kGrey = 114;  // the grey of the borders in YOLO's training

int RoundUp(int size) { return (size + kStride - 1) / kStride * kStride; }

int Scaled(int size, double scale) {
  return std::max(1, static_cast<int>(std::lround(size * scale)));
}

}  // namespace

Letterbox FitLetterbox(const cv::Size& image, const cv::Size& input) {
  const double scale = std::min(static_cast<double>(input.width) / image.width,
                                static_cast<double>(input.height) / image.height);
  Letterbox box{.image = image, .input = input, .scaled = {}, .scale = {}, .offset = {}};
  box.scaled = {std::min(input.width, Scaled(image.width, scale)),
                std::min(input.height, Scaled(image.height, scale))};
  box.scale = {static_cast<double>(box.scaled.width) / image.width,
               static_cast<double>(box.scaled.height) / image.height};
  box.offset = {static_cast<double>((input.width - box.scaled.width) / 2),
                static_cast<double>((input.height - box.scaled.height) / 2)};
  return box;
}

cv::Size InputSize(const cv::Size& image, int longer) {
  const double scale = static_cast<double>(longer) / std::max(image.width, image.height);
  return {RoundUp(Scaled(image.width, scale)), RoundUp(Scaled(image.height, scale))};
}

cv::Mat MakeInput(const cv::Mat& image, const Letterbox& letterbox) {
  cv::Mat colour;
  if (image.channels() == 1) {
    cv::cvtColor(image, colour, cv::COLOR_GRAY2RGB);
  } else {
    cv::cvtColor(image, colour, image.channels() == 4 ? cv::COLOR_BGRA2RGB : cv::COLOR_BGR2RGB);
  }
  if (colour.size() != letterbox.scaled) {
    cv::resize(colour, colour, letterbox.scaled, 0.0, 0.0, cv::INTER_LINEAR);
  }
  const int left = static_cast<int>(letterbox.offset.x());
  const int top = static_cast<int>(letterbox.offset.y());
  cv::copyMakeBorder(colour, colour, top, letterbox.input.height - top - colour.rows, left,
                     letterbox.input.width - left - colour.cols, cv::BORDER_CONSTANT,
                     cv::Scalar::all(kGrey));
  const std::array<int, 4> shape = {1, 3, colour.rows, colour.cols};
  cv::Mat input(static_cast<int>(shape.size()), shape.data(), CV_32F);
  std::array<cv::Mat, 3> planes;
  for (int channel = 0; channel < 3; ++channel) {
    planes.at(static_cast<size_t>(channel)) =
        cv::Mat(colour.rows, colour.cols, CV_32F, input.ptr<float>(0, channel));
  }
  cv::Mat values;
  colour.convertTo(values, CV_32F, 1.0 / 255.0);
  cv::split(values, planes.data());
  return input;
}

}  // namespace hullslam
