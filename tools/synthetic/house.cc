// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/house.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "synthetic/catalogue.h"
#include "synthetic/floor_plan.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kEyeHeight = 1.4;  // metres

const std::array<Doorway, 4> kDoorways = {{{.centre = {-2.0, 0.85}},
                                           {.centre = {2.0, 0.85}},
                                           {.centre = {2.0, -0.85}},
                                           {.centre = {-2.0, -0.85}}}};
// The door between kitchen and bedroom.
const Doorway kSideDoor = {.centre = {0.0, -2.6}};

// A waypoint of the tour: position in metres, angles in degrees, and the least time in seconds.
struct Step {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  double pitch = -14.0;
  double seconds = 0.0;
};

constexpr std::array<Step, 45> kTour = {{
    // The office: from the desk clockwise to the door.
    {-1.2, 2.4, 182.0},
    {-1.3, 2.45, 172.0, -14.0, 2.0},
    {-1.5, 2.3, 110.0},
    {-1.8, 2.2, 50.0},
    {-2.1, 2.2, 0.0, -18.0},
    {-2.05, 1.9, -60.0},
    {-2.0, 1.5, -88.0, -10.0, 1.1},
    // The corridor, to the east.
    {-2.0, 0.7, -85.0, -10.0, 1.6},
    {-1.9, 0.25, -55.0, -14.0, 1.0},
    {-1.5, 0.02, -15.0, -14.0, 1.2},
    {-0.6, 0.0, 5.0},
    {0.6, 0.03, -5.0},
    {1.4, 0.0, 15.0},
    {1.85, 0.2, 60.0},
    // The living room: first to the left, then clockwise to the door.
    {2.0, 0.8, 88.0, -14.0, 1.4},
    {2.0, 1.6, 110.0},
    {1.95, 2.1, 150.0, -18.0},
    {1.85, 2.2, 95.0},
    {1.65, 2.2, 40.0, -14.0, 1.6},
    {1.6, 2.2, 0.0, -18.0},
    {1.75, 2.0, -50.0},
    {1.95, 1.6, -88.0, -10.0},
    // Across the corridor into the kitchen, and through the side door.
    {2.0, 0.8, -90.0, -10.0},
    {2.0, -0.2, -90.0, -10.0},
    {2.0, -1.2, -82.0},
    {1.8, -1.9, -40.0, -18.0},
    {1.6, -2.3, -15.0, -18.0},
    {1.6, -2.5, -80.0, -14.0, 1.9},
    {1.55, -2.55, -135.0, -14.0, 1.6},
    {1.3, -2.6, -175.0},
    // The bedroom: past the bed, then clockwise to the door.
    {0.4, -2.6, -180.0, -12.0},
    {-0.5, -2.6, -178.0},
    {-1.1, -2.5, -162.0, -18.0},
    {-1.6, -2.3, -187.0, -18.0},
    {-1.9, -2.1, -230.0, -14.0, 1.3},
    {-2.0, -1.6, -266.0, -10.0, 1.4},
    // Along the corridor in the same direction as at the beginning, and back to the desk.
    {-2.0, -0.7, -275.0, -10.0, 1.7},
    {-1.95, -0.15, -320.0},
    {-1.75, 0.0, -353.0},
    {-1.7, 0.02, -357.0, -14.0, 0.8},
    {-1.95, 0.12, -300.0, -14.0, 1.7},
    {-2.0, 1.0, -268.0, -14.0, 1.9},
    {-1.65, 1.9, -225.0, -14.0, 1.8},
    {-1.2, 2.4, -178.0},
    {-1.3, 2.45, -188.0, -14.0, 2.0},
}};

void FurnishOffice(const Palette& palette, SceneBuilder& builder) {
  builder.AddTable({-3.1, 2.7}, {0.38, 0.8}, 0.75, palette);
  builder.AddTable({-0.42, 2.4}, {0.3, 0.65}, 0.6, palette);
  builder.AddShelf(Shift(-1.9, 4.09, 0.0), palette);
  const std::vector<Placement> placements = {{"tv", {-3.25, 2.9, 0.75}, 90.0, Dark()},
                                             {"keyboard", {-2.95, 2.9, 0.75}, 92.0},
                                             {"mouse", {-2.93, 2.55, 0.75}, 80.0, Dark()},
                                             {"laptop", {-3.12, 2.2, 0.75}, 75.0},
                                             {"cup", {-2.9, 3.32, 0.75}, 40.0, Red()},
                                             {"book", {-3.2, 3.33, 0.75}, 20.0, Yellow()},
                                             {"chair", {-2.4, 3.1, 0.0}, -100.0, Blue()},
                                             {"potted plant", {-0.5, 3.8, 0.0}, 10.0, White(), 1.0},
                                             {"vase", {-0.4, 2.85, 0.6}, 0.0, Blue()},
                                             {"teddy bear", {-0.4, 2.45, 0.6}, -80.0},
                                             {"orange", {-0.5, 2.1, 0.6}, 0.0, {0.5F, 1.1F, 1.6F}},
                                             {"bottle", {-0.35, 1.9, 0.6}, 0.0, Green()},
                                             {"suitcase", {-0.5, 1.35, 0.0}, 60.0, Blue()},
                                             {"backpack", {-3.2, 1.35, 0.0}, 70.0, Red()},
                                             {"clock", {-0.9, 4.22, 1.85}, 0.0, White()}};
  AddObjects(placements, palette, builder);
}

void FurnishLivingRoom(const Palette& palette, SceneBuilder& builder) {
  builder.AddTable({0.5, 2.6}, {0.34, 0.7}, 0.55, palette);
  builder.AddTable({3.12, 2.55}, {0.32, 0.8}, 0.75, palette);
  const std::vector<Placement> placements = {
      {"couch", {1.8, 3.8, 0.0}, 0.0, Red()},
      {"teddy bear", {1.4, 3.72, 0.42}, 15.0, Vector3f::Ones(), 0.4},
      {"potted plant", {3.1, 3.85, 0.0}, 40.0, Blue(), 1.1},
      {"tv", {0.36, 2.85, 0.55}, 90.0, Dark()},
      {"vase", {0.42, 2.3, 0.55}, 0.0, Yellow()},
      {"book", {0.65, 2.5, 0.55}, 70.0, White()},
      {"cup", {0.66, 2.1, 0.55}, 10.0, Green()},
      {"bowl", {3.1, 2.95, 0.75}, 0.0, White()},
      {"apple", {2.95, 2.65, 0.75}, 0.0, Red()},
      {"bottle", {3.25, 2.5, 0.75}, 30.0, Blue()},
      {"cup", {2.98, 2.2, 0.75}, 200.0, Yellow()},
      {"laptop", {3.15, 1.98, 0.75}, -95.0, Dark()},
      {"sports ball", {3.2, 1.35, 0.0}, 0.0, Yellow()},
      {"chair", {0.45, 3.75, 0.0}, 50.0, Green()},
      {"clock", {3.47, 3.2, 1.8}, -90.0, White()}};
  AddObjects(placements, palette, builder);
}

void FurnishKitchen(const Palette& palette, SceneBuilder& builder) {
  builder.AddTable({3.14, -2.95}, {0.33, 0.9}, 0.85, palette);
  builder.AddTable({1.6, -3.9}, {0.8, 0.32}, 0.85, palette);
  const std::vector<Placement> placements = {
      {"refrigerator", {3.17, -1.45, 0.0}, 0.0, White()},
      {"microwave", {3.22, -2.6, 0.85}, -90.0, Vector3f::Constant(0.75F)},
      {"cup", {3.0, -2.2, 0.85}, 0.0, Blue()},
      {"bowl", {3.1, -3.1, 0.85}, 0.0, Vector3f::Ones()},
      {"apple", {2.95, -3.35, 0.85}, 0.0, Green()},
      {"bottle", {3.3, -3.45, 0.85}, 0.0, Red()},
      {"cup", {1.1, -3.8, 0.85}, 70.0, White()},
      {"vase", {0.92, -4.0, 0.85}, 0.0, Green()},
      {"bottle", {1.45, -4.0, 0.85}, 0.0, Yellow()},
      {"orange", {1.65, -3.75, 0.85}, 0.0, {0.5F, 1.1F, 1.6F}},
      {"book", {2.15, -3.9, 0.85}, 25.0, Blue()},
      {"chair", {0.65, -3.15, 0.0}, 100.0, Red()},
      {"potted plant", {0.5, -3.85, 0.0}, 0.0, Yellow(), 0.9},
      {"clock", {2.65, -4.22, 1.5}, 180.0, Yellow()}};
  AddObjects(placements, palette, builder);
}

void FurnishBedroom(const Palette& palette, SceneBuilder& builder) {
  builder.AddTable({-3.15, -2.1}, {0.32, 0.65}, 0.7, palette);
  builder.AddShelf(Shift(-0.9, -4.09, 0.0) * TurnAboutZ(std::numbers::pi, Vector3d::Zero()),
                   palette);
  const std::vector<Placement> placements = {
      {"bed", {-2.5, -3.7, 0.0}, 0.0, {1.2F, 1.1F, 1.0F}},
      {"teddy bear", {-3.0, -3.75, 0.5}, 60.0, White()},
      {"laptop", {-3.2, -2.0, 0.7}, 90.0, Blue()},
      {"book", {-3.1, -2.45, 0.7}, 100.0, Green()},
      {"cup", {-2.95, -2.6, 0.7}, 30.0, Dark()},
      {"vase", {-3.3, -1.6, 0.7}, 0.0, Red()},
      {"cell phone", {-2.95, -1.7, 0.7}, 40.0},
      {"suitcase", {-0.5, -3.3, 0.0}, 80.0, Red()},
      {"potted plant", {-3.15, -1.2, 0.0}, 0.0, Green(), 0.8},
      {"sports ball", {-1.6, -2.95, 0.0}, 0.0, Red()},
      {"backpack", {-1.2, -3.05, 0.0}, 100.0, Green()}};
  AddObjects(placements, palette, builder);
}

void FurnishCorridor(const Palette& palette, SceneBuilder& builder) {
  builder.AddTable({3.2, 0.0}, {0.25, 0.5}, 0.7, palette);
  const std::vector<Placement> placements = {{"vase", {3.25, 0.3, 0.7}, 0.0, White()},
                                             {"book", {3.15, 0.0, 0.7}, 80.0, Red()},
                                             {"bowl", {3.2, -0.33, 0.7}, 0.0, Blue()},
                                             {"potted plant", {-3.1, 0.35, 0.0}, 0.0, Red(), 0.8},
                                             {"suitcase", {0.1, -0.55, 0.0}, 0.0, Yellow()},
                                             {"backpack", {1.0, 0.55, 0.0}, 0.0, Blue()}};
  AddObjects(placements, palette, builder);
}

}  // namespace

void FurnishHouse(SceneBuilder& builder) {
  const Palette common = builder.AddRichPalette();
  const auto add_room = [&](uint32_t number, const Chamber& chamber, const cv::Scalar& wall_bgr) {
    const Palette palette = builder.AddRoomPalette(common, number, wall_bgr);
    std::vector<Doorway> doorways(kDoorways.begin(), kDoorways.end());
    doorways.push_back(kSideDoor);
    AddChamber(chamber, doorways, palette, builder);
    return palette;
  };
  const Palette corridor = add_room(0, {.min = {-3.5, -0.75}, .max = {3.5, 0.75}}, {176, 190, 196});
  const Palette office = add_room(1, {.min = {-3.5, 0.95}, .max = {-0.1, 4.25}}, {200, 180, 160});
  const Palette living = add_room(2, {.min = {0.1, 0.95}, .max = {3.5, 4.25}}, {150, 190, 210});
  const Palette kitchen = add_room(3, {.min = {0.1, -4.25}, .max = {3.5, -0.95}}, {170, 200, 170});
  const Palette bedroom =
      add_room(4, {.min = {-3.5, -4.25}, .max = {-0.1, -0.95}}, {190, 170, 200});
  FurnishOffice(office, builder);
  FurnishLivingRoom(living, builder);
  FurnishKitchen(kitchen, builder);
  FurnishBedroom(bedroom, builder);
  FurnishCorridor(corridor, builder);
  builder.scene().lights = {{.position = {-1.8F, 2.6F, 2.4F}, .strength = 1.7F},
                            {.position = {1.8F, 2.6F, 2.4F}, .strength = 1.7F},
                            {.position = {1.8F, -2.6F, 2.4F}, .strength = 1.7F},
                            {.position = {-1.8F, -2.6F, 2.4F}, .strength = 1.7F},
                            {.position = {0.0F, 0.0F, 2.4F}, .strength = 1.3F}};
}

WaypointPath HousePath() {
  std::vector<Waypoint> waypoints;
  for (const Step& step : kTour) {
    const double height = kEyeHeight + 0.03 * std::sin(2.0 * step.x + step.y);
    waypoints.push_back({.eye = {step.x, step.y, height},
                         .yaw = step.yaw,
                         .pitch = step.pitch,
                         .seconds = step.seconds});
  }
  return {waypoints, 0.6, 40.0};
}

}  // namespace hullslam::synthetic
