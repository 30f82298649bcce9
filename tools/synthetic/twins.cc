// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/twins.h"

#include <array>
#include <vector>

#include "synthetic/catalogue.h"
#include "synthetic/floor_plan.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3f;

constexpr double kEyeAboveFloor = 1.4;           // metres
constexpr double kFirst = -0.5 * kTwinDistance;  // x of the middle of the first room
constexpr double kSecond = 0.5 * kTwinDistance;

// Adds the background of one room, with its middle at x = 0.
void AddTwinRoom(const Palette& palette, SceneBuilder& builder) {
  const std::array<Doorway, 1> doorways = {{{.centre = {0.0, 0.85}}}};
  AddChamber({.min = {-1.7, 0.95}, .max = {1.7, 4.25}}, doorways, palette, builder);
  builder.AddTable({-1.32, 2.7}, {0.35, 0.85}, 0.75, palette);
  builder.AddTable({1.35, 2.3}, {0.3, 0.7}, 0.6, palette);
  builder.AddShelf(Shift(0.2, 4.09, 0.0), palette);
}

// Moves all parts and supports of the background from the indices `parts` and `supports` on by
// kFirst along x, and adds a copy of them that is moved by kSecond.
void Duplicate(size_t parts, size_t supports, Scene& scene) {
  for (size_t i = parts, end = scene.background.size(); i < end; ++i) {
    Part twin = scene.background[i];
    twin.owner_from_part = Shift(kSecond, 0.0, 0.0) * twin.owner_from_part;
    Part& part = scene.background[i];
    part.owner_from_part = Shift(kFirst, 0.0, 0.0) * part.owner_from_part;
    scene.background.push_back(twin);
  }
  for (size_t i = supports, end = scene.supports.size(); i < end; ++i) {
    Support twin = scene.supports[i];
    twin.min.x() += kSecond;
    twin.max.x() += kSecond;
    scene.supports[i].min.x() += kFirst;
    scene.supports[i].max.x() += kFirst;
    scene.supports.push_back(twin);
  }
}

void AddObjectsAt(double x, std::vector<Placement> placements, const Palette& palette,
                  SceneBuilder& builder) {
  for (Placement& placement : placements) {
    placement.base.x() += x;
  }
  AddObjects(placements, palette, builder);
}

void AddFirstObjects(const Palette& palette, SceneBuilder& builder) {
  AddObjectsAt(kFirst,
               {{"tv", {-1.45, 2.9, 0.75}, 90.0, Dark()},
                {"keyboard", {-1.15, 2.9, 0.75}, 92.0},
                {"mouse", {-1.15, 2.55, 0.75}, 80.0, Dark()},
                {"cup", {-1.2, 2.2, 0.75}, 40.0, Red()},
                {"book", {-1.35, 3.3, 0.75}, 20.0, Yellow()},
                {"chair", {-0.65, 3.05, 0.0}, -100.0, Blue()},
                {"potted plant", {1.2, 3.75, 0.0}, 10.0, White(), 1.0},
                {"teddy bear", {1.35, 2.7, 0.6}, -80.0},
                {"vase", {1.4, 2.3, 0.6}, 0.0, Blue()},
                {"bottle", {1.3, 1.9, 0.6}, 0.0, Green()},
                {"suitcase", {1.25, 1.3, 0.0}, 60.0, Blue()},
                {"sports ball", {-1.3, 1.4, 0.0}, 0.0, Yellow()}},
               palette, builder);
}

void AddSecondObjects(const Palette& palette, SceneBuilder& builder) {
  AddObjectsAt(kSecond,
               {{"laptop", {-1.35, 2.35, 0.75}, 85.0},
                {"bowl", {-1.3, 2.8, 0.75}, 0.0, White()},
                {"apple", {-1.15, 3.05, 0.75}, 0.0, Red()},
                {"cup", {-1.2, 3.3, 0.75}, 120.0, Blue()},
                {"vase", {-1.5, 3.1, 0.75}, 0.0, Red()},
                {"chair", {-1.3, 1.45, 0.0}, 100.0, Red()},
                {"suitcase", {1.2, 3.7, 0.0}, 20.0, Yellow()},
                {"tv", {1.45, 2.1, 0.6}, -90.0, Dark()},
                {"book", {1.3, 2.65, 0.6}, 70.0, Green()},
                {"bottle", {1.3, 2.85, 0.6}, 0.0, Red()},
                {"backpack", {1.35, 1.3, 0.0}, -60.0, Red()},
                {"potted plant", {-0.7, 3.8, 0.0}, 0.0, Blue(), 0.8}},
               palette, builder);
}

void AddCorridor(const Palette& palette, SceneBuilder& builder) {
  const std::array<Doorway, 2> doorways = {
      {{.centre = {kFirst, 0.85}}, {.centre = {kSecond, 0.85}}}};
  AddChamber({.min = {-3.9, -0.75}, .max = {3.9, 0.75}}, doorways, palette, builder);
  const std::vector<Placement> placements = {
      {"backpack", {0.2, 0.55, 0.0}, 0.0, Blue()},
      {"potted plant", {3.4, -0.3, 0.0}, 0.0, Red(), 0.8},
      {"suitcase", {-0.6, -0.55, 0.0}, 0.0, Vector3f::Ones()}};
  AddObjects(placements, palette, builder);
}

}  // namespace

void FurnishTwins(SceneBuilder& builder) {
  const Palette common = builder.AddRichPalette();
  const Palette room = builder.AddRoomPalette(common, 0, {200, 180, 160});
  AddTwinRoom(room, builder);
  Duplicate(0, 0, builder.scene());
  const Palette corridor = builder.AddRoomPalette(common, 1, {176, 190, 196});
  AddFirstObjects(room, builder);
  AddSecondObjects(room, builder);
  AddCorridor(corridor, builder);
  const auto first = static_cast<float>(kFirst);
  const auto second = static_cast<float>(kSecond);
  builder.scene().lights = {{.position = {first, 2.6F, 2.4F}, .strength = 1.8F},
                            {.position = {second, 2.6F, 2.4F}, .strength = 1.8F},
                            {.position = {0.0F, 0.0F, 2.4F}, .strength = 1.3F}};
}

WaypointPath TwinsPath() {
  std::vector<Waypoint> waypoints;
  const auto add = [&](double x, double y, double yaw, double pitch = -14.0, double seconds = 0.0) {
    waypoints.push_back(
        {.eye = {x, y, kEyeAboveFloor}, .yaw = yaw, .pitch = pitch, .seconds = seconds});
  };
  const auto look_around = [&](double x) {
    add(x + 0.55, 2.5, 182.0);
    add(x + 0.5, 2.55, 172.0, -16.0, 2.0);
    add(x + 0.4, 2.45, 110.0);
    add(x + 0.1, 2.3, 50.0);
    add(x - 0.2, 2.3, 0.0, -18.0);
    add(x - 0.1, 2.1, -60.0);
  };
  look_around(kFirst);
  add(kFirst, 1.6, -88.0, -10.0);
  add(kFirst, 0.7, -85.0, -10.0);
  add(kFirst + 0.1, 0.25, -55.0);
  add(kFirst + 0.5, 0.02, -15.0);
  add(-0.7, 0.0, 5.0);
  add(0.7, 0.0, -5.0);
  add(kSecond - 0.6, 0.0, 15.0);
  add(kSecond - 0.15, 0.2, 60.0);
  add(kSecond, 0.8, 88.0);
  add(kSecond + 0.2, 1.7, 125.0);
  look_around(kSecond);
  add(kSecond, 1.7, -88.0, -10.0);
  return {waypoints, 0.6, 40.0};
}

}  // namespace hullslam::synthetic
