// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// An interval along a wall, in metres from its middle to the right as seen from inside.
struct Interval {
  double left = 0.0;
  double right = 0.0;
};

// One of the four sides of a chamber.
struct Side {
  Rigid3 world_from_side;  // x to the right as seen from inside, y out of the chamber, z up
  double half_length = 0.0;
  std::vector<Doorway>
      doorways;  // the doorways in this side; `centre.x()` is the position along it
};

Side MakeSide(const Chamber& chamber, int index, std::span<const Doorway> doorways) {
  const Vector2d half = 0.5 * (chamber.max - chamber.min);
  const Vector2d middle = 0.5 * (chamber.max + chamber.min);
  const bool across = index % 2 == 0;
  const Rigid3 turn =
      TurnAboutZ(-0.5 * std::numbers::pi * index, Vector3d(middle.x(), middle.y(), 0.0));
  Side side{turn * Shift(0.0, across ? half.y() : half.x(), 0.0), across ? half.x() : half.y(), {}};
  const Rigid3 side_from_world = Inverse(side.world_from_side);
  for (const Doorway& doorway : doorways) {
    const Vector3d at = side_from_world * Vector3d(doorway.centre.x(), doorway.centre.y(), 0.0);
    if (std::abs(at.y()) < 1.5 * kChamberWall && std::abs(at.x()) < side.half_length) {
      side.doorways.push_back(doorway);
      side.doorways.back().centre = at.head<2>();
    }
  }
  std::sort(side.doorways.begin(), side.doorways.end(),
            [](const Doorway& a, const Doorway& b) { return a.centre.x() < b.centre.x(); });
  return side;
}

// The intervals of the side between its doorways. They keep a distance of `margin` from each
// doorway. The first and the last one reach `end` beyond the ends of the side.
std::vector<Interval> SolidIntervals(const Side& side, double margin, double end) {
  std::vector<Interval> solid;
  double left = -side.half_length - end;
  for (const Doorway& doorway : side.doorways) {
    solid.push_back({left, doorway.centre.x() - doorway.half_width - margin});
    left = doorway.centre.x() + doorway.half_width + margin;
  }
  solid.push_back({left, side.half_length + end});
  return solid;
}

// Adds a piece of the wall between the heights `low` and `high`.
void AddPiece(const Side& side, const Interval& along, double low, double high,
              const Palette& palette, SceneBuilder& builder) {
  const double half_length = 0.5 * (along.right - along.left);
  const double half_height = 0.5 * (high - low);
  builder.AddBackground(Shape::Box({half_length, 0.5 * kChamberWall, half_height}),
                        builder.Repeat(palette.wall, 3.0),
                        side.world_from_side *
                            Shift(along.left + half_length, 0.5 * kChamberWall, low + half_height));
}

void AddWall(const Side& side, const Palette& palette, SceneBuilder& builder) {
  // The walls reach around the corners, and into floor and ceiling, so that no gap is left.
  for (const Interval& solid : SolidIntervals(side, 0.0, kChamberWall)) {
    AddPiece(side, solid, -0.05, kChamberHeight + 0.05, palette, builder);
  }
  for (const Interval& solid : SolidIntervals(side, 0.0, 0.0)) {
    const double half_length = 0.5 * (solid.right - solid.left);
    builder.AddBackground(Shape::Box({half_length, 0.01, 0.05}), builder.Repeat(palette.wood, 1.0),
                          side.world_from_side * Shift(solid.left + half_length, -0.01, 0.05));
  }
  for (const Doorway& doorway : side.doorways) {
    AddPiece(side,
             {doorway.centre.x() - doorway.half_width, doorway.centre.x() + doorway.half_width},
             doorway.height, kChamberHeight + 0.05, palette, builder);
  }
}

void AddPosters(const Side& side, const Palette& palette, size_t& next, SceneBuilder& builder) {
  if (palette.posters.empty()) {
    return;
  }
  RandomStream& random = builder.random();
  for (const Interval& solid : SolidIntervals(side, 0.12, -0.15)) {
    double left = solid.left + random.Uniform(0.0, 0.2);
    while (true) {
      const double half_width = random.Uniform(0.2, 0.38);
      const double half_height = half_width * random.Uniform(0.8, 1.4);
      if (left + 2.0 * half_width > solid.right) {
        break;
      }
      const Vector3d half(half_width, 0.008, half_height);
      builder.AddBackground(
          Shape::Box(half), builder.Fit(palette.posters[next++ % palette.posters.size()], half),
          side.world_from_side * Shift(left + half_width, -0.008, random.Uniform(1.3, 1.75)));
      left += 2.0 * half_width + random.Uniform(0.2, 0.9);
    }
  }
}

}  // namespace

void AddChamber(const Chamber& chamber, std::span<const Doorway> doorways, const Palette& palette,
                SceneBuilder& builder) {
  const Vector2d half = 0.5 * (chamber.max - chamber.min);
  const Vector2d middle = 0.5 * (chamber.max + chamber.min);
  const Shape slab = Shape::Box({half.x() + kChamberWall, half.y() + kChamberWall, 0.1});
  builder.AddBackground(slab, builder.Repeat(palette.floor, 2.0),
                        Shift(middle.x(), middle.y(), -0.1));
  builder.AddBackground(slab, builder.Repeat(palette.ceiling, 2.5),
                        Shift(middle.x(), middle.y(), kChamberHeight + 0.1));
  builder.scene().supports.push_back({.min = chamber.min, .max = chamber.max});
  size_t next_poster = 0;
  for (int index = 0; index < 4; ++index) {
    const Side side = MakeSide(chamber, index, doorways);
    AddWall(side, palette, builder);
    AddPosters(side, palette, next_poster, builder);
  }
}

}  // namespace hullslam::synthetic
