// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/object_models.h"

#include <gtest/gtest.h>

#include <numbers>

#include "hullslam/util/check.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

TEST(CocoClassId, KnowsTheClassesOfCoco) {
  EXPECT_EQ(CocoClassId("person"), 0);
  EXPECT_EQ(CocoClassId("cup"), 41);
  EXPECT_EQ(CocoClassId("tv"), 62);
  EXPECT_EQ(CocoClassId("teddy bear"), 77);
  EXPECT_THROW(CocoClassId("teapot"), CheckError);
}

TEST(ObjectBuilder, CentresTheObjectInItsTightBox) {
  ObjectBuilder builder("cup", "compound");
  builder.Add(Shape::Box({0.1, 0.1, 0.1}), {}, Shift(0.0, 0.0, 0.1));
  builder.Add(Shape::Ellipsoid({0.05, 0.02, 0.3}), {}, Shift(0.25, 0.0, 0.3));
  // The object extends from -0.1 to 0.3 in x, from -0.1 to 0.1 in y, and from 0 to 0.6 in z.
  const SceneObject object = builder.Build({1.0, 2.0, 0.5}, 0.0);
  EXPECT_TRUE(object.half_extents.isApprox(Vector3d(0.2, 0.1, 0.3), 1e-9));
  EXPECT_TRUE(object.world_from_object.translation.isApprox(Vector3d(1.0, 2.0, 0.8), 1e-9));
  EXPECT_TRUE(
      object.parts[0].owner_from_part.translation.isApprox(Vector3d(-0.1, 0.0, -0.2), 1e-9));
  EXPECT_EQ(object.class_id, 41);
  EXPECT_FALSE(object.IsDynamic());
}

TEST(ObjectBuilder, RotatesAboutTheVertical) {
  const SceneObject object = MakeSolid("book", Shape::Box({0.2, 0.1, 0.05}), {})
                                 .Build(Vector3d::Zero(), std::numbers::pi / 2.0);
  EXPECT_TRUE((object.world_from_object * Vector3d(0.2, 0.0, 0.0))
                  .isApprox(Vector3d(0.0, 0.2, 0.05), 1e-9));
  EXPECT_EQ(object.shape, "box");
}

TEST(ObjectModels, StandOnTheirBaseAndFillTheirBox) {
  const Material m;
  for (const ObjectBuilder& model :
       {MakeMug(m), MakeBottle(m, m), MakeTeddyBear(0.4, m, m), MakeChair(m, m), MakeMonitor(m, m),
        MakeLaptop(m, m, m), MakePottedPlant(0.4, m, m), MakeCouch(m, m)}) {
    const SceneObject object = model.Build({0.0, 0.0, 1.0}, 0.7);
    double lowest = 100.0;
    Vector3d reach = Vector3d::Zero();
    for (const Part& part : object.parts) {
      for (const Vector3d& vertex : Tessellate(part.shape).vertices) {
        const Vector3d in_object = part.owner_from_part * vertex;
        lowest = std::min(lowest, (object.world_from_object * in_object).z());
        reach = reach.cwiseMax(in_object.cwiseAbs());
      }
    }
    EXPECT_NEAR(lowest, 1.0, 1e-9) << object.class_name;
    EXPECT_TRUE(reach.isApprox(object.half_extents, 1e-9)) << object.class_name;
    EXPECT_EQ(object.shape, "compound");
  }
}

}  // namespace
}  // namespace hullslam::synthetic
