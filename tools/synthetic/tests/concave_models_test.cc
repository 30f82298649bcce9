// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/concave_models.h"

#include <gtest/gtest.h>

#include <vector>

#include "synthetic/tests/concavity.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;

std::vector<SceneObject> AllConcaveModels() {
  const Material m;
  std::vector<SceneObject> objects;
  for (const ObjectBuilder& model :
       {MakeOpenMug(m), MakeOpenBowl(m), MakeWineGlass(m), MakeWaistedVase(m), MakeBanana(m),
        MakeDonut(m), MakeCornerCouch(m, m), MakeBench(m)}) {
    objects.push_back(model.Build({0.5, -0.2, 0.7}, 0.4));
  }
  return objects;
}

TEST(Concavity, IsZeroForConvexObjectsAndLargeForARing) {
  const auto build = [](const Shape& shape) {
    return MakeSolid("vase", shape, {}).Build(Vector3d::Zero(), 0.0);
  };
  EXPECT_EQ(Concavity(build(Shape::Ellipsoid({0.1, 0.2, 0.3}))), 0.0);
  EXPECT_EQ(Concavity(build(Shape::Box({0.1, 0.2, 0.3}))), 0.0);
  EXPECT_GT(Concavity(build(Shape::Torus(0.1, 0.02))), 0.5);
}

TEST(ConcaveModels, AreConcave) {
  for (const SceneObject& object : AllConcaveModels()) {
    EXPECT_GT(Concavity(object), 0.2) << object.class_name;
  }
}

TEST(ConcaveModels, StandOnTheirBaseInTheMiddleOfTheirTightBox) {
  for (const SceneObject& object : AllConcaveModels()) {
    Vector3d reach = Vector3d::Zero();
    double lowest = 10.0;
    for (const Part& part : object.parts) {
      for (const Vector3d& vertex : Tessellate(part.shape).vertices) {
        const Vector3d in_object = part.owner_from_part * vertex;
        reach = reach.cwiseMax(in_object.cwiseAbs());
        lowest = std::min(lowest, (object.world_from_object * in_object).z());
      }
    }
    EXPECT_NEAR(lowest, 0.7, 1e-9) << object.class_name;
    EXPECT_TRUE(reach.isApprox(object.half_extents, 1e-9)) << object.class_name;
    EXPECT_EQ(object.shape, "compound");
  }
}

TEST(ConcaveModels, HaveTheirUsualSizes) {
  const Material m;
  const auto size = [](const ObjectBuilder& model) -> Vector3d {
    return 2.0 * model.Build(Vector3d::Zero(), 0.0).half_extents;
  };
  EXPECT_NEAR(size(MakeOpenMug(m)).z(), 0.1, 1e-9);
  EXPECT_NEAR(size(MakeOpenBowl(m)).x(), 0.24, 1e-9);
  EXPECT_NEAR(size(MakeWineGlass(m)).z(), 0.21, 1e-9);
  EXPECT_NEAR(size(MakeWaistedVase(m)).z(), 0.26, 1e-9);
  EXPECT_NEAR(size(MakeBanana(m)).x(), 0.17, 0.03);
  EXPECT_NEAR(size(MakeDonut(m)).y(), 0.11, 1e-3);
  EXPECT_NEAR(size(MakeCornerCouch(m, m)).x(), 1.5, 1e-9);
  EXPECT_NEAR(size(MakeCornerCouch(m, m)).y(), 1.5, 1e-9);
  EXPECT_NEAR(size(MakeBench(m)).z(), 0.45, 1e-9);
}

// A ray straight down into an open bowl hits its floor and not a lid.
TEST(ConcaveModels, BowlAndMugAreOpen) {
  const Material m;
  for (const ObjectBuilder& model : {MakeOpenBowl(m), MakeOpenMug(m)}) {
    const SceneObject object = model.Build(Vector3d::Zero(), 0.0);
    const Shape& shape = object.parts.front().shape;
    const Vector3d middle = Vector3d::Zero();
    EXPECT_GT(Implicit(shape, middle), 0.0) << object.class_name;
    EXPECT_LT(Implicit(shape, {0.0, 0.0, -shape.half.z() + 0.002}), 0.0) << object.class_name;
  }
}

}  // namespace
}  // namespace hullslam::synthetic
