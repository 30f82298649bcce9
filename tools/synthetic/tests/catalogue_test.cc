// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/catalogue.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

TEST(Catalogue, EveryModelStandsOnItsBase) {
  SceneBuilder builder(1);
  const Palette palette = builder.AddBarePalette();
  for (const char* name :
       {"mouse",  "apple",      "orange",       "bowl",     "vase",         "sports ball",
        "clock",  "suitcase",   "backpack",     "bed",      "refrigerator", "microwave",
        "tv",     "laptop",     "book",         "keyboard", "cell phone",   "cup",
        "bottle", "teddy bear", "potted plant", "chair",    "couch"}) {
    const SceneObject object =
        MakeModel({.class_name = name}, palette, builder).Build({1.0, 2.0, 0.75}, 0.4);
    EXPECT_EQ(object.class_name, name);
    EXPECT_NEAR(object.world_from_object.translation.z() - object.half_extents.z(), 0.75, 1e-9);
    EXPECT_LT(object.half_extents.maxCoeff(), 1.0) << name;
    EXPECT_GE(object.parts.size(), 1U) << name;
  }
  EXPECT_THROW(MakeModel({.class_name = "person"}, palette, builder), CheckError);
}

TEST(Catalogue, BearsAndPlantsHaveTheGivenHeight) {
  SceneBuilder builder(1);
  const Palette palette = builder.AddBarePalette();
  for (const char* name : {"teddy bear", "potted plant"}) {
    const auto height = [&](double asked) {
      return 2.0 * MakeModel({.class_name = name, .height = asked}, palette, builder)
                       .Build(Vector3d::Zero(), 0.0)
                       .half_extents.z();
    };
    EXPECT_NEAR(height(1.0), 2.0 * height(0.5), 1e-9) << name;
    EXPECT_NEAR(height(1.0), 1.0, 0.1) << name;
  }
}

TEST(Catalogue, AddsObjectsInOrderWithTheirPoses) {
  SceneBuilder builder(1);
  const Palette palette = builder.AddBarePalette();
  const std::vector<Placement> placements = {{"cup", {1.0, 2.0, 0.5}, 90.0},
                                             {"bowl", {-1.0, 0.0, 0.0}}};
  AddObjects(placements, palette, builder);
  const Scene scene = builder.Finish();
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[0].class_name, "cup");
  EXPECT_EQ(scene.objects[0].id, 0);
  EXPECT_EQ(scene.objects[1].id, 1);
  EXPECT_NEAR(AngularDistance(scene.objects[0].world_from_object.rotation, {1.0, 0.0, 0.0, 0.0}),
              0.5 * std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace hullslam::synthetic
