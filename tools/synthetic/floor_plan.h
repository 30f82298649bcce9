// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "synthetic/scene_builder.h"

namespace hullslam::synthetic {

// A rectangular room of a house. The rectangle is the free floor. The walls stand around it and are
// kChamberWall thick, so the walls of two chambers touch if their rectangles are 2 kChamberWall
// apart. Metres.
struct Chamber {
  Eigen::Vector2d min = Eigen::Vector2d::Zero();
  Eigen::Vector2d max = Eigen::Vector2d::Zero();
};
inline constexpr double kChamberWall = 0.1;
inline constexpr double kChamberHeight = 2.5;

// An opening in the walls that pass through `centre`, from the floor to `height`. Metres.
struct Doorway {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double half_width = 0.5;
  double height = 2.1;
};

// Adds the floor, the ceiling and the four walls of the chamber, with openings for the doorways in
// its walls, and posters (if the palette has any) wherever there is room for them.
void AddChamber(const Chamber& chamber, std::span<const Doorway> doorways, const Palette& palette,
                SceneBuilder& builder);

}  // namespace hullslam::synthetic
