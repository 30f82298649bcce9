// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/dishes.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "synthetic/tests/concavity.h"

namespace hullslam::synthetic {
namespace {

TEST(FurnishDishes, MostObjectsOnTheTableAreConcave) {
  SceneBuilder builder(1);
  FurnishDishes(builder);
  int concave = 0;
  int all = 0;
  std::set<std::string> classes;
  for (const SceneObject& object : builder.Finish().objects) {
    const double base = object.world_from_object.translation.z() - object.half_extents.z();
    if (base > 0.5) {
      EXPECT_NEAR(base, 0.72, 1e-9) << object.class_name;
      classes.insert(object.class_name);
      ++all;
      concave += Concavity(object) > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GE(all, 12);
  EXPECT_GE(concave, 10);
  EXPECT_TRUE(classes.contains("bowl") && classes.contains("cup") &&
              classes.contains("wine glass"));
}

}  // namespace
}  // namespace hullslam::synthetic
