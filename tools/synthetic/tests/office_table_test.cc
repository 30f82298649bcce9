// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/office_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hullslam::synthetic {
namespace {

TEST(FurnishOfficeTable, ManyObjectsStandOnTheTable) {
  SceneBuilder builder(1);
  const Palette palette = FurnishOfficeTable(builder);
  const Scene scene = builder.Finish();
  EXPECT_LT(static_cast<size_t>(palette.fabric), scene.textures.size());
  int on_table = 0;
  for (const SceneObject& object : scene.objects) {
    const Eigen::Vector3d& at = object.world_from_object.translation;
    if (std::abs(at.z() - object.half_extents.z() - 0.74) < 1e-9) {
      EXPECT_LT(std::abs(at.x()), 0.85) << object.class_name;
      EXPECT_LT(std::abs(at.y()), 0.45) << object.class_name;
      ++on_table;
    }
  }
  EXPECT_GE(on_table, 12);
}

}  // namespace
}  // namespace hullslam::synthetic
