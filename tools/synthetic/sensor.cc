// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

// Focal length (px) times the distance between camera and projector (m).
constexpr float kProjectorBaseline = 535.0F * 0.075F;

// True for pixels whose surface the projector does not see. The projector is to the right of the
// camera and sees the surface at column x in its own column x - b/z. Going along a row from the
// right, a surface is in the shadow of something nearer if its projector column is to the right of
// the leftmost column so far.
std::vector<uint8_t> ShadowOfRow(const float* depth, int width) {
  std::vector<uint8_t> shadow(static_cast<size_t>(width), 0);
  float reached = std::numeric_limits<float>::infinity();
  for (int x = width - 1; x >= 0; --x) {
    const float column = static_cast<float>(x) - kProjectorBaseline / depth[x];
    // The tolerance of half a pixel prevents that neighbours on a slanted surface shadow each
    // other.
    shadow[static_cast<size_t>(x)] = column > reached + 0.5F ? 1 : 0;
    reached = std::min(reached, column);
  }
  return shadow;
}

// Normally distributed numbers on a coarse grid, interpolated: an error that neighbouring pixels
// share.
class SmoothNoise {
 public:
  SmoothNoise(const NormalTable& normal, uint64_t seed, const cv::Size& size)
      : columns_(size.width / kCell + 2) {
    const int rows = size.height / kCell + 2;
    for (int i = 0; i < rows * columns_; ++i) {
      lattice_.push_back(normal(CounterHash(seed, static_cast<uint64_t>(i)) >> 20));
    }
  }
  float operator()(int x, int y) const {
    const float fx = static_cast<float>(x % kCell) / kCell;
    const float fy = static_cast<float>(y % kCell) / kCell;
    const auto at = [&](int column, int row) {
      return lattice_[static_cast<size_t>(row * columns_ + column)];
    };
    const int column = x / kCell;
    const int row = y / kCell;
    const float top = at(column, row) + fx * (at(column + 1, row) - at(column, row));
    const float bottom = at(column, row + 1) + fx * (at(column + 1, row + 1) - at(column, row + 1));
    return top + fy * (bottom - top);
  }

 private:
  static constexpr int kCell = 5;  // px, about half of a matching block
  int columns_;
  std::vector<float> lattice_;
};

// Whether inverse depth jumps between the pixel and one of its four neighbours.
bool AtDepthEdge(const cv::Mat& depth, int x, int y) {
  constexpr float kJump = 0.03F;  // 1/m
  const float here = 1.0F / depth.at<float>(y, x);
  const auto jumps = [&](int u, int v) {
    const bool inside = u >= 0 && v >= 0 && u < depth.cols && v < depth.rows;
    return inside && std::abs(1.0F / depth.at<float>(v, u) - here) > kJump;
  };
  return jumps(x - 1, y) || jumps(x + 1, y) || jumps(x, y - 1) || jumps(x, y + 1);
}

bool LostAtGrazingAngle(float cosine, uint64_t word) {
  constexpr float kNever = 0.22F;
  constexpr float kAlways = 0.10F;
  const auto chance = static_cast<float>(UnitInterval(word << 32));
  return cosine < kAlways + (kNever - kAlways) * chance;
}

// The value at a point between pixels, bilinearly; outside the image that of the nearest pixel.
float Interpolate(const cv::Mat& depth, float x, float y) {
  const float u = std::clamp(x, 0.0F, static_cast<float>(depth.cols - 1));
  const float v = std::clamp(y, 0.0F, static_cast<float>(depth.rows - 1));
  const int left = std::min(static_cast<int>(u), depth.cols - 2);
  const int top = std::min(static_cast<int>(v), depth.rows - 2);
  const float a = u - static_cast<float>(left);
  const float b = v - static_cast<float>(top);
  const auto* const upper = depth.ptr<float>(top) + left;
  const auto* const lower = depth.ptr<float>(top + 1) + left;
  return (1.0F - b) * ((1.0F - a) * upper[0] + a * upper[1]) +
         b * ((1.0F - a) * lower[0] + a * lower[1]);
}

// The image that is left if each pixel keeps one colour, in blocks of 2 x 2 pixels with blue at the
// upper left, red at the lower right and green elsewhere, and the others are interpolated.
cv::Mat ThroughBayerFilter(const cv::Mat& image) {
  cv::Mat filtered(image.size(), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      filtered.at<uint8_t>(y, x) = image.at<cv::Vec3b>(y, x)[y % 2 + x % 2];
    }
  }
  cv::Mat colours;
  cv::cvtColor(filtered, colours, cv::COLOR_BayerRG2BGR);  // OpenCV names the second row and column
  return colours;
}

// The depths along z of depths along the rays of a fisheye lens; unknown from 90 degrees on.
void ToDepthAlongZ(const cv::Mat& axial, cv::Mat& image) {
  for (int y = 0; y < image.rows && !axial.empty(); ++y) {
    for (int x = 0; x < image.cols; ++x) {
      auto& depth = image.at<uint16_t>(y, x);
      const float cosine = std::max(0.0F, axial.at<float>(y, x));
      depth = static_cast<uint16_t>(std::lround(cosine * static_cast<float>(depth)));
    }
  }
}

uint16_t ToUnits(double metres, double units_per_metre) {
  const double units = std::round(metres * units_per_metre);
  return units > 65535.0 ? uint16_t{0} : static_cast<uint16_t>(units);
}

}  // namespace

cv::Mat Sensor::Colour(const RenderedFrame& frame, uint32_t number) const {
  const cv::Size size = frame.colour.size();
  cv::Mat exact = frame.colour;
  if (options_.lens_blur > 0.0) {
    cv::GaussianBlur(frame.colour, exact, {}, options_.lens_blur);
  }
  cv::Mat image(size, CV_8UC3);
  const uint64_t seed = HashSeed(seed_, number, "colour");
  const float gain =
      options_.noise ? 1.0F + 0.02F * std::sin(0.045F * static_cast<float>(number)) : 1.0F;
  const float reach =
      0.25F * static_cast<float>(size.width * size.width + size.height * size.height);
  for (int y = 0; y < size.height; ++y) {
    const float dy = static_cast<float>(y) - 0.5F * static_cast<float>(size.height);
    for (int x = 0; x < size.width; ++x) {
      const float dx = static_cast<float>(x) - 0.5F * static_cast<float>(size.width);
      const float light =
          gain * (options_.noise ? 1.0F - 0.16F * (dx * dx + dy * dy) / reach : 1.0F);
      const uint64_t word = CounterHash(seed, static_cast<uint64_t>(y * size.width + x));
      for (int c = 0; c < 3; ++c) {
        float value = light * exact.at<cv::Vec3f>(y, x)[c];
        if (options_.noise) {
          value += std::sqrt(0.9F + 0.009F * std::max(0.0F, value)) *
                   normal_(word >> (NormalTable::kBits * c));
        }
        image.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<uint8_t>(value);
      }
    }
  }
  return options_.bayer ? ThroughBayerFilter(image) : image;
}

// Barron and Malik (CVPR 2013) describe the depth Z (in cm) of a pixel of the Kinect by
//   35130 / floor(35130 / Z(x + n, y + m) + d + 0.5),
// where n and m have the standard deviation of 1/2 px and d that of 1/6; the depth between pixels
// is interpolated. Handa et al. (ICRA 2014) disturb the depth of ICL-NUIM in this way.
cv::Mat Sensor::IclNuimDepth(const RenderedFrame& frame, uint32_t number) const {
  constexpr double kDisparityOfMetre = 351.30;
  constexpr float kShift = 0.5F;
  constexpr double kDisparityNoise = 1.0 / 6.0;
  cv::Mat image(frame.depth.size(), CV_16UC1, cv::Scalar(0));
  const uint64_t seed = HashSeed(seed_, number, "depth");
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const uint64_t word = CounterHash(seed, static_cast<uint64_t>(y * image.cols + x));
      const float u = static_cast<float>(x) + kShift * normal_(word);
      const float v = static_cast<float>(y) + kShift * normal_(word >> NormalTable::kBits);
      const double noise = kDisparityNoise * normal_(word >> (2 * NormalTable::kBits));
      const double disparity = kDisparityOfMetre / Interpolate(frame.depth, u, v);
      const double z = kDisparityOfMetre / std::max(1.0, std::floor(disparity + noise + 0.5));
      const bool known = z >= options_.min_depth && z <= options_.max_depth;
      image.at<uint16_t>(y, x) = known ? ToUnits(z, options_.units_per_metre) : uint16_t{0};
    }
  }
  return image;
}

cv::Mat Sensor::Depth(const RenderedFrame& frame, uint32_t number) const {
  if (options_.noise && options_.model == DepthModel::kIclNuim) {
    return IclNuimDepth(frame, number);
  }
  const cv::Size size = frame.depth.size();
  cv::Mat image(size, CV_16UC1, cv::Scalar(0));
  const uint64_t seed = HashSeed(seed_, number, "depth");
  const SmoothNoise smooth(normal_, HashSeed(seed_, number, "depth blocks"), size);
  const auto in_range = [&](double z) {
    return z >= options_.min_depth && z <= options_.max_depth;
  };
  for (int y = 0; y < size.height; ++y) {
    const std::vector<uint8_t> shadow = ShadowOfRow(frame.depth.ptr<float>(y), size.width);
    for (int x = 0; x < size.width; ++x) {
      if (!options_.noise) {
        const double z = frame.depth.at<float>(y, x);
        image.at<uint16_t>(y, x) = in_range(z) ? ToUnits(z, options_.units_per_metre) : 0;
        continue;
      }
      const uint64_t word = CounterHash(seed, static_cast<uint64_t>(y * size.width + x));
      const bool edge = AtDepthEdge(frame.depth, x, y);
      if (shadow[static_cast<size_t>(x)] != 0 || (edge && (word & 0x3U) != 0) ||
          LostAtGrazingAngle(frame.cosine.at<float>(y, x), word)) {
        continue;
      }
      const int source =
          std::clamp(edge ? x + static_cast<int>((word >> 2) % 3) - 1 : x, 0, size.width - 1);
      const float error = 0.55F * smooth(x, y) + 0.3F * normal_(word >> 8);
      const double steps = 1.0 / (frame.depth.at<float>(y, source) * options_.disparity_step);
      const double z = 1.0 / (std::round(steps + error) * options_.disparity_step);
      image.at<uint16_t>(y, x) = in_range(z) ? ToUnits(z, options_.units_per_metre) : 0;
    }
  }
  ToDepthAlongZ(frame.axial, image);
  return image;
}

}  // namespace hullslam::synthetic
