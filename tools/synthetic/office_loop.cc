// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/office_loop.h"

#include <numbers>
#include <vector>

#include "synthetic/catalogue.h"
#include "synthetic/concave_models.h"

namespace hullslam::synthetic {
namespace {

using std::numbers::pi;

constexpr double kLoopTop = 0.74;  // metres

// The objects of the desk at -y, whose user looks towards +y.
std::vector<Placement> FrontDesk() {
  return {{"tv", {0.2, -0.2, kLoopTop}, 0.0, Dark()},
          {"keyboard", {0.18, -0.5, kLoopTop}, 3.0},
          {"mouse", {0.5, -0.48, kLoopTop}, -8.0, White()},
          {"book", {-0.55, -0.5, kLoopTop}, 20.0, Red()},
          {"cup", {-0.25, -0.5, kLoopTop}, 150.0, Blue()},
          {"teddy bear", {-0.55, -0.2, kLoopTop}, 15.0, {1.0F, 1.0F, 1.0F}, 0.3},
          {"bottle", {0.68, -0.22, kLoopTop}, 0.0, Green()}};
}

// The objects of the desk at +y, whose user looks towards -y.
std::vector<Placement> BackDesk() {
  return {{"tv", {-0.3, 0.2, kLoopTop}, 180.0, Dark()},
          {"keyboard", {-0.2, 0.52, kLoopTop}, 170.0},
          {"laptop", {0.4, 0.42, kLoopTop}, 170.0, White()},
          {"book", {-0.66, 0.48, kLoopTop}, -40.0, Yellow()},
          {"potted plant", {0.66, 0.2, kLoopTop}, 0.0, Red(), 0.36},
          {"sports ball", {0.15, 0.18, kLoopTop}, 0.0, Yellow()},
          {"cell phone", {0.08, 0.55, kLoopTop}, 60.0}};
}

// Things on the floor, outside the path of the camera.
std::vector<Placement> Surroundings() {
  return {{"chair", {0.15, -0.95, 0.0}, 175.0, Red()},
          {"chair", {-0.25, 0.95, 0.0}, 5.0, Blue()},
          {"couch", {-2.6, 3.0, 0.0}, 0.0, Green()},
          {"suitcase", {3.2, -1.5, 0.0}, 80.0, Blue()},
          {"potted plant", {3.2, 3.0, 0.0}, 0.0, White(), 1.2},
          {"refrigerator", {-3.4, -2.8, 0.0}, 0.0, White()},
          {"backpack", {1.2, -3.2, 0.0}, 0.0, Yellow()}};
}

}  // namespace

// No texture is seen at two places. Where textures repeat, they are the same to the pixel, which
// real things are not, and systems that find loops by appearance alone then find wrong ones.
void FurnishOfficeLoop(SceneBuilder& builder) {
  Palette palette = builder.AddRoomPalette(builder.AddRichPalette(), 0, {186, 182, 172});
  palette.feature_wall = palette.wall;
  palette.floor = builder.AddLargeCarpet({112, 109, 103});
  const Palette other = builder.AddRichPalette(1);
  for (const std::vector<int>& posters : {other.posters, builder.AddRichPalette(2).posters}) {
    palette.posters.insert(palette.posters.end(), posters.begin(), posters.end());
  }
  builder.AddRoom({.half_x = 3.8, .half_y = 3.6, .height = 2.7, .floor_tile = 8.0}, palette);
  builder.AddPosters(palette);
  builder.AddShelf(Wall::kRight, -0.5, palette);
  builder.AddShelf(Wall::kFront, 1.4, other);
  builder.AddTable({0.0, -0.35}, {0.8, 0.34}, kLoopTop, palette);
  builder.AddTable({0.0, 0.35}, {0.8, 0.34}, kLoopTop, other);
  AddObjects(FrontDesk(), palette, builder);
  AddObjects(BackDesk(), other, builder);
  AddObjects(Surroundings(), palette, builder);
  builder.AddObject(MakeOpenMug(builder.Repeat(palette.speckle, 0.2, Yellow()))
                        .Build({0.3, 0.14, kLoopTop}, 0.3));
  builder.scene().ambient = 0.55F;
  builder.scene().lights = {{.position = {-1.6F, -1.4F, 2.6F}, .strength = 2.0F},
                            {.position = {1.8F, 1.5F, 2.6F}, .strength = 1.9F}};
}

OrbitPath OfficeLoopPath(double seconds) {
  constexpr double kOverlap = pi / 9.0;
  return {.radius = 1.85,
          .height = 1.45,
          .start_angle = -2.0,
          .angular_speed = (2.0 * pi + kOverlap) / seconds,
          .target = {0.0, 0.0, 0.8}};
}

}  // namespace hullslam::synthetic
