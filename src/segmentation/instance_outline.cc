// SPDX-License-Identifier: GPL-3.0-or-later
#include "segmentation/instance_outline.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "hullslam/frame/mask_image.h"

namespace hullslam {
namespace {

using Logits = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct ImageBox {
  Eigen::Array2d least;  // along the edges of pixels
  Eigen::Array2d greatest;
};

ImageBox BoxInImage(const Candidate& candidate, const Letterbox& letterbox) {
  const Eigen::Array2d size(letterbox.image.width, letterbox.image.height);
  return {letterbox.ToImage(candidate.least).max(0.0).min(size),
          letterbox.ToImage(candidate.greatest).max(0.0).min(size)};
}

// The pixels whose centres are in the box.
cv::Rect PixelsIn(const ImageBox& box) {
  const Eigen::Array2i first = (box.least - 0.5).ceil().cast<int>();
  const Eigen::Array2i end = (box.greatest - 0.5).floor().cast<int>() + 1;
  return {first.x(), first.y(), std::max(0, end.x() - first.x()), std::max(0, end.y() - first.y())};
}

// Where the prototypes are read for a row or column of the image: between two of their pixels.
struct Sample {
  int first = 0;
  int second = 0;
  float weight = 0.0F;  // of the second
};

std::vector<Sample> Samples(int first_pixel, int count, double scale, double offset,
                            double prototype_scale, int prototype_size) {
  std::vector<Sample> samples(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double input = scale * (first_pixel + i + 0.5) + offset;
    const double at = std::clamp(input * prototype_scale - 0.5, 0.0, prototype_size - 1.0);
    const int before = std::min(static_cast<int>(at), prototype_size - 1);
    samples[static_cast<size_t>(i)] = {before, std::min(before + 1, prototype_size - 1),
                                       static_cast<float>(at - before)};
  }
  return samples;
}

Logits WeightPrototypes(const Candidate& candidate, const cv::Mat& prototypes) {
  const int rows = prototypes.size[2];
  const int columns = prototypes.size[3];
  const Eigen::Map<const Logits> matrix(prototypes.ptr<float>(), prototypes.size[1],
                                        Eigen::Index{rows} * columns);
  const Eigen::RowVectorXf sums = candidate.coefficients.transpose() * matrix;
  return Eigen::Map<const Logits>(sums.data(), rows, columns);
}

// The pixels of the rectangle that belong to the mask.
cv::Mat FindInside(const Logits& logits, const cv::Rect& pixels, const Letterbox& letterbox) {
  const std::vector<Sample> columns = Samples(
      pixels.x, pixels.width, letterbox.scale.x(), letterbox.offset.x(),
      static_cast<double>(logits.cols()) / letterbox.input.width, static_cast<int>(logits.cols()));
  const std::vector<Sample> rows = Samples(
      pixels.y, pixels.height, letterbox.scale.y(), letterbox.offset.y(),
      static_cast<double>(logits.rows()) / letterbox.input.height, static_cast<int>(logits.rows()));
  cv::Mat inside(pixels.size(), CV_8UC1);
  for (int y = 0; y < pixels.height; ++y) {
    const Sample& row = rows[static_cast<size_t>(y)];
    const Eigen::RowVectorXf line =
        (1.0F - row.weight) * logits.row(row.first) + row.weight * logits.row(row.second);
    auto* const out = inside.ptr<uint8_t>(y);
    for (int x = 0; x < pixels.width; ++x) {
      const Sample& column = columns[static_cast<size_t>(x)];
      const float logit =
          (1.0F - column.weight) * line[column.first] + column.weight * line[column.second];
      out[x] = logit > 0.0F ? 1 : 0;
    }
  }
  return inside;
}

}  // namespace

std::vector<Eigen::Vector2d> FindInstanceOutline(const Candidate& candidate,
                                                 const cv::Mat& prototypes,
                                                 const Letterbox& letterbox) {
  const cv::Rect pixels = PixelsIn(BoxInImage(candidate, letterbox));
  if (pixels.empty()) {
    return {};
  }
  const Logits logits = WeightPrototypes(candidate, prototypes);
  InstanceMask mask = MaskFromImage(FindInside(logits, pixels, letterbox), "");
  if (mask.outlines.empty()) {
    return {};
  }
  for (Eigen::Vector2d& point : mask.outlines.front()) {
    point += Eigen::Vector2d(pixels.x, pixels.y);
  }
  return std::move(mask.outlines.front());
}

std::vector<Eigen::Vector2d> BoxOutline(const Candidate& candidate, const Letterbox& letterbox) {
  const ImageBox box = BoxInImage(candidate, letterbox);
  const Eigen::Vector2d least = box.least - 0.5;
  const Eigen::Vector2d greatest = box.greatest - 0.5;
  if (!((greatest - least).prod() > 0.0)) {
    return {};
  }
  return {least, {greatest.x(), least.y()}, greatest, {least.x(), greatest.y()}};
}

}  // namespace hullslam
