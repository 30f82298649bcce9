// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/suite.h"

#include <algorithm>
#include <array>
#include <utility>

#include "hullslam/util/error.h"
#include "synthetic/camera_path.h"
#include "synthetic/catalogue.h"
#include "synthetic/dishes.h"
#include "synthetic/icl_office.h"
#include "synthetic/office_loop.h"
#include "synthetic/office_table.h"
#include "synthetic/person.h"
#include "synthetic/scenes.h"
#include "synthetic/sequence_writer.h"
#include "synthetic/teddy_room.h"
#include "util/random_seed.h"

namespace hullslam::synthetic {
namespace {

// The seed of all scenes. They do not depend on the seed of the user, so that runs with several
// seeds measure the same.
constexpr uint64_t kScene = 0;

// The time for a whole path. A path of fewer frames is cut off instead of run faster.
double WholePath(int frames) { return (std::max(frames, kSuiteFrames) - 1) / kFramesPerSecond; }

// By how much the paths, which are made for 300 frames, are slower with more frames.
double Pace(int frames) { return WholePath(kSuiteFrames) / WholePath(frames); }

Scene Desk1(int frames, uint64_t visit) {
  Scene scene = BuildScene(SceneKind::kDesk, frames, kScene);
  const SweepPath path{.radius = 1.35,
                       .height = 1.3,
                       .middle_angle = -1.6,
                       .swing = 0.62,
                       .frequency = 0.13 * Pace(frames),
                       .target = {0.0, 0.0, 0.82}};
  scene.world_from_cam = ByHand(path, visit);
  return scene;
}

Scene Desk2(int frames, uint64_t visit) {
  SceneBuilder builder(HashSeed(kScene, 0, "desk2"));
  FurnishOfficeTable(builder);
  const OrbitPath path{.radius = 1.6,
                       .height = 1.4,
                       .start_angle = -2.4,
                       .angular_speed = 0.12 * Pace(frames),
                       .target = {0.0, 0.0, 0.82}};
  builder.scene().world_from_cam = ByHand(path, visit);
  return builder.Finish();
}

Scene Person(int frames, uint64_t visit) {
  SceneBuilder builder(HashSeed(kScene, 0, "person"));
  FurnishOfficeTable(builder);
  const Palette palette = builder.AddRichPalette();
  SceneObject person = MakePerson(builder.Repeat(palette.fabric, 0.5, {0.8F, 0.9F, 1.3F}),
                                  builder.Repeat(palette.fabric, 0.6, {0.9F, 0.6F, 0.5F}),
                                  builder.Repeat(palette.speckle, 0.3, {0.7F, 0.85F, 1.1F}))
                           .Build(Eigen::Vector3d::Zero(), 0.0);
  const StrollPath stroll{.duration = WholePath(frames)};
  person.motion = [stroll, half = person.half_extents.z()](double time) {
    return stroll.WorldFromPerson(time, half);
  };
  person.world_from_object = person.motion(0.0);
  builder.AddObject(std::move(person));
  const OrbitPath path{.radius = 2.0,
                       .height = 1.45,
                       .start_angle = -2.2,
                       .angular_speed = 0.06 * Pace(frames),
                       .target = {0.0, 0.0, 0.9}};
  builder.scene().world_from_cam = ByHand(path, visit);
  return builder.Finish();
}

Scene Dishes(int frames, uint64_t visit) {
  SceneBuilder builder(HashSeed(kScene, 0, "dishes"));
  FurnishDishes(builder);
  const OrbitPath path{.radius = 1.15,
                       .height = 1.35,
                       .start_angle = -2.2,
                       .angular_speed = 0.13 * Pace(frames),
                       .target = {0.0, 0.0, 0.76}};
  builder.scene().world_from_cam = ByHand(path, visit);
  return builder.Finish();
}

Scene Office(int frames, uint64_t visit) {
  SceneBuilder builder(HashSeed(kScene, 0, "office"));
  FurnishOfficeLoop(builder);
  builder.scene().world_from_cam = ByHand(OfficeLoopPath(WholePath(frames)), visit);
  return builder.Finish();
}

Scene Teddy(int frames, uint64_t visit) {
  SceneBuilder builder(HashSeed(kScene, 0, "teddy"));
  FurnishTeddyRoom(builder);
  const OrbitPath path{.radius = 1.6,
                       .height = 1.3,
                       .start_angle = -2.5,
                       .angular_speed = 0.16 * Pace(frames),
                       .target = {0.0, 0.0, 0.7}};
  builder.scene().world_from_cam = ByHand(path, visit);
  return builder.Finish();
}

template <int kNumber>
Scene Icl(int frames, uint64_t visit) {
  SceneBuilder builder(HashSeed(kScene, 0, "icl office"));
  FurnishIclOffice(builder);
  const PacedPath path(IclOfficePath(kNumber), WholePath(frames));
  builder.scene().world_from_cam = ByHand(path, visit);
  return builder.Finish();
}

constexpr std::array<SuiteSequence, 10> kSuite = {{
    {.name = "desk1",
     .plays = "fr1-desk",
     .special = "a desk; the camera sweeps to and fro at about 0.45 m/s and has a rolling shutter",
     .readout_time = 0.026,
     .build = Desk1},
    {.name = "desk2",
     .plays = "fr2-desk",
     .special = "an office table in a large room; the camera moves slowly in an arc",
     .build = Desk2},
    {.name = "person",
     .plays = "fr2-person",
     .special = "the table of desk2; a person walks around it, and stops twice",
     .build = Person},
    {.name = "dishes",
     .plays = "fr2-dishes",
     .special = "a laid table; dishes are hollow and, like the room, have little texture",
     .build = Dishes},
    {.name = "office",
     .plays = "fr3-office",
     .special = "once around two desks and 20 degrees more: a loop",
     .build = Office},
    {.name = "teddy",
     .plays = "fr3-teddy",
     .special = "a large teddy bear among other concave objects in a room of little texture",
     .build = Teddy},
    {.name = "icl0",
     .plays = "office-traj0",
     .special = "an office, seen from its middle; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .build = Icl<0>},
    {.name = "icl1",
     .plays = "office-traj1",
     .special = "the office of icl0; the camera turns to plain walls; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .build = Icl<1>},
    {.name = "icl2",
     .plays = "office-traj2",
     .special = "the office of icl0; the camera is near the desks; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .build = Icl<2>},
    {.name = "icl3",
     .plays = "office-traj3",
     .special = "the office of icl0; the camera turns to other plain walls; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .build = Icl<3>},
}};

// The camera of ICL-NUIM, config/ICL.yaml.
PinholeCamera IclCamera() { return {.fx = 481.2, .fy = 480.0, .cx = 319.5, .cy = 239.5}; }

Sensor::Options SensorOf(DatasetForm form) {
  if (form == DatasetForm::kTum) {
    return {};
  }
  return {.model = DepthModel::kIclNuim, .min_depth = 0.1, .max_depth = 13.0};
}

}  // namespace

std::span<const SuiteSequence> SuiteSequences() { return kSuite; }

std::vector<const SuiteSequence*> SelectSuite(std::span<const std::string> names) {
  const auto has_name = [](const SuiteSequence& sequence, std::string_view name) {
    return sequence.name == name;
  };
  std::string all;
  for (const SuiteSequence& sequence : kSuite) {
    all += (all.empty() ? "" : ", ") + std::string(sequence.name);
  }
  for (const std::string& name : names) {
    if (std::none_of(kSuite.begin(), kSuite.end(),
                     [&](const SuiteSequence& sequence) { return has_name(sequence, name); })) {
      throw InputError("the suite has no sequence '" + name + "': expected one or more of " + all);
    }
  }
  std::vector<const SuiteSequence*> selected;
  for (const SuiteSequence& sequence : kSuite) {
    if (names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
          return has_name(sequence, name);
        })) {
      selected.push_back(&sequence);
    }
  }
  return selected;
}

SequencePlan PlanOf(const SuiteSequence& sequence, int frames, uint64_t seed) {
  const uint64_t visit = HashSeed(seed, 0, sequence.name);
  return {.name = std::string(sequence.name),
          .seed = seed,
          .scene = sequence.build(frames, visit),
          .frames = frames,
          .camera = sequence.form == DatasetForm::kTum ? SyntheticCamera() : IclCamera(),
          .readout_time = sequence.readout_time,
          .sensor = SensorOf(sequence.form),
          .sensor_seed = visit,
          .layout = {sequence.form}};
}

}  // namespace hullslam::synthetic
