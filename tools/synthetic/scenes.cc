// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/util/error.h"
#include "synthetic/camera_path.h"
#include "synthetic/catalogue.h"
#include "synthetic/house.h"
#include "synthetic/pushed_board.h"
#include "synthetic/rearrangement.h"
#include "synthetic/road.h"
#include "synthetic/room.h"
#include "synthetic/scene_builder.h"
#include "synthetic/twins.h"
#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::array<std::pair<std::string_view, SceneKind>, 11> kSceneNames = {
    {{"desk", SceneKind::kDesk},
     {"room", SceneKind::kRoom},
     {"lowtexture", SceneKind::kLowTexture},
     {"dynamic", SceneKind::kDynamic},
     {"house", SceneKind::kHouse},
     {"twins", SceneKind::kTwins},
     {"rotation", SceneKind::kRotation},
     {"wall", SceneKind::kWall},
     {"turns", SceneKind::kTurns},
     {"pushed", SceneKind::kPushed},
     {"road", SceneKind::kRoad}}};
constexpr double kTableHeight = 0.75;
constexpr int kHouseFrames = 1800;
constexpr int kTwinsFrames = 930;
constexpr int kRoadFrames = 150;
constexpr double kPi = std::numbers::pi;

Vector3d OnTable(double x, double y) { return {x, y, kTableHeight}; }

void AddComputer(SceneBuilder& builder, const Palette& palette) {
  const Material body = builder.Repeat(palette.speckle, 0.5, Dark());
  const Material screen = builder.Fit(palette.screens.front(), {0.25, 0.004, 0.15});
  builder.AddObject(MakeMonitor(screen, body).Build(OnTable(0.02, 0.2), 0.05));
  const Material lid = builder.Fit(palette.screens.back(), {0.155, 0.002, 0.1});
  const Material laptop_keys = builder.Fit(palette.keys, {0.15, 0.06, 0.001});
  const Material metal = builder.Repeat(palette.speckle, 0.5, Vector3f::Constant(0.8F));
  builder.AddObject(MakeLaptop(lid, laptop_keys, metal).Build(OnTable(-0.5, 0.06), 0.4));
  const Vector3d keyboard(0.21, 0.07, 0.012);
  builder.AddObject(MakeSolid("keyboard", Shape::Box(keyboard), builder.Fit(palette.keys, keyboard))
                        .Build(OnTable(-0.02, -0.13), -0.08));
  builder.AddObject(MakeSolid("mouse", Shape::Ellipsoid({0.032, 0.055, 0.02}),
                              builder.Repeat(palette.speckle, 0.2, Dark()))
                        .Build(OnTable(0.28, -0.12), 0.2));
  const Vector3d phone(0.037, 0.075, 0.005);
  builder.AddObject(
      MakeSolid("cell phone", Shape::Box(phone), builder.Fit(palette.screens.back(), phone))
          .Build(OnTable(0.42, -0.3), 0.6));
}

void AddTableware(SceneBuilder& builder, const Palette& palette) {
  builder.AddObject(
      MakeMug(builder.Repeat(palette.speckle, 0.22, Red())).Build(OnTable(0.36, 0.06), -0.7));
  builder.AddObject(MakeMug(builder.Repeat(palette.checker, 0.2, Vector3f::Ones()))
                        .Build(OnTable(-0.3, -0.31), 2.4));
  const Material glass = builder.Repeat(palette.speckle, 0.3, Green());
  builder.AddObject(
      MakeBottle(glass, builder.Repeat(palette.pages.back(), 0.18)).Build(OnTable(0.42, 0.3), 0.3));
  builder.AddObject(MakeSolid("apple", Shape::Ellipsoid({0.038, 0.038, 0.036}),
                              builder.Repeat(palette.fur, 0.15, Red()))
                        .Build(OnTable(-0.04, -0.34), 0.0));
  builder.AddObject(MakeSolid("orange", Shape::Ellipsoid({0.041, 0.041, 0.04}),
                              builder.Repeat(palette.fur, 0.15, {0.5F, 1.1F, 1.6F}))
                        .Build(OnTable(0.12, -0.31), 0.4));
  builder.AddObject(MakeSolid("bowl", Shape::Superquadric({0.1, 0.1, 0.035}, 0.6, 1.0),
                              builder.Repeat(palette.checker, 0.3, White()))
                        .Build(OnTable(0.66, -0.33), 0.0));
  builder.AddObject(MakeSolid("vase", Shape::Superquadric({0.06, 0.06, 0.13}, 0.8, 0.6),
                              builder.Repeat(palette.speckle, 0.25, Blue()))
                        .Build(OnTable(-0.33, 0.33), 0.3));
}

void AddToys(SceneBuilder& builder, const Palette& palette) {
  AddBook(builder, palette, 0, Blue(), OnTable(0.62, -0.06), 0.5);
  AddBook(builder, palette, 1, Yellow(), OnTable(0.62, -0.06) + Vector3d(0.0, 0.0, 0.028), 0.2);
  AddBook(builder, palette, 2, White(), OnTable(-0.5, -0.3), -0.5);
  builder.AddObject(MakeTeddyBear(0.34, builder.Repeat(palette.fur, 0.3),
                                  builder.Repeat(palette.speckle, 0.3, {0.8F, 0.95F, 1.1F}))
                        .Build(OnTable(0.66, 0.22), -0.35));
  builder.AddObject(MakeSolid("sports ball", Shape::Ellipsoid({0.11, 0.11, 0.11}),
                              builder.Repeat(palette.checker, 0.35, Yellow()))
                        .Build(OnTable(-0.68, 0.32), 0.0));
  builder.AddObject(MakePottedPlant(0.36, builder.Repeat(palette.speckle, 0.3, Red()),
                                    builder.Repeat(palette.fur, 0.2, {0.5F, 1.1F, 0.35F}))
                        .Build(OnTable(-0.7, -0.3), 0.0));
}

void AddClockAndLuggage(SceneBuilder& builder, const Palette& palette, const RoomSize& room) {
  builder.AddObject(MakeSolid("clock", Shape::Ellipsoid({0.17, 0.03, 0.17}),
                              builder.Repeat(palette.checker, 0.34, White()))
                        .Build({0.35, room.half_y - 0.03, 2.05}, 0.0));
  builder.AddObject(MakeSolid("suitcase", Shape::Superquadric({0.24, 0.13, 0.33}, 0.3, 0.3),
                              builder.Repeat(palette.fabric, 0.6, Blue()))
                        .Build({1.75, 1.3, 0.0}, 0.4));
  builder.AddObject(MakePottedPlant(1.1, builder.Repeat(palette.speckle, 0.5, White()),
                                    builder.Repeat(palette.fur, 0.4, {0.45F, 1.0F, 0.4F}))
                        .Build({-room.half_x + 0.6, room.half_y - 0.6, 0.0}, 0.0));
}

void AddChairs(SceneBuilder& builder, const Palette& palette) {
  const auto chair = [&](const Vector3f& tint) {
    return MakeChair(builder.Repeat(palette.wood, 0.5), builder.Repeat(palette.fabric, 0.5, tint));
  };
  builder.AddObject(chair(Red()).Build({0.45, 0.75, 0.0}, -0.15));
  builder.AddObject(chair(Blue()).Build({-0.3, 0.78, 0.0}, 0.2));
}

void AddDeskLights(SceneBuilder& builder) {
  builder.scene().ambient = 0.55F;
  builder.scene().lights = {{.position = {-1.2F, -1.0F, 2.5F}, .strength = 1.9F},
                            {.position = {1.8F, 1.2F, 2.4F}, .strength = 1.4F}};
}

void FurnishDesk(SceneBuilder& builder, const Palette& palette, const RoomSize& room) {
  builder.AddRoom(room, palette);
  builder.AddTable({0.0, 0.0}, {0.82, 0.46}, kTableHeight, palette);
  AddComputer(builder, palette);
  AddTableware(builder, palette);
  AddToys(builder, palette);
  AddChairs(builder, palette);
  AddClockAndLuggage(builder, palette, room);
  AddDeskLights(builder);
}

OrbitPath DeskPath() { return {.target = {0.0, 0.0, kTableHeight + 0.12}}; }

// A loop of fewer than 300 frames is cut off instead of run faster, because a hand cannot turn
// faster.
LoopPath RoomPath(int frames) { return {.duration = std::max(frames - 1, 299) / kFramesPerSecond}; }

// The whole walk in the given number of frames. A walk of fewer frames than the usual number is cut
// off instead of run faster.
PacedPath FitWalk(const WaypointPath& path, int frames, SceneKind kind) {
  const double seconds = (std::max(frames, DefaultFrames(kind)) - 1) / kFramesPerSecond;
  return {path, seconds};
}

void FurnishDeskRoom(SceneBuilder& builder, const Palette& palette) {
  FurnishDesk(builder, palette, {.half_x = 2.9, .half_y = 2.6, .height = 2.6});
  builder.AddPosters(palette);
  builder.AddShelf(Wall::kBack, -1.1, palette);
}

Scene BuildDesk(uint64_t seed, uint64_t visit) {
  SceneBuilder builder(HashSeed(seed, 0, "desk"));
  const Palette palette = builder.AddRichPalette();
  FurnishDeskRoom(builder, palette);
  builder.scene().world_from_cam = ByHand(DeskPath(), visit);
  return builder.Finish();
}

// Gives all surfaces nearly the same brightness in flat daylight. Then objects differ mostly in
// hue, and most corner detectors find nothing along the weak edges.
void EvenOutBrightness(Scene& scene, RandomStream& random) {
  const auto even_out = [&](Part& part) {
    const Texture& texture = scene.textures[static_cast<size_t>(part.material.texture)];
    const Vector3f mean = texture.Sample({0.5F, 0.5F}, texture.LevelOfDetail(1.0F));
    const Vector3f colour = mean.cwiseProduct(part.material.tint);
    const float grey = colour.dot(Vector3f(0.114F, 0.587F, 0.299F));
    const Vector3f hue = 0.5F * colour / grey + Vector3f::Constant(0.5F);
    const auto brightness = static_cast<float>(random.Uniform(142.0, 166.0));
    part.material.tint = brightness * hue.cwiseQuotient(mean);
  };
  std::for_each(scene.background.begin(), scene.background.end(), even_out);
  for (SceneObject& object : scene.objects) {
    std::for_each(object.parts.begin(), object.parts.end(), even_out);
  }
  scene.ambient = 0.8F;
  for (PointLight& light : scene.lights) {
    light.strength *= 0.35F;
  }
}

Scene BuildLowTexture(uint64_t seed) {
  SceneBuilder builder(HashSeed(seed, 0, "lowtexture"));
  const Palette palette = builder.AddBarePalette();
  const RoomSize room{.half_x = 2.9, .half_y = 2.6, .height = 2.6};
  FurnishDesk(builder, palette, room);
  EvenOutBrightness(builder.scene(), builder.random());
  builder.scene().world_from_cam = ByHand(DeskPath(), seed);
  return builder.Finish();
}

// The pose of a person who walks back and forth between the circle of the camera and the table,
// always facing along the path.
Rigid3 WalkerPose(const OrbitPath& orbit, double half_height, double time) {
  constexpr double kSwing = 0.95;   // radians to either side of the camera
  constexpr double kPeriod = 11.0;  // seconds
  const double phase = 2.0 * kPi * time / kPeriod + 0.5 * kPi;
  const double angle = orbit.start_angle + orbit.angular_speed * time + kSwing * std::sin(phase);
  const double bob = 0.012 * (1.0 - std::cos(2.0 * kPi * 1.8 * time));
  return TurnAboutZ(angle + 0.5 * kPi,
                    {1.12 * std::cos(angle), 1.12 * std::sin(angle), half_height + bob});
}

Scene BuildDynamic(uint64_t seed) {
  SceneBuilder builder(HashSeed(seed, 0, "dynamic"));
  const Palette palette = builder.AddRichPalette();
  const RoomSize room{.half_x = 3.4, .half_y = 3.2, .height = 2.6};
  FurnishDesk(builder, palette, room);
  builder.AddPosters(palette);
  builder.AddShelf(Wall::kBack, -1.1, palette);
  const OrbitPath orbit{
      .radius = 2.0, .height = 1.4, .angular_speed = 0.12, .target = {0.0, 0.0, 0.95}};
  const Vector3d half(0.25, 0.15, 0.87);
  SceneObject walker = MakeSolid("person", Shape::Box(half),
                                 builder.Repeat(palette.fabric, 0.55, {0.9F, 0.8F, 1.2F}))
                           .Build(Vector3d::Zero(), 0.0);
  walker.motion = [orbit, half](double time) { return WalkerPose(orbit, half.z(), time); };
  walker.world_from_object = walker.motion(0.0);
  builder.AddObject(std::move(walker));
  builder.scene().world_from_cam = ByHand(orbit, seed);
  return builder.Finish();
}

Scene BuildRoom(int frames, uint64_t seed, uint64_t visit) {
  SceneBuilder builder(HashSeed(seed, 0, "room"));
  FurnishRoom(builder);
  builder.scene().world_from_cam = ByHand(RoomPath(frames), visit);
  return builder.Finish();
}

Scene BuildHouse(int frames, uint64_t seed, uint64_t visit) {
  SceneBuilder builder(HashSeed(seed, 0, "house"));
  FurnishHouse(builder);
  builder.scene().world_from_cam = ByHand(FitWalk(HousePath(), frames, SceneKind::kHouse), visit);
  return builder.Finish();
}

// The room of the desk, seen by a camera that only rotates. So there is no parallax between its
// images.
Scene BuildRotation(uint64_t seed) {
  Scene scene = BuildDesk(seed, seed);
  RandomStream random(HashSeed(seed, 0, "rotation"));
  const Vector3d eye(random.Uniform(-1.6, -1.2), random.Uniform(-1.4, -1.0), 1.4);
  const double start = random.Uniform(0.0, 2.0 * kPi);
  const double speed = random.Uniform(0.15, 0.5) * (random.Uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0);
  scene.world_from_cam = [=](double time) {
    const double yaw = start + speed * time;
    const double pitch = -0.2 + 0.15 * std::sin(0.9 * time);
    return LookAt(eye, eye + Vector3d(std::cos(yaw), std::sin(yaw), std::tan(pitch)));
  };
  return scene;
}

// The scene of the desk, seen by a camera that a hand turns fast in all directions.
Scene BuildTurns(uint64_t seed) {
  Scene scene = BuildDesk(seed, seed);
  const HandTurns turns(HashSeed(seed, 0, "turns"));
  scene.world_from_cam = [steady = std::move(scene.world_from_cam), turns](double time) {
    return turns.Apply(steady(time), time);
  };
  return scene;
}

// The scene of the desk, over which somebody pushes a board. The hand that holds the camera moves
// in another way than in the desk of the same seed, so the two are two visits of one room.
Scene BuildPushed(uint64_t seed) {
  SceneBuilder builder(HashSeed(seed, 0, "desk"));
  const Palette palette = builder.AddRichPalette();
  FurnishDeskRoom(builder, palette);
  SceneObject board = MakePushedBoard(builder.Fit(palette.pages.front(), {0.125, 0.004, 0.1}),
                                      builder.Repeat(palette.speckle, 0.3, {0.7F, 0.85F, 1.1F}))
                          .Build(Vector3d::Zero(), 0.0);
  PushedPath path;
  for (const double x : {-0.45, -0.2, 0.05, 0.3, 0.5}) {
    path.places.push_back(OnTable(x, -0.25) + Vector3d(0.0, 0.0, 0.15 + board.half_extents.z()));
  }
  board.motion = [path](double time) { return path.WorldFromThing(time); };
  board.world_from_object = board.motion(0.0);
  builder.AddObject(std::move(board));
  builder.scene().world_from_cam = ByHand(DeskPath(), HashSeed(seed, 0, "pushed"));
  return builder.Finish();
}

// A wall with posters, seen head on from so near that nothing else is in the image.
Scene BuildWall(uint64_t seed) {
  SceneBuilder builder(HashSeed(seed, 0, "wall"));
  const Palette palette = builder.AddRichPalette();
  builder.AddRoom({.half_x = 2.9, .half_y = 2.6, .height = 2.6}, palette);
  builder.AddPosters(palette);
  const double phase = builder.random().Uniform(0.0, 2.0 * kPi);
  struct Path {
    double phase;
    Rigid3 WorldFromCam(double time) const {
      const Vector3d eye(0.7 * std::sin(0.5 * time + phase), 1.3 + 0.1 * std::sin(0.8 * time),
                         1.3 + 0.1 * std::sin(0.6 * time + phase));
      return LookAt(eye, eye + Vector3d::UnitY());
    }
  };
  builder.scene().world_from_cam = ByHand(Path{phase}, seed);
  return builder.Finish();
}

Scene BuildTwins(int frames, uint64_t seed) {
  SceneBuilder builder(HashSeed(seed, 0, "twins"));
  FurnishTwins(builder);
  builder.scene().world_from_cam = ByHand(FitWalk(TwinsPath(), frames, SceneKind::kTwins), seed);
  return builder.Finish();
}

Scene BuildRoad(uint64_t seed) {
  SceneBuilder builder(HashSeed(seed, 0, "road"));
  FurnishRoad(builder);
  const RoadPath path{.phase = builder.random().Uniform(0.0, 2.0 * kPi)};
  builder.scene().world_from_cam = [path](double time) { return path.WorldFromCam(time); };
  return builder.Finish();
}

Scene BuildVisit(SceneKind kind, int frames, uint64_t seed, uint64_t visit) {
  switch (kind) {
    case SceneKind::kDesk:
      return BuildDesk(seed, visit);
    case SceneKind::kRoom:
      return BuildRoom(frames, seed, visit);
    case SceneKind::kLowTexture:
      return BuildLowTexture(seed);
    case SceneKind::kDynamic:
      return BuildDynamic(seed);
    case SceneKind::kHouse:
      return BuildHouse(frames, seed, visit);
    case SceneKind::kTwins:
      return BuildTwins(frames, seed);
    case SceneKind::kRotation:
      return BuildRotation(seed);
    case SceneKind::kWall:
      return BuildWall(seed);
    case SceneKind::kTurns:
      return BuildTurns(seed);
    case SceneKind::kPushed:
      return BuildPushed(seed);
    case SceneKind::kRoad:
      return BuildRoad(seed);
  }
  throw InputError("unknown scene");
}

template <typename Path>
std::vector<Rigid3> SampleViews(const Path& path, double duration) {
  std::vector<Rigid3> views;
  for (double time = 0.0; time <= duration; time += 0.2) {
    views.push_back(path.WorldFromCam(time));
  }
  return views;
}

// Poses of the camera along its path, five per second, without the shaking of the hand.
std::vector<Rigid3> SteadyViews(SceneKind kind) {
  const double duration = (DefaultFrames(kind) - 1) / kFramesPerSecond;
  switch (kind) {
    case SceneKind::kDesk:
      return SampleViews(DeskPath(), duration);
    case SceneKind::kRoom:
      return SampleViews(RoomPath(DefaultFrames(kind)), duration);
    case SceneKind::kHouse:
      return SampleViews(FitWalk(HousePath(), 0, kind), duration);
    default:
      throw InputError("only the scenes desk, room and house can be rearranged, not " +
                       std::string(SceneName(kind)));
  }
}

}  // namespace

SceneKind ParseSceneKind(std::string_view name) {
  std::string expected;
  for (const auto& [known, kind] : kSceneNames) {
    if (known == name) {
      return kind;
    }
    expected += (expected.empty() ? "" : ", ") + std::string(known);
  }
  throw InputError("unknown scene '" + std::string(name) + "': expected one of " + expected);
}

std::string_view SceneName(SceneKind kind) { return kSceneNames[static_cast<size_t>(kind)].first; }

int DefaultFrames(SceneKind kind) {
  switch (kind) {
    case SceneKind::kRoom:
      return 600;
    case SceneKind::kHouse:
      return kHouseFrames;
    case SceneKind::kTwins:
      return kTwinsFrames;
    case SceneKind::kRoad:
      return kRoadFrames;
    default:
      return 300;
  }
}

PinholeCamera CameraOf(SceneKind kind) {
  return kind == SceneKind::kRoad
             ? RoadCamera()
             : PinholeCamera{.fx = 535.4, .fy = 539.2, .cx = 320.1, .cy = 247.6};
}

uint64_t VisitSeed(uint64_t seed, const std::optional<uint64_t>& rearranged) {
  return rearranged ? CounterHash(HashSeed(seed, 0, "visit"), *rearranged) : seed;
}

Scene BuildScene(SceneKind kind, int frames, uint64_t seed,
                 const std::optional<uint64_t>& rearranged) {
  const std::vector<Rigid3> views = rearranged ? SteadyViews(kind) : std::vector<Rigid3>();
  Scene scene = BuildVisit(kind, frames, seed, VisitSeed(seed, rearranged));
  if (rearranged) {
    Rearrange(views, *rearranged, scene);
  }
  return scene;
}

}  // namespace hullslam::synthetic
