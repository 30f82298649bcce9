// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/room.h"

#include <numbers>

#include "synthetic/catalogue.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using std::numbers::pi;

constexpr double kRoomTableHeight = 0.75;

void FurnishBackWall(SceneBuilder& builder, const Palette& palette) {
  builder.AddObject(MakeCouch(builder.Repeat(palette.fabric, 0.8, Red()),
                              builder.Repeat(palette.fabric, 0.7, {0.7F, 0.8F, 0.8F}))
                        .Build({-1.3, 1.95, 0.0}, 0.0));
  builder.AddObject(
      MakeTeddyBear(0.4, builder.Repeat(palette.fur, 0.3), builder.Repeat(palette.speckle, 0.3))
          .Build({-1.7, 1.85, 0.42}, 0.2));
  builder.AddObject(MakePottedPlant(1.2, builder.Repeat(palette.speckle, 0.5, Blue()),
                                    builder.Repeat(palette.fur, 0.4, {0.45F, 1.0F, 0.4F}))
                        .Build({0.2, 2.0, 0.0}, 0.0));
  builder.AddShelf(Wall::kBack, 1.6, palette);
}

void FurnishRightWall(SceneBuilder& builder, const Palette& palette) {
  builder.AddTable({2.5, 0.0}, {0.4, 0.75}, kRoomTableHeight, palette);
  const Material lid = builder.Fit(palette.screens.back(), {0.155, 0.002, 0.1});
  const Material keys = builder.Fit(palette.keys, {0.15, 0.06, 0.001});
  builder.AddObject(MakeLaptop(lid, keys, builder.Repeat(palette.speckle, 0.5))
                        .Build({2.45, 0.1, kRoomTableHeight}, -0.5 * pi));
  builder.AddObject(MakeMug(builder.Repeat(palette.speckle, 0.22, Red()))
                        .Build({2.3, 0.45, kRoomTableHeight}, 0.5));
  builder.AddObject(MakeBottle(builder.Repeat(palette.speckle, 0.3, Green()),
                               builder.Repeat(palette.pages.back(), 0.18))
                        .Build({2.6, -0.35, kRoomTableHeight}, 0.0));
  AddBook(builder, palette, 1, Yellow(), {2.4, -0.55, kRoomTableHeight}, 0.3);
  builder.AddObject(
      MakeChair(builder.Repeat(palette.wood, 0.5), builder.Repeat(palette.fabric, 0.5, Blue()))
          .Build({1.75, 0.25, 0.0}, 0.4 * pi));
}

void FurnishFrontWall(SceneBuilder& builder, const Palette& palette) {
  builder.AddTable({-1.0, -2.1}, {0.6, 0.3}, 0.55, palette);
  builder.AddObject(MakeMonitor(builder.Fit(palette.screens.front(), {0.25, 0.004, 0.15}),
                                builder.Repeat(palette.speckle, 0.5, Dark()))
                        .Build({-1.1, -2.1, 0.55}, pi));
  builder.AddObject(MakeSolid("vase", Shape::Superquadric({0.08, 0.08, 0.17}, 0.8, 0.6),
                              builder.Repeat(palette.speckle, 0.25, Yellow()))
                        .Build({-0.6, -2.1, 0.55}, 0.0));
  builder.AddObject(MakeSolid("bed", Shape::Superquadric({0.95, 0.5, 0.25}, 0.2, 0.2),
                              builder.Repeat(palette.fabric, 0.9, {1.2F, 1.1F, 1.0F}))
                        .Build({1.3, -1.9, 0.0}, 0.0));
  builder.AddObject(MakeSolid("clock", Shape::Ellipsoid({0.17, 0.03, 0.17}),
                              builder.Repeat(palette.checker, 0.34, White()))
                        .Build({0.3, -2.47, 1.8}, pi));
}

void FurnishLeftWall(SceneBuilder& builder, const Palette& palette) {
  builder.AddObject(MakeSolid("refrigerator", Shape::Box({0.3, 0.3, 0.85}),
                              builder.Repeat(palette.speckle, 0.9, White()))
                        .Build({-2.65, 1.0, 0.0}, 0.0));
  builder.AddTable({-2.6, -0.3}, {0.35, 0.6}, kRoomTableHeight, palette);
  const Vector3d oven(0.16, 0.22, 0.14);
  builder.AddObject(MakeSolid("microwave", Shape::Box(oven),
                              builder.Repeat(palette.speckle, 0.5, Vector3f::Constant(0.75F)))
                        .Build({-2.65, -0.55, kRoomTableHeight}, 0.0));
  builder.AddObject(MakeSolid("bowl", Shape::Superquadric({0.12, 0.12, 0.05}, 0.6, 1.0),
                              builder.Repeat(palette.checker, 0.3, White()))
                        .Build({-2.5, -0.1, kRoomTableHeight}, 0.0));
  builder.AddObject(MakeSolid("suitcase", Shape::Superquadric({0.24, 0.13, 0.33}, 0.3, 0.3),
                              builder.Repeat(palette.fabric, 0.6, Blue()))
                        .Build({-2.5, -1.5, 0.0}, 0.8));
  builder.AddObject(MakeSolid("sports ball", Shape::Ellipsoid({0.12, 0.12, 0.12}),
                              builder.Repeat(palette.checker, 0.35, Yellow()))
                        .Build({-1.9, 0.6, 0.0}, 0.0));
}

}  // namespace

void FurnishRoom(SceneBuilder& builder) {
  const Palette palette = builder.AddRichPalette();
  builder.AddRoom({.half_x = 3.0, .half_y = 2.5, .height = 2.6}, palette);
  builder.AddPosters(palette);
  FurnishBackWall(builder, palette);
  FurnishRightWall(builder, palette);
  FurnishFrontWall(builder, palette);
  FurnishLeftWall(builder, palette);
  builder.scene().lights = {{.position = {-1.0F, -0.5F, 2.5F}, .strength = 1.9F},
                            {.position = {1.2F, 0.6F, 2.5F}, .strength = 1.7F}};
}

}  // namespace hullslam::synthetic
