// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/true_relations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "synthetic/object_models.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {
namespace {

// "book on object 0", "book on support 0", with the class of the subject.
std::vector<std::string> Describe(const Scene& scene) {
  std::vector<std::string> texts;
  for (const TrueRelation& relation : FindTrueRelations(scene)) {
    const std::string other = relation.object ? "object " + std::to_string(*relation.object)
                                              : "support " + std::to_string(*relation.support);
    texts.push_back(scene.objects[static_cast<size_t>(relation.subject)].class_name + " " +
                    relation.relation + " " + other);
  }
  return texts;
}

Scene SceneOf(std::vector<SceneObject> objects) {
  Scene scene;
  scene.supports = {{.min = {-1.0, -1.0}, .max = {1.0, 1.0}, .height = 0.7}};
  scene.objects = std::move(objects);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].id = static_cast<int>(i);
  }
  return scene;
}

SceneObject Box(const std::string& name, const Eigen::Vector3d& half, const Eigen::Vector3d& base,
                double yaw = 0.0) {
  return MakeSolid(name, Shape::Box(half), {}).Build(base, yaw);
}

using Texts = std::vector<std::string>;

TEST(TrueRelations, AStackOfBooks) {
  // The corners of the upper book are not over the lower one.
  EXPECT_EQ(Describe(SceneOf({Box("book", {0.1, 0.13, 0.02}, {0.0, 0.0, 0.7}),
                              Box("book", {0.1, 0.13, 0.02}, {0.0, 0.0, 0.74}, 0.6)})),
            (Texts{"book on support 0", "book on object 0"}));
}

TEST(TrueRelations, BesideIsWithinTheMeanWidth) {
  const Eigen::Vector3d half(0.05, 0.05, 0.05);
  EXPECT_EQ(Describe(SceneOf({Box("cup", half, {0.0, 0.0, 0.7}), Box("cup", half, {0.19, 0.0, 0.7}),
                              Box("cup", half, {0.41, 0.0, 0.7})})),
            (Texts{"cup on support 0", "cup beside object 1", "cup on support 0",
                   "cup beside object 0", "cup on support 0"}));
}

TEST(TrueRelations, WhatIsSurroundedIsInside) {
  ObjectBuilder tray("bowl", "compound");
  tray.Add(Shape::Box({0.2, 0.2, 0.01}), {}, Shift(0.0, 0.0, 0.01));
  for (const double side : {-0.19, 0.19}) {
    tray.Add(Shape::Box({0.01, 0.2, 0.1}), {}, Shift(side, 0.0, 0.1));
    tray.Add(Shape::Box({0.2, 0.01, 0.1}), {}, Shift(0.0, side, 0.1));
  }
  EXPECT_EQ(Describe(SceneOf({tray.Build({0.0, 0.0, 0.7}, 0.0),
                              Box("apple", {0.04, 0.04, 0.04}, {0.0, 0.0, 0.72})})),
            (Texts{"bowl on support 0", "apple in object 0"}));
}

TEST(TrueRelations, WhatFloatsStandsOnNothing) {
  EXPECT_EQ(Describe(SceneOf({Box("clock", {0.1, 0.1, 0.1}, {0.0, 0.0, 0.75})})), Texts());
}

TEST(TrueRelations, OfTheDesk) {
  const Texts texts = Describe(BuildScene(SceneKind::kDesk, 1, 0, std::nullopt));
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "book on object 12"), 1);
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "cup on support 1"), 2);
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "chair on support 0"), 2);
}

}  // namespace
}  // namespace hullslam::synthetic
