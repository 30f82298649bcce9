// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/teddy_room.h"

#include "synthetic/catalogue.h"
#include "synthetic/concave_models.h"

namespace hullslam::synthetic {
namespace {

constexpr double kTeddyTop = 0.5;  // metres

}  // namespace

void FurnishTeddyRoom(SceneBuilder& builder) {
  const Palette rich = builder.AddRichPalette();
  const Palette bare = builder.AddBarePalette();
  builder.AddRoom({.half_x = 3.2, .half_y = 3.0, .height = 2.6}, bare);
  builder.AddTable({0.0, 0.0}, {0.6, 0.45}, kTeddyTop, bare);
  const Material fur = builder.Repeat(rich.fur, 0.45);
  const Material snout = builder.Repeat(rich.speckle, 0.3, {0.8F, 0.95F, 1.1F});
  builder.AddObject(MakeTeddyBear(0.62, fur, snout).Build({0.0, 0.08, kTeddyTop}, -0.5));
  const Material wood = builder.Repeat(rich.wood, 0.5);
  const Material fabric = builder.Repeat(rich.fabric, 0.6, Blue());
  builder.AddObject(MakeTeddyBear(0.26, builder.Repeat(rich.fur, 0.3, White()), snout)
                        .Build({0.42, -0.2, kTeddyTop}, 0.3));
  builder.AddObject(
      MakeOpenMug(builder.Repeat(rich.speckle, 0.2, Red())).Build({-0.35, -0.28, kTeddyTop}, 0.8));
  builder.AddObject(MakeWaistedVase(builder.Repeat(rich.checker, 0.25, Green()))
                        .Build({-0.4, 0.25, kTeddyTop}, 0.0));
  builder.AddObject(MakeBanana(builder.Repeat(bare.speckle, 0.2, {0.3F, 0.95F, 1.1F}))
                        .Build({0.05, -0.33, kTeddyTop}, 0.5));
  builder.AddObject(
      MakeOpenBowl(builder.Repeat(bare.speckle, 0.3, White())).Build({0.4, 0.25, kTeddyTop}, 0.0));
  builder.AddObject(MakeChair(wood, fabric).Build({-0.95, 0.75, 0.0}, 0.6));
  builder.AddObject(MakeBench(wood).Build({1.1, 0.6, 0.0}, -1.1));
  builder.AddObject(MakeCornerCouch(fabric, builder.Repeat(rich.fabric, 0.7, {0.7F, 0.8F, 0.8F}))
                        .Build({-1.4, 1.9, 0.0}, 0.0));
  builder.scene().ambient = 0.65F;
  builder.scene().lights = {{.position = {-1.3F, -1.2F, 2.5F}, .strength = 1.5F},
                            {.position = {1.6F, 1.2F, 2.5F}, .strength = 1.2F}};
}

}  // namespace hullslam::synthetic
