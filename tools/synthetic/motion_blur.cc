// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/motion_blur.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The motions from the middle of the exposure of a row to its end: of the static scene first, then
// of each object, as end_from_middle in the frame of the camera.
std::vector<Rigid3> MotionsOfRow(const Scene& scene, double middle, double half_duration) {
  const Rigid3 world_from_cam = scene.world_from_cam(middle);
  const Rigid3 end_from_world = Inverse(scene.world_from_cam(middle + half_duration));
  std::vector<Rigid3> motions(scene.objects.size() + 1, end_from_world * world_from_cam);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.IsDynamic()) {
      motions[i + 1] = end_from_world * object.WorldFromObject(middle + half_duration) *
                       Inverse(object.WorldFromObject(middle)) * world_from_cam;
    }
  }
  return motions;
}

// The weights of the four pixels around a point between the second and the third of them, `share`
// of the way (Keys 1981, a = -1/2). Bilinear weights would add a blur that is larger than that of a
// small motion.
std::array<float, 4> CubicWeights(float share) {
  const float t = share;
  return {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
          ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
}

// The colour between pixels; outside the image that of the nearest pixel.
cv::Vec3f ColourAt(const cv::Mat& colour, const Vector2d& pixel) {
  const int left = static_cast<int>(std::floor(pixel.x()));
  const int top = static_cast<int>(std::floor(pixel.y()));
  const std::array<float, 4> across = CubicWeights(static_cast<float>(pixel.x() - left));
  const std::array<float, 4> down = CubicWeights(static_cast<float>(pixel.y() - top));
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (int j = 0; j < 4; ++j) {
    const auto* const row = colour.ptr<cv::Vec3f>(std::clamp(top + j - 1, 0, colour.rows - 1));
    cv::Vec3f of_row(0.0F, 0.0F, 0.0F);
    for (int i = 0; i < 4; ++i) {
      of_row += across[static_cast<size_t>(i)] * row[std::clamp(left + i - 1, 0, colour.cols - 1)];
    }
    sum += down[static_cast<size_t>(j)] * of_row;
  }
  return sum;
}

// The mean of the colours from `middle` - `half` to `middle` + `half`, about one sample per pixel.
cv::Vec3f MeanAlong(const cv::Mat& colour, const Vector2d& middle, const Vector2d& half) {
  constexpr int kMostSamples = 64;
  constexpr double kNoMotion = 0.05;  // px
  const double length = 2.0 * half.norm();
  if (length < kNoMotion) {
    return colour.at<cv::Vec3f>(static_cast<int>(middle.y()), static_cast<int>(middle.x()));
  }
  const int samples = std::min(static_cast<int>(std::ceil(length)) + 1, kMostSamples);
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (int i = 0; i < samples; ++i) {
    sum += ColourAt(colour, middle + ((2.0 * i + 1.0) / samples - 1.0) * half);
  }
  return sum / static_cast<float>(samples);
}

}  // namespace

cv::Mat BlurByMotion(const RenderedFrame& frame, const Scene& scene, const PinholeCamera& camera,
                     const Exposure& exposure) {
  cv::Mat blurred = frame.colour.clone();
  if (exposure.duration <= 0.0) {
    return blurred;
  }
  for (int y = 0; y < blurred.rows; ++y) {
    const double share = (y + 0.5) / blurred.rows - 0.5;
    const std::vector<Rigid3> motions =
        MotionsOfRow(scene, exposure.time + share * exposure.readout_time, 0.5 * exposure.duration);
    for (int x = 0; x < blurred.cols; ++x) {
      const Vector2d pixel(x, y);
      const auto object = static_cast<size_t>(frame.instance.at<int16_t>(y, x) + 1);
      const Vector3d point = camera.Unproject(camera.Undistort(pixel), frame.depth.at<float>(y, x));
      const Vector3d moved = motions[object] * point;
      if (moved.z() > 0.0) {
        blurred.at<cv::Vec3f>(y, x) =
            MeanAlong(frame.colour, pixel, camera.Distort(camera.Project(moved)) - pixel);
      }
    }
  }
  return blurred;
}

}  // namespace hullslam::synthetic
