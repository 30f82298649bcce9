// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/rearrangement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "synthetic/object_models.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SceneObject MakeBox(const Vector3d& half, const Vector3d& base, double yaw) {
  return MakeSolid("book", Shape::Box(half), {}).Build(base, yaw);
}

TEST(Rearrangement, SmallObjectsMoveAtLeastFifteenCentimetresAndLargeOnesTheirLength) {
  EXPECT_EQ(LeastMove(MakeBox({0.03, 0.05, 0.02}, Vector3d::Zero(), 0.0)), 0.15);
  EXPECT_EQ(LeastMove(MakeBox({0.1, 0.2, 0.45}, Vector3d::Zero(), 0.0)), 0.9);
}

TEST(Rearrangement, BoxesCollideIfTheyComeNearerThanTheGap) {
  const SceneObject box = MakeBox({0.1, 0.1, 0.1}, Vector3d::Zero(), 0.0);
  const auto collides = [&](const Vector3d& base, double yaw, double gap) {
    return Collide(box, MakeBox({0.1, 0.1, 0.1}, base, yaw), gap);
  };
  EXPECT_TRUE(collides({0.19, 0.0, 0.0}, 0.0, 0.0));
  EXPECT_FALSE(collides({0.21, 0.0, 0.0}, 0.0, 0.0));
  EXPECT_TRUE(collides({0.21, 0.0, 0.0}, 0.0, 0.02));
  EXPECT_FALSE(collides({0.0, 0.0, 0.2}, 0.0, 0.02));  // one stands on the other
  // A box that is turned by 45 degrees reaches 0.141 m.
  EXPECT_TRUE(collides({0.23, 0.0, 0.0}, 0.25 * std::numbers::pi, 0.0));
  EXPECT_FALSE(collides({0.25, 0.0, 0.0}, 0.25 * std::numbers::pi, 0.0));
  EXPECT_FALSE(collides({0.19, 0.19, 0.0}, 0.25 * std::numbers::pi, 0.0));  // corner to side
}

bool IsSupported(const Scene& scene, const SceneObject& object) {
  const Vector3d& at = object.world_from_object.translation;
  return std::any_of(scene.supports.begin(), scene.supports.end(), [&](const Support& support) {
    return std::abs(at.z() - object.half_extents.z() - support.height) < 1e-9 &&
           (at.head<2>().array() > support.min.array()).all() &&
           (at.head<2>().array() < support.max.array()).all();
  });
}

void ExpectSamePose(const Rigid3& a, const Rigid3& b) {
  EXPECT_EQ(a.translation, b.translation);
  EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
}

// Checks the rules that hold for every rearranged scene.
void ExpectLaws(const Scene& before, const Scene& after, size_t least) {
  std::map<ObjectStatus, size_t> counts;
  std::set<int> ids;
  for (const SceneObject& object : after.objects) {
    ++counts[object.status];
    EXPECT_TRUE(ids.insert(object.id).second);
    const auto number = static_cast<size_t>(object.id);
    EXPECT_EQ(number >= before.objects.size(), object.status == ObjectStatus::kNew);
    if (object.status != ObjectStatus::kNew) {
      EXPECT_EQ(object.class_name, before.objects[number].class_name);
    }
    if (object.status == ObjectStatus::kUnchanged) {
      ExpectSamePose(object.world_from_object, before.objects[number].world_from_object);
      continue;
    }
    EXPECT_TRUE(IsSupported(after, object)) << object.class_name;
    for (const SceneObject& other : after.objects) {
      EXPECT_FALSE(other.id != object.id && Collide(object, other, 0.01))
          << object.class_name << " " << other.class_name;
    }
    if (object.status == ObjectStatus::kMoved) {
      ExpectSamePose(object.former_world_from_object, before.objects[number].world_from_object);
      const Vector3d move =
          object.world_from_object.translation - object.former_world_from_object.translation;
      EXPECT_GE(move.head<2>().norm(), LeastMove(object));
    }
  }
  for (const SceneObject& object : after.gone) {
    EXPECT_TRUE(ids.insert(object.id).second);
    ExpectSamePose(object.world_from_object,
                   before.objects[static_cast<size_t>(object.id)].world_from_object);
  }
  EXPECT_EQ(ids.size(), before.objects.size() + counts[ObjectStatus::kNew]);
  EXPECT_GE(counts[ObjectStatus::kMoved], least);
  EXPECT_GE(counts[ObjectStatus::kNew], least);
  EXPECT_GE(after.gone.size(), least);
  EXPECT_EQ(before.background.size(), after.background.size());
  EXPECT_EQ(before.textures.size(), after.textures.size());
}

TEST(Rearrangement, KeepsItsRulesInDeskAndRoom) {
  for (const SceneKind kind : {SceneKind::kDesk, SceneKind::kRoom}) {
    SCOPED_TRACE(SceneName(kind));
    ExpectLaws(BuildScene(kind, 100, 1), BuildScene(kind, 100, 1, 1), 2);
  }
}

TEST(Rearrangement, KeepsItsRulesInTheHouseAndStaysOutOfTheWay) {
  const int frames = DefaultFrames(SceneKind::kHouse);
  const Scene before = BuildScene(SceneKind::kHouse, frames, 0);
  const Scene after = BuildScene(SceneKind::kHouse, frames, 0, 1);
  ExpectLaws(before, after, 8);
  for (int i = 0; i < frames; i += 5) {
    const Vector3d eye = after.world_from_cam(i / 30.0).translation;
    for (const SceneObject& object : after.objects) {
      const Vector3d local = Inverse(object.world_from_object) * eye;
      EXPECT_GT((local.cwiseAbs() - object.half_extents).cwiseMax(0.0).norm(), 0.3)
          << object.class_name << " frame " << i;
    }
  }
}

// The bases of all objects, to compare arrangements.
std::vector<double> Bases(const Scene& scene) {
  std::vector<double> bases;
  for (const SceneObject& object : scene.objects) {
    const Vector3d& at = object.world_from_object.translation;
    bases.insert(bases.end(), {static_cast<double>(object.id), at.x(), at.y(), at.z()});
  }
  return bases;
}

TEST(Rearrangement, DependsOnItsSeedAndNotOnTheNumberOfFrames) {
  const std::vector<double> bases = Bases(BuildScene(SceneKind::kDesk, 300, 1, 1));
  EXPECT_EQ(Bases(BuildScene(SceneKind::kDesk, 10, 1, 1)), bases);
  EXPECT_NE(Bases(BuildScene(SceneKind::kDesk, 300, 1, 2)), bases);
}

}  // namespace
}  // namespace hullslam::synthetic
