// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/office_table.h"

#include <vector>

#include "synthetic/catalogue.h"
#include "synthetic/concave_models.h"

namespace hullslam::synthetic {
namespace {

constexpr double kOfficeTop = 0.74;  // metres

}  // namespace

Palette FurnishOfficeTable(SceneBuilder& builder) {
  Palette palette = builder.AddRoomPalette(builder.AddRichPalette(), 0, {178, 188, 190});
  palette.feature_wall = palette.wall;
  builder.AddRoom({.half_x = 3.5, .half_y = 3.2, .height = 2.7}, palette);
  builder.AddPosters(palette);
  builder.AddShelf(Wall::kBack, 1.2, palette);
  builder.AddShelf(Wall::kLeft, 0.3, palette);
  builder.AddTable({0.0, 0.0}, {0.85, 0.45}, kOfficeTop, palette);
  const std::vector<Placement> placements = {
      {"tv", {-0.25, 0.2, kOfficeTop}, 6.0, Dark()},
      {"keyboard", {-0.28, -0.12, kOfficeTop}, 4.0},
      {"mouse", {0.05, -0.12, kOfficeTop}, -10.0, Dark()},
      {"book", {0.55, -0.2, kOfficeTop}, 25.0, Yellow()},
      {"book", {0.3, 0.28, kOfficeTop}, -15.0, Red()},
      {"book", {-0.7, -0.25, kOfficeTop}, 60.0, Blue()},
      {"bottle", {0.68, 0.25, kOfficeTop}, 0.0, Green()},
      {"cup", {0.25, -0.28, kOfficeTop}, 130.0, Blue()},
      {"sports ball", {0.5, 0.1, kOfficeTop}, 0.0, White()},
      {"potted plant", {-0.68, 0.22, kOfficeTop}, 0.0, Red(), 0.38},
      {"cell phone", {-0.02, -0.33, kOfficeTop}, 35.0},
      {"orange", {-0.45, -0.33, kOfficeTop}, 0.0, {0.5F, 1.1F, 1.6F}},
      {"chair", {-1.35, 0.15, 0.0}, 80.0, Green()},
      {"suitcase", {1.9, 2.1, 0.0}, 25.0, Red()},
      {"backpack", {-2.2, 2.5, 0.0}, 15.0, Yellow()},
      {"potted plant", {-2.9, -2.5, 0.0}, 0.0, White(), 1.1},
      {"clock", {0.1, 3.17, 1.95}, 0.0, White()}};
  AddObjects(placements, palette, builder);
  builder.AddObject(MakeOpenMug(builder.Repeat(palette.checker, 0.2, Red()))
                        .Build({0.02, 0.24, kOfficeTop}, 0.6));
  builder.scene().ambient = 0.55F;
  builder.scene().lights = {{.position = {-1.4F, -1.2F, 2.6F}, .strength = 2.0F},
                            {.position = {1.8F, 1.4F, 2.5F}, .strength = 1.6F}};
  return palette;
}

}  // namespace hullslam::synthetic
