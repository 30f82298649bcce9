// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/icl_office.h"

#include <vector>

#include "hullslam/util/check.h"
#include "synthetic/catalogue.h"
#include "synthetic/concave_models.h"

namespace hullslam::synthetic {
namespace {

constexpr double kIclTop = 0.74;  // metres

std::vector<Placement> RightDesk() {
  return {{"tv", {2.2, 0.35, kIclTop}, -90.0, Dark()},
          {"keyboard", {1.9, 0.35, kIclTop}, -88.0},
          {"mouse", {1.88, 0.02, kIclTop}, -85.0, White()},
          {"laptop", {2.1, -0.45, kIclTop}, -100.0, White()},
          {"cup", {1.95, 0.75, kIclTop}, 20.0, Red()},
          {"book", {2.0, 1.0, kIclTop}, 70.0, Yellow()},
          {"bottle", {2.25, 0.85, kIclTop}, 0.0, Green()}};
}

std::vector<Placement> BackTable() {
  return {{"microwave", {-0.9, 1.85, kIclTop}, 0.0, White()},
          {"potted plant", {-0.4, 1.9, kIclTop}, 0.0, Red(), 0.4},
          {"book", {0.0, 1.75, kIclTop}, 15.0, Blue()},
          {"teddy bear", {0.3, 1.9, kIclTop}, -10.0, White(), 0.34},
          {"vase", {-1.3, 1.85, kIclTop}, 0.0, Blue()}};
}

std::vector<Placement> OnFloor() {
  return {{"chair", {1.35, 0.25, 0.0}, 100.0, Blue()},
          {"chair", {-0.5, 1.2, 0.0}, 190.0, Red()},
          {"suitcase", {-2.1, -0.6, 0.0}, 100.0, Green()},
          {"potted plant", {-2.1, 1.2, 0.0}, 0.0, White(), 1.1},
          {"backpack", {0.7, -1.9, 0.0}, 160.0, Yellow()}};
}

// Posters on the walls behind the desks.
void AddPictures(SceneBuilder& builder, const Palette& palette) {
  const auto picture = [&](Wall wall, double along, double half_width, double half_height,
                           size_t poster) {
    builder.AddPanel(wall, along, 1.65, half_width, half_height,
                     builder.Fit(palette.posters[poster], {half_width, 1.0, half_height}));
  };
  picture(Wall::kBack, -1.2, 0.35, 0.28, 0);
  picture(Wall::kBack, -0.2, 0.25, 0.34, 1);
  picture(Wall::kRight, -0.9, 0.3, 0.36, 2);
  picture(Wall::kRight, 0.3, 0.4, 0.28, 3);
  picture(Wall::kRight, 1.4, 0.25, 0.3, 4);
}

}  // namespace

void FurnishIclOffice(SceneBuilder& builder) {
  const Palette rich = builder.AddRichPalette();
  const Palette bare = builder.AddBarePalette();
  Palette palette = rich;
  palette.wall = palette.feature_wall = bare.wall;
  palette.ceiling = bare.ceiling;
  palette.floor = bare.floor;
  builder.AddRoom({.half_x = 2.5, .half_y = 2.2, .height = 2.6}, palette);
  AddPictures(builder, palette);
  builder.AddShelf(Wall::kBack, 1.3, palette);
  builder.AddTable({2.05, 0.3}, {0.4, 0.95}, kIclTop, palette);
  builder.AddTable({-0.5, 1.85}, {1.0, 0.32}, kIclTop, palette);
  AddObjects(RightDesk(), palette, builder);
  AddObjects(BackTable(), palette, builder);
  AddObjects(OnFloor(), palette, builder);
  builder.AddObject(
      MakeOpenMug(builder.Repeat(rich.checker, 0.2, Red())).Build({1.85, -0.55, kIclTop}, 1.2));
  builder.scene().ambient = 0.55F;
  builder.scene().lights = {{.position = {0.8F, 0.4F, 2.5F}, .strength = 1.9F},
                            {.position = {-1.2F, -0.8F, 2.5F}, .strength = 1.4F}};
}

WaypointPath IclOfficePath(int number) {
  static const std::vector<std::vector<Waypoint>> kPaths = {{{{-1.3, -1.0, 1.45}, 42.0, -12.0},
                                                             {{-0.6, -1.2, 1.4}, 60.0, -14.0},
                                                             {{0.2, -1.0, 1.35}, 80.0, -12.0},
                                                             {{0.6, -0.5, 1.35}, 45.0, -14.0},
                                                             {{0.4, 0.0, 1.4}, 8.0, -14.0}},
                                                            {{{-0.2, -0.7, 1.45}, 70.0, -10.0},
                                                             {{-0.3, -0.6, 1.4}, 120.0, -10.0},
                                                             {{-0.5, -0.4, 1.4}, 175.0, -12.0},
                                                             {{-0.4, -0.2, 1.45}, 200.0, -14.0},
                                                             {{-0.2, -0.3, 1.4}, 150.0, -10.0}},
                                                            {{{0.5, -0.7, 1.25}, 35.0, -18.0},
                                                             {{0.7, -0.1, 1.2}, 10.0, -20.0},
                                                             {{0.7, 0.5, 1.25}, -12.0, -20.0},
                                                             {{0.3, 0.6, 1.3}, 25.0, -16.0},
                                                             {{0.0, 0.3, 1.35}, 70.0, -14.0}},
                                                            {{{0.2, 0.3, 1.4}, 15.0, -10.0},
                                                             {{0.1, 0.4, 1.4}, -35.0, -8.0},
                                                             {{-0.1, 0.5, 1.45}, -85.0, -10.0},
                                                             {{-0.3, 0.4, 1.4}, -125.0, -14.0},
                                                             {{-0.2, 0.3, 1.4}, -80.0, -10.0}}};
  Check(number >= 0 && number < static_cast<int>(kPaths.size()), "there is no such path");
  return {kPaths[static_cast<size_t>(number)], 0.5, 30.0};
}

}  // namespace hullslam::synthetic
