// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/suite.h"

#include <algorithm>
#include <array>
#include <functional>
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
#include "util/hash.h"

namespace hullslam::synthetic {
namespace {

// The seed of all scenes. They do not depend on the seed of the user, so that runs with several
// seeds measure the same.
constexpr uint64_t kScene = 0;

// The time for a whole path. A path of fewer frames is cut off instead of run faster.
double WholePath(int frames) { return (std::max(frames, kSuiteFrames) - 1) / kFramesPerSecond; }

// By how much the paths, which are made for 300 frames, are slower with more frames.
double Pace(int frames) { return WholePath(kSuiteFrames) / WholePath(frames); }

using SteadyPath = std::function<Rigid3(double)>;

template <typename Path>
SteadyPath Steady(const Path& path) {
  return [path](double time) { return path.WorldFromCam(time); };
}

// A scene whose textures have seeds of their own.
template <typename Function>
Scene Furnish(std::string_view name, const Function& furnish) {
  SceneBuilder builder(HashSeed(kScene, 0, name));
  furnish(builder);
  return builder.Finish();
}

Scene Desk1(int frames) { return BuildScene(SceneKind::kDesk, frames, kScene); }

SteadyPath Desk1Path(int frames) {
  return Steady(SweepPath{.radius = 1.35,
                          .height = 1.3,
                          .middle_angle = -1.6,
                          .swing = 0.62,
                          .frequency = 0.13 * Pace(frames),
                          .target = {0.0, 0.0, 0.82}});
}

Scene Desk2(int /*frames*/) { return Furnish("desk2", FurnishOfficeTable); }

SteadyPath Desk2Path(int frames) {
  return Steady(OrbitPath{.radius = 1.6,
                          .height = 1.4,
                          .start_angle = -2.4,
                          .angular_speed = 0.12 * Pace(frames),
                          .target = {0.0, 0.0, 0.82}});
}

Scene Person(int frames) {
  SceneBuilder builder(HashSeed(kScene, 0, "person"));
  const Palette palette = FurnishOfficeTable(builder);
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
  return builder.Finish();
}

SteadyPath PersonPath(int frames) {
  return Steady(OrbitPath{.radius = 2.0,
                          .height = 1.45,
                          .start_angle = -2.2,
                          .angular_speed = 0.06 * Pace(frames),
                          .target = {0.0, 0.0, 0.9}});
}

Scene Dishes(int /*frames*/) { return Furnish("dishes", FurnishDishes); }

SteadyPath DishesPath(int frames) {
  return Steady(OrbitPath{.radius = 1.15,
                          .height = 1.35,
                          .start_angle = -2.2,
                          .angular_speed = 0.13 * Pace(frames),
                          .target = {0.0, 0.0, 0.76}});
}

Scene Office(int /*frames*/) { return Furnish("office", FurnishOfficeLoop); }

SteadyPath OfficePath(int frames) { return Steady(OfficeLoopPath(WholePath(frames))); }

Scene Teddy(int /*frames*/) { return Furnish("teddy", FurnishTeddyRoom); }

SteadyPath TeddyPath(int frames) {
  return Steady(OrbitPath{.radius = 1.6,
                          .height = 1.3,
                          .start_angle = -2.5,
                          .angular_speed = 0.16 * Pace(frames),
                          .target = {0.0, 0.0, 0.7}});
}

Scene Icl(int /*frames*/) { return Furnish("icl office", FurnishIclOffice); }

template <int kNumber>
SteadyPath IclPath(int frames) {
  return Steady(PacedPath(IclOfficePath(kNumber), WholePath(frames)));
}

constexpr std::array<SuiteSequence, 10> kSuite = {{
    {.name = "desk1",
     .plays = "fr1-desk",
     .special = "a desk; the camera sweeps to and fro at about 0.45 m/s and has a rolling shutter",
     .readout_time = 0.026,
     .furnish = Desk1,
     .path = Desk1Path},
    {.name = "desk2",
     .plays = "fr2-desk",
     .special = "an office table in a large room; the camera moves slowly in an arc",
     .furnish = Desk2,
     .path = Desk2Path},
    {.name = "person",
     .plays = "fr2-person",
     .special = "the table of desk2; a person walks around it, and stops twice",
     .furnish = Person,
     .path = PersonPath},
    {.name = "dishes",
     .plays = "fr2-dishes",
     .special = "a laid table; dishes are hollow and, like the room, have little texture",
     .furnish = Dishes,
     .path = DishesPath},
    {.name = "office",
     .plays = "fr3-office",
     .special = "once around two desks and 20 degrees more: a loop",
     .furnish = Office,
     .path = OfficePath},
    {.name = "teddy",
     .plays = "fr3-teddy",
     .special = "a large teddy bear among other concave objects in a room of little texture",
     .furnish = Teddy,
     .path = TeddyPath},
    {.name = "icl0",
     .plays = "office-traj0",
     .special = "an office, seen from its middle; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .furnish = Icl,
     .path = IclPath<0>},
    {.name = "icl1",
     .plays = "office-traj1",
     .special = "the office of icl0; the camera turns to plain walls; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .furnish = Icl,
     .path = IclPath<1>},
    {.name = "icl2",
     .plays = "office-traj2",
     .special = "the office of icl0; the camera is near the desks; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .furnish = Icl,
     .path = IclPath<2>},
    {.name = "icl3",
     .plays = "office-traj3",
     .special = "the office of icl0; the camera turns to other plain walls; ICL-NUIM's files",
     .form = DatasetForm::kIcl,
     .furnish = Icl,
     .path = IclPath<3>},
}};

// The camera of ICL-NUIM, config/ICL.yaml.
PinholeCamera IclCamera() { return {.fx = 481.2, .fy = 480.0, .cx = 319.5, .cy = 239.5}; }

// The colour camera of a Kinect indoors. With these values and Bayer's pattern, edges are as soft
// and the noise is as strong as in the images of freiburg1_xyz.
constexpr double kKinectExposure = 0.02;  // s
constexpr double kKinectLensBlur = 0.5;   // px

Sensor::Options SensorOf(DatasetForm form) {
  if (form == DatasetForm::kTum) {
    return {.lens_blur = kKinectLensBlur, .bayer = true};
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
  Scene scene = sequence.furnish(frames);
  scene.world_from_cam = ByHand(sequence.path(frames), visit);
  return {.name = std::string(sequence.name),
          .seed = seed,
          .scene = std::move(scene),
          .frames = frames,
          .camera = sequence.form == DatasetForm::kTum ? SyntheticCamera() : IclCamera(),
          .readout_time = sequence.readout_time,
          .exposure_time = sequence.form == DatasetForm::kTum ? kKinectExposure : 0.0,
          .sensor = SensorOf(sequence.form),
          .sensor_seed = visit,
          .layout = {sequence.form}};
}

}  // namespace hullslam::synthetic
