// SPDX-License-Identifier: GPL-3.0-or-later
#include "exports/export_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "datasets/run_sequence.h"
#include "eval/object_metrics.h"
#include "files/paths.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/util/error.h"
#include "map/islands.h"
#include "results/finished_run.h"
#include "scene/make_scene.h"
#include "system/compose_trajectory.h"
#include "system/make_sensor.h"

namespace hullslam {

std::vector<PlacedObject> PlaceObjects(const Scene& scene, ObjectShape shape) {
  std::vector<PlacedObject> placed;
  for (const SceneObject& object : scene.objects) {
    if (shape == ObjectShape::kBoxes && object.box) {
      placed.push_back({&object, object.box->world_from_box, object.box->half_extents});
    } else {
      placed.push_back({&object, object.ellipsoid.world_from_object, object.ellipsoid.half_axes});
    }
  }
  return placed;
}

TriangleMesh MeshOf(ObjectShape shape) {
  return shape == ObjectShape::kBoxes ? UnitCube() : UnitSphere();
}

namespace {

namespace fs = std::filesystem;

constexpr Colour kGreyPoint = {128, 128, 128};

MapOfRun LoadMap(const fs::path& path, std::vector<std::string>& notes) {
  StoredMap stored = ReadMap(path);
  if (KeepOnlyIsland(stored.map, MainIsland(stored.map))) {
    notes.push_back(path.string() +
                    ": has parts that are not joined; only the largest one is exported");
  }
  const Sensor sensor = MakeSensor(OptionsOf(stored.settings));
  LocatedLandmarks located = LocateLandmarks(stored.map, sensor);
  return {std::move(stored.map), sensor, std::move(located)};
}

// The parts of the model that the map has.
void UseMap(const fs::path& path, ExportInput& input) {
  input.map = LoadMap(path, input.notes);
  input.read.push_back(path);
  const MapOfRun& loaded = *input.map;
  input.model.camera = loaded.sensor.camera;
  input.model.keyframes.clear();
  for (const auto& [frame, id] : loaded.map.keyframes_by_frame()) {  // in the order of time
    if (const Keyframe* const keyframe = loaded.map.keyframes().Find(id)) {
      input.model.keyframes.push_back(
          {keyframe->frame->timestamp, Inverse(keyframe->cam_from_world)});
    }
  }
  input.model.points.clear();
  for (const Eigen::Vector3d& position : loaded.located.positions) {
    input.model.points.push_back({position, kGreyPoint});
  }
}

// A later run that goes on with the map may have replaced it. Then its world is another one.
void CheckMapIsOfRun(const fs::path& path, const FinishedRun& run, const Map& map) {
  if (map.keyframes().size() != run.keyframes || map.landmarks().size() != run.landmarks) {
    throw InputError(fmt::format(
        "{}: has {} keyframes and {} landmarks, but the run had {} and {}; expected the map that "
        "this run has saved (--map FILE names another one)",
        path.string(), map.keyframes().size(), map.landmarks().size(), run.keyframes,
        run.landmarks));
  }
}

void UseMapOfRun(const ExportSource& source, const FinishedRun& run, bool is_needed,
                 ExportInput& input) {
  std::optional<fs::path> path = source.map;
  if (source.map.empty()) {
    path = run.Find(run.map);
  }
  if (path) {
    UseMap(*path, input);
    CheckMapIsOfRun(*path, run, input.map->map);
    return;
  }
  const std::string reason =
      run.map.empty() ? "the run has not saved its map" : "its map '" + run.map + "' is not found";
  if (is_needed) {
    throw InputError(fmt::format(
        "{}: {}, which has the keypoints and tracks for this format; repeat the run with "
        "--save-map FILE, or name the map with --map FILE",
        source.input.string(), reason));
  }
  input.notes.push_back(reason + ", so the points have no colours");
}

void UsePointsOfRun(const FinishedRun& run, ExportModel& model) {
  for (const Eigen::Vector3f& position : run.ReadLandmarkPoints().value_or(PlyPoints()).positions) {
    model.points.push_back({position.cast<double>(), kGreyPoint});
  }
}

void UseSceneOfRun(const FinishedRun& run, ExportModel& model) {
  model.scene = run.ReadSceneGraph().value_or(Scene());
  if (const std::optional<ObjectResults> objects = run.ReadObjectResults()) {
    model.camera = objects->camera;
  }
}

void UseSequence(const ExportSource& source, const FinishedRun& run, bool is_needed,
                 ExportInput& input) {
  std::optional<fs::path> path = source.sequence;
  if (source.sequence.empty()) {
    path = run.Find(run.sequence.path);
  }
  if (!path) {
    const std::string reason = "the sequence '" + run.sequence.path + "' of the run is not found";
    if (is_needed) {
      throw InputError(
          fmt::format("{}: {}, which has the images for this format; expected "
                      "--sequence PATH",
                      source.input.string(), reason));
    }
    input.notes.push_back(reason + ", so the points have no colours");
    return;
  }
  const bool use_depth = !input.map->sensor.IsMonocular();
  input.sequence = OpenRunSequence(run.sequence, *path, input.map->sensor.camera, use_depth);
  input.session = CanonicalName(source.sequence.empty() ? *path : fs::path(run.sequence.path));
  input.read.push_back(*path);
  if (const auto masks = run.Find(run.masks)) {
    input.masks = MasksOfRun{*masks, run.masks_format};
    input.read.push_back(*masks);
  }
}

ExportInput ReadRun(const ExportSource& source, ExportNeed need) {
  ExportInput input;
  input.read = {source.input};
  const FinishedRun run = OpenFinishedRun(source.input);
  const bool has_poses = run.Has("trajectory.txt");
  if (need == ExportNeed::kPoses) {
    input.model.trajectory = has_poses ? run.ReadPosesAsRead() : run.ReadKeyframePoses();
    return input;
  }
  input.model.trajectory = has_poses ? run.ReadPoses() : run.ReadKeyframePoses();
  UseSceneOfRun(run, input.model);
  UseMapOfRun(source, run, need >= ExportNeed::kMap, input);
  if (!input.map) {
    input.model.keyframes = run.ReadKeyframePoses();
    UsePointsOfRun(run, input.model);
  } else if (need != ExportNeed::kMap) {
    UseSequence(source, run, need == ExportNeed::kImages, input);
  }
  return input;
}

ExportInput ReadMapFile(const ExportSource& source, ExportNeed need) {
  if (need == ExportNeed::kImages) {
    throw InputError(fmt::format(
        "{}: a map has no images, which this format needs; expected the output folder of the run "
        "that saved it, with --map if its summary.json does not name the map",
        source.input.string()));
  }
  if (!source.map.empty() || !source.sequence.empty()) {
    throw InputError("--map and --sequence belong to the output folder of a run, but " +
                     source.input.string() + " is a map");
  }
  ExportInput input;
  UseMap(source.input, input);
  const MapOfRun& loaded = *input.map;
  input.model.trajectory = KeyframeTrajectory(loaded.map);
  input.model.scene =
      MakeScene(loaded.map, MeasuredObjects(loaded.map, loaded.sensor.camera, {}), std::nullopt);
  if (need == ExportNeed::kScene) {
    input.notes.emplace_back(
        "a map has no images, so the points have no colours; the output folder of its run gives "
        "them");
  }
  return input;
}

}  // namespace

ExportInput ReadExportInput(const ExportSource& source, ExportNeed need) {
  std::error_code error;
  if (!fs::exists(source.input, error)) {
    throw InputError(source.input.string() +
                     ": does not exist, expected the output folder of a run or a map file");
  }
  return fs::is_directory(source.input, error) ? ReadRun(source, need) : ReadMapFile(source, need);
}

}  // namespace hullslam
