// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "hullslam/camera/pinhole.h"
#include "synthetic/renderer.h"
#include "synthetic/scene.h"

namespace hullslam::synthetic {

// A camera with a quarter of the resolution of the sequences, so that tests are fast.
inline PinholeCamera SmallCamera() {
  return {.fx = 133.85, .fy = 134.8, .cx = 80.0, .cy = 61.9, .width = 160, .height = 120};
}

// The largest motion of a visible point from `time` to the next frame, in px of a 640x480 image.
// `frame` was rendered at `time` with SmallCamera().
inline double LargestMotion(const Scene& scene, const RenderedFrame& frame, double time) {
  const PinholeCamera small = SmallCamera();
  const Rigid3 world_from_cam = scene.world_from_cam(time);
  const double next = time + 1.0 / 30.0;
  const Rigid3 next_from_world = Inverse(scene.world_from_cam(next));
  double largest = 0.0;
  for (int y = 0; y < small.height; y += 4) {
    for (int x = 0; x < small.width; x += 4) {
      const Eigen::Vector2d pixel(x, y);
      Eigen::Vector3d point = world_from_cam * small.Unproject(pixel, frame.depth.at<float>(y, x));
      const int object = frame.instance.at<int16_t>(y, x);
      if (object >= 0) {
        const SceneObject& moving = scene.objects[static_cast<size_t>(object)];
        point = moving.WorldFromObject(next) * (Inverse(moving.WorldFromObject(time)) * point);
      }
      largest = std::max(largest, 4.0 * (small.Project(next_from_world * point) - pixel).norm());
    }
  }
  return largest;
}

}  // namespace hullslam::synthetic
