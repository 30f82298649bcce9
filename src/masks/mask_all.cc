// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_all.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <string>

#include "files/read_file.h"
#include "hullslam/util/error.h"
#include "images/image_file.h"

namespace hullslam {
namespace {

void RequireUsedPixels(const std::filesystem::path& path, const cv::Mat& mask) {
  if (cv::countNonZero(mask) == 0) {
    throw InputError(path.string() +
                     ": is black everywhere, expected other pixels where the images are used");
  }
}

}  // namespace

cv::Mat ReadMaskAll(const std::filesystem::path& path) {
  constexpr size_t kMostBytes = 64'000'000;
  const std::string bytes = ReadFile(path, kMostBytes);
  if (bytes.starts_with("\xff\xd8\xff")) {
    throw InputError(path.string() +
                     ": is a JPEG image, whose black pixels may have become dark ones; expected a "
                     "PNG image");
  }
  cv::Mat brightest;
  const cv::Mat colour = DecodeColourImage(path, bytes);
  cv::reduce(colour.reshape(1, static_cast<int>(colour.total())), brightest, 1, cv::REDUCE_MAX);
  cv::Mat mask = brightest.reshape(1, colour.rows) > 0;
  RequireUsedPixels(path, mask);
  return mask;
}

cv::Mat ReadMaskAll(const std::filesystem::path& path, const ImageSequence& sequence,
                    const PinholeCamera& camera, ImageSide side) {
  const cv::Mat as_read = ReadMaskAll(path);
  const cv::Size expected = SizeAsRead(sequence, camera);
  if (as_read.size() != expected) {
    throw InputError(fmt::format("{}: is {}x{} px, expected the size of the images, {}x{} px",
                                 path.string(), as_read.cols, as_read.rows, expected.width,
                                 expected.height));
  }
  constexpr int kHalf = 128;  // of a pixel whose value was interpolated
  cv::Mat mask = FitMaskAll(sequence.warps, side, as_read) >= kHalf;
  RequireUsedPixels(path, mask);
  return mask;
}

double IgnoredShare(const cv::Mat& mask_all) {
  return mask_all.empty() ? 0.0
                          : 1.0 - static_cast<double>(cv::countNonZero(mask_all)) /
                                      static_cast<double>(mask_all.total());
}

}  // namespace hullslam
