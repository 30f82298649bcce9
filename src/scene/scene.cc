// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <algorithm>
#include <array>

namespace hullslam {
namespace {

constexpr std::array<std::string_view, kRelationKinds> kRelationNames = {
    "on", "in", "beside", "in front of", "supports", "part of", "hidden by"};

}  // namespace

std::string_view ToString(RelationKind kind) {
  return kRelationNames.at(static_cast<size_t>(kind));
}

std::optional<RelationKind> ParseRelationKind(std::string_view name) {
  const auto* const found = std::find(kRelationNames.begin(), kRelationNames.end(), name);
  return found == kRelationNames.end()
             ? std::nullopt
             : std::optional(static_cast<RelationKind>(found - kRelationNames.begin()));
}

const SceneObject* Scene::Find(ObjectId id) const {
  const auto found = std::lower_bound(
      objects.begin(), objects.end(), id,
      [](const SceneObject& object, ObjectId wanted) { return object.id < wanted; });
  return found != objects.end() && found->id == id ? &*found : nullptr;
}

}  // namespace hullslam
