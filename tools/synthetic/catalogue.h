// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string_view>

#include "synthetic/object_models.h"
#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// Tints in the order blue, green, red.
inline Eigen::Vector3f Red() { return {0.35F, 0.35F, 1.1F}; }
inline Eigen::Vector3f Green() { return {0.45F, 0.95F, 0.45F}; }
inline Eigen::Vector3f Blue() { return {1.1F, 0.65F, 0.4F}; }
inline Eigen::Vector3f Yellow() { return {0.35F, 1.0F, 1.15F}; }
inline Eigen::Vector3f Dark() { return {0.28F, 0.28F, 0.28F}; }
inline Eigen::Vector3f White() { return {1.3F, 1.3F, 1.3F}; }

// An object of the catalogue and its place in a scene.
struct Placement {
  std::string_view class_name;
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  // centre of the underside, metres
  double yaw = 0.0;                                // degrees
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();  // colour factor of its main surface
  double height = 0.0;                             // metres; 0 for the usual height of the class
};

// The model of an object of this class, in any frame with z up; the front is at -y. `height`
// matters only for teddy bears and potted plants. Throws CheckError for a class without a model.
ObjectBuilder MakeModel(const Placement& placement, const Palette& palette, SceneBuilder& builder);

// Adds a book that shows the given page. It lies on `base`; `yaw` is in radians.
void AddBook(SceneBuilder& builder, const Palette& palette, size_t page,
             const Eigen::Vector3f& tint, const Eigen::Vector3d& base, double yaw);

// Makes the models of all placements and adds them to the scene, in order.
void AddObjects(std::span<const Placement> placements, const Palette& palette,
                SceneBuilder& builder);

}  // namespace hullslam::synthetic
