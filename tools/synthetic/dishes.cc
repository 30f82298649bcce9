// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/dishes.h"

#include <vector>

#include "synthetic/catalogue.h"
#include "synthetic/concave_models.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kDishesTop = 0.72;  // metres

Vector3d OnTop(double x, double y) { return {x, y, kDishesTop}; }

// A printed mat, part of the table.
void AddMat(SceneBuilder& builder, const Palette& palette, size_t poster, const Vector2d& centre) {
  const Vector3d half(0.19, 0.14, 0.0015);
  builder.AddBackground(Shape::Box(half), builder.Fit(palette.posters[poster], half),
                        Shift(centre.x(), centre.y(), kDishesTop + half.z()));
}

void AddHollowDishes(SceneBuilder& builder, const Palette& bare, const Palette& rich) {
  const auto glaze = [&](const Vector3f& tint) { return builder.Repeat(bare.speckle, 0.3, tint); };
  const auto painted = [&](const Vector3f& tint) {
    return builder.Repeat(rich.speckle, 0.25, tint);
  };
  builder.AddObject(MakeOpenBowl(glaze(White())).Build(OnTop(-0.32, -0.2), 0.0));
  builder.AddObject(MakeOpenBowl(painted(Blue())).Build(OnTop(0.06, 0.2), 0.0));
  builder.AddObject(MakeOpenMug(glaze(Red())).Build(OnTop(0.3, -0.24), -0.5));
  builder.AddObject(MakeOpenMug(glaze(White())).Build(OnTop(-0.08, -0.1), 2.2));
  builder.AddObject(MakeOpenMug(painted(Yellow())).Build(OnTop(-0.5, 0.05), 0.9));
  builder.AddObject(MakeWineGlass(glaze({1.2F, 1.15F, 1.1F})).Build(OnTop(0.42, 0.08), 0.0));
  builder.AddObject(MakeWineGlass(glaze({1.1F, 1.15F, 1.2F})).Build(OnTop(-0.25, 0.24), 0.0));
  builder.AddObject(MakeWaistedVase(painted(Green())).Build(OnTop(0.22, 0.02), 0.0));
  const Material peel = builder.Repeat(bare.speckle, 0.2, {0.3F, 0.95F, 1.1F});
  builder.AddObject(MakeBanana(peel).Build(OnTop(0.06, -0.28), 0.4));
  builder.AddObject(MakeDonut(builder.Repeat(rich.fur, 0.15)).Build(OnTop(0.5, -0.1), 0.0));
}

}  // namespace

void FurnishDishes(SceneBuilder& builder) {
  const Palette rich = builder.AddRichPalette();
  const Palette bare = builder.AddBarePalette();
  Palette palette = rich;
  palette.wall = palette.feature_wall = bare.wall;
  palette.ceiling = bare.ceiling;
  palette.table = bare.table;
  builder.AddRoom({.half_x = 3.0, .half_y = 2.8, .height = 2.6}, palette);
  builder.AddPanel(Wall::kBack, -0.9, 1.5, 0.35, 0.3, builder.Fit(rich.posters[0], {0.35, 1, 0.3}));
  builder.AddPanel(Wall::kRight, 0.4, 1.5, 0.3, 0.4, builder.Fit(rich.posters[1], {0.3, 1, 0.4}));
  builder.AddTable({0.0, 0.0}, {0.65, 0.42}, kDishesTop, palette);
  AddMat(builder, rich, 2, {-0.32, -0.2});
  AddMat(builder, rich, 3, {0.32, -0.22});
  AddHollowDishes(builder, bare, rich);
  const std::vector<Placement> placements = {
      {"bottle", OnTop(-0.05, 0.02), 20.0, Green()},
      {"apple", OnTop(0.36, 0.27), 0.0, Red()},
      {"orange", OnTop(-0.42, 0.28), 0.0, {0.5F, 1.1F, 1.6F}},
      {"chair", {0.35, 0.95, 0.0}, -10.0, Blue()},
      {"chair", {-1.05, -0.1, 0.0}, 95.0, Red()},
      {"refrigerator", {2.6, 2.3, 0.0}, 0.0, White()}};
  AddObjects(placements, palette, builder);
  builder.scene().ambient = 0.6F;
  builder.scene().lights = {{.position = {-1.0F, -1.0F, 2.5F}, .strength = 1.7F},
                            {.position = {1.4F, 1.0F, 2.5F}, .strength = 1.4F}};
}

}  // namespace hullslam::synthetic
