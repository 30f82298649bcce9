// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

// Used instead of std::floor, which is a function call without SSE 4.1, because it runs in the
// innermost loop.
int Floor(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

// Interpolates between four texels. Returns 256 times the colour, in 16-bit lanes. The weights are
// integers with sum 256, so no lane overflows into the next one, and one multiplication weights all
// three colours. `texels` is a square of `size` x `size`.
uint64_t Bilinear(const uint64_t* texels, int size, float u, float v) {
  const int x = Floor((u * static_cast<float>(size) - 0.5F) * 256.0F + 0.5F);
  const int y = Floor((v * static_cast<float>(size) - 0.5F) * 256.0F + 0.5F);
  const auto fx = static_cast<uint64_t>(x & 255);
  const auto fy = static_cast<uint64_t>(y & 255);
  const uint64_t both = (fx * fy + 128) >> 8;
  const int mask =
      size - 1;  // works because the size is a power of two; wraps negative indices too
  const int left = (x >> 8) & mask;
  const int right = (left + 1) & mask;
  const auto* upper = texels + static_cast<ptrdiff_t>((y >> 8) & mask) * size;
  const auto* lower = texels + static_cast<ptrdiff_t>(((y >> 8) + 1) & mask) * size;
  return upper[left] * (256 - fx - fy + both) + upper[right] * (fx - both) +
         lower[left] * (fy - both) + lower[right] * both;
}

Eigen::Vector3f Unpack(uint64_t lanes) {
  const auto lane = [&](int i) {
    return static_cast<float>(static_cast<int>(lanes >> (16 * i) & 0xffff));
  };
  return Eigen::Vector3f(lane(0), lane(1), lane(2)) * (1.0F / 256.0F);
}

}  // namespace

Texture::Texture(const cv::Mat& image) {
  Check(image.type() == CV_8UC3 && image.rows == image.cols && image.rows > 0 &&
            std::has_single_bit(static_cast<unsigned>(image.rows)),
        "the texture is not a square colour image with a power of two as width");
  cv::Mat current = image;
  while (true) {
    Level level;
    level.size = current.rows;
    level.texels.reserve(current.total());
    for (int y = 0; y < current.rows; ++y) {
      for (int x = 0; x < current.cols; ++x) {
        const cv::Vec3b& c = current.at<cv::Vec3b>(y, x);
        level.texels.push_back(c[0] | uint64_t{c[1]} << 16 | uint64_t{c[2]} << 32);
      }
    }
    levels_.push_back(std::move(level));
    if (current.rows == 1) {
      return;
    }
    cv::Mat half;
    cv::resize(current, half, cv::Size(current.cols / 2, current.rows / 2), 0, 0, cv::INTER_AREA);
    current = half;
  }
}

float Texture::LevelOfDetail(float footprint) const {
  const float texels = footprint * static_cast<float>(size());
  const float last = static_cast<float>(levels_.size() - 1);
  return texels > 1.0F ? std::min(std::log2(texels), last) : 0.0F;
}

Eigen::Vector3f Texture::Sample(const Eigen::Vector2f& uv, float level_of_detail) const {
  const auto level = static_cast<size_t>(level_of_detail);
  const float fraction = level_of_detail - static_cast<float>(level);
  const auto at_level = [&](size_t index) {
    return Unpack(Bilinear(levels_[index].texels.data(), levels_[index].size, uv.x(), uv.y()));
  };
  Eigen::Vector3f fine = at_level(level);
  if (fraction > 0.0F) {
    fine += fraction * (at_level(level + 1) - fine);
  }
  return fine;
}

}  // namespace hullslam::synthetic
