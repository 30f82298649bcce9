// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/road.h"

#include <cmath>

#include "synthetic/camera_path.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kHalfLength = 160.0;     // metres, of the valley along x
constexpr double kHalfWidth = 75.0;       // metres
constexpr double kHeight = 70.0;          // metres
constexpr double kEyeAboveGround = 10.0;  // metres
constexpr double kStart = -130.0;         // x of the camera at time 0, metres
constexpr double kSpeed = 30.0;           // m/s
constexpr double kStreet = 36.0;          // metres from the path to the houses

// A row of houses along x with gaps between them, on one side of the path.
void AddHouses(double side, const Palette& palette, SceneBuilder& builder) {
  RandomStream& random = builder.random();
  double begin = kStart;
  size_t next = 0;
  while (begin < kHalfLength - 10.0) {
    const double half_width = random.Uniform(4.0, 9.0);
    const double half_depth = random.Uniform(3.0, 8.0);
    const double half_height = random.Uniform(5.0, 16.0);
    const double back = random.Uniform(0.0, 12.0);
    const int picture = palette.posters[next++ % palette.posters.size()];
    const Material front = builder.Repeat(picture, random.Uniform(9.0, 16.0));
    builder.AddBackground(
        Shape::Box({half_width, half_depth, half_height}), front,
        Shift(begin + half_width, side * (kStreet + back + half_depth), half_height));
    begin += 2.0 * half_width + random.Uniform(3.0, 14.0);
  }
}

void AddTrees(double side, const Palette& palette, SceneBuilder& builder) {
  RandomStream& random = builder.random();
  const Material leaves = builder.Repeat(palette.fur, 6.0, {0.45F, 1.0F, 0.4F});
  for (double x = kStart + 5.0; x < kHalfLength - 10.0; x += random.Uniform(9.0, 20.0)) {
    const double half_height = random.Uniform(2.5, 6.0);
    builder.AddBackground(Shape::Superquadric({2.2, 2.2, half_height}, 0.9, 0.9), leaves,
                          Shift(x, side * random.Uniform(32.5, 33.5), half_height));
  }
}

// Houses far ahead, so that the middle of the image shows more than a wall.
void AddEnd(const Palette& palette, SceneBuilder& builder) {
  RandomStream& random = builder.random();
  for (double y = -60.0; y < 60.0; y += random.Uniform(12.0, 20.0)) {
    const double half_height = random.Uniform(6.0, 20.0);
    builder.AddBackground(
        Shape::Box({4.0, random.Uniform(4.0, 7.0), half_height}),
        builder.Repeat(palette.posters[static_cast<size_t>(random.Index(8))], 18.0),
        Shift(kHalfLength - random.Uniform(10.0, 60.0), y, half_height));
  }
}

}  // namespace

void FurnishRoad(SceneBuilder& builder) {
  const Palette palette = builder.AddRichPalette();
  builder.AddRoom(
      {.half_x = kHalfLength, .half_y = kHalfWidth, .height = kHeight, .floor_tile = 40.0},
      palette);
  for (const double side : {-1.0, 1.0}) {
    AddHouses(side, palette, builder);
    AddTrees(side, palette, builder);
  }
  AddEnd(palette, builder);
  builder.scene().ambient = 1.0F;
}

Rigid3 RoadPath::WorldFromCam(double time) const {
  const Vector3d eye(kStart + kSpeed * time, 1.5 * std::sin(0.9 * time + phase),
                     kEyeAboveGround + 0.04 * std::sin(7.0 * time + phase));
  const double yaw = 0.10 * std::sin(1.1 * time + phase);
  const double pitch = 0.04 + 0.008 * std::sin(6.0 * time + 2.0 * phase);
  return LookAt(eye, eye + Vector3d(std::cos(yaw), std::sin(yaw), std::tan(pitch)));
}

PinholeCamera RoadCamera() {
  return {.fx = 718.856,
          .fy = 718.856,
          .cx = 607.193,
          .cy = 185.216,
          .width = 1226,
          .height = 370,
          .bf = 0.54 * 718.856};
}

}  // namespace hullslam::synthetic
