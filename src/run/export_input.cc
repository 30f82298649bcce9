// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/export_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "files/json_file.h"
#include "files/json_node.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"
#include "map/islands.h"
#include "results/object_file.h"
#include "results/ply_points.h"
#include "results/scene_file.h"
#include "run/map_session.h"
#include "run/object_outputs.h"
#include "sequences/run_sequence.h"
#include "system/compose_trajectory.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr Colour kGreyPoint = {128, 128, 128};

// What summary.json says of a run.
struct RunFacts {
  RunOpening opening;
  std::string sequence;
  std::string masks;
  std::string masks_format;
  std::string map;
  size_t keyframes = 0;
  size_t landmarks = 0;
};

RunFacts ReadRunFacts(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  std::error_code error;
  if (!fs::exists(file, error)) {
    throw InputError(folder.string() +
                     ": has no summary.json, expected the output folder of a run or a map file");
  }
  const nlohmann::json json = ReadJson(file);
  const JsonNode top(file, json);
  const JsonNode provenance = top.At("provenance");
  const auto text = [&](const char* key) {
    return provenance.Has(key) ? provenance.At(key).Text() : std::string();
  };
  return {.opening = ReadRunOpening(json),
          .sequence = text("sequence"),
          .masks = text("masks"),
          .masks_format = text("masks_format"),
          .map = text("map"),
          .keyframes = top.At("map").At("keyframes").Count(),
          .landmarks = top.At("map").At("landmarks").Count()};
}

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
  loaded.map.keyframes().ForEach([&](KeyframeId, const Keyframe& keyframe) {
    input.model.keyframes.push_back({keyframe.frame->timestamp, Inverse(keyframe.cam_from_world)});
  });
  input.model.points.clear();
  for (const Eigen::Vector3d& position : loaded.located.positions) {
    input.model.points.push_back({position, kGreyPoint});
  }
}

// A later run that goes on with the map may have replaced it. Then its world is another one.
void CheckMapIsOfRun(const fs::path& path, const RunFacts& facts, const Map& map) {
  if (map.keyframes().size() != facts.keyframes || map.landmarks().size() != facts.landmarks) {
    throw InputError(fmt::format(
        "{}: has {} keyframes and {} landmarks, but the run had {} and {}; expected the map that "
        "this run has saved (--map FILE names another one)",
        path.string(), map.keyframes().size(), map.landmarks().size(), facts.keyframes,
        facts.landmarks));
  }
}

void UseMapOfRun(const ExportSource& source, const RunFacts& facts, bool is_needed,
                 ExportInput& input) {
  std::optional<fs::path> path = source.map;
  if (source.map.empty()) {
    path = FindRunInput(facts.map, source.input);
  }
  if (path) {
    UseMap(*path, input);
    CheckMapIsOfRun(*path, facts, input.map->map);
    return;
  }
  const std::string reason = facts.map.empty() ? "the run has not saved its map"
                                               : "its map '" + facts.map + "' is not found";
  if (is_needed) {
    throw InputError(fmt::format(
        "{}: {}, which has the keypoints and tracks for this format; repeat the run with "
        "--save-map FILE, or name the map with --map FILE",
        source.input.string(), reason));
  }
  input.notes.push_back(reason + ", so the points have no colours");
}

void ReadPointsOfRun(const fs::path& folder, ExportModel& model) {
  std::error_code error;
  if (!fs::exists(folder / "map.ply", error)) {
    return;
  }
  for (const Eigen::Vector3f& position : ReadMapLandmarks(folder / "map.ply").positions) {
    model.points.push_back({position.cast<double>(), kGreyPoint});
  }
}

void ReadSceneOfRun(const fs::path& folder, ExportModel& model) {
  std::error_code error;
  if (fs::exists(folder / "scene.json", error)) {
    model.scene = ReadScene(folder / "scene.json");
  }
  if (fs::exists(folder / "objects.json", error)) {
    model.camera = ReadObjects(folder / "objects.json").camera;
  }
}

void UseSequence(const ExportSource& source, const RunFacts& facts, bool is_needed,
                 ExportInput& input) {
  std::optional<fs::path> path = source.sequence;
  if (source.sequence.empty()) {
    path = FindRunInput(facts.sequence, source.input);
  }
  if (!path) {
    const std::string reason = "the sequence '" + facts.sequence + "' of the run is not found";
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
  input.sequence = OpenRunSequence(facts.opening, *path, input.map->sensor.camera, use_depth);
  input.session = SessionName(source.sequence.empty() ? *path : fs::path(facts.sequence));
  input.read.push_back(*path);
  if (const auto masks = FindRunInput(facts.masks, source.input)) {
    input.masks = MasksOfRun{*masks, facts.masks_format};
    input.read.push_back(*masks);
  }
}

ExportInput ReadRun(const ExportSource& source, ExportNeed need) {
  ExportInput input;
  const fs::path& folder = source.input;
  input.read = {folder};
  const RunFacts facts = ReadRunFacts(folder);
  std::error_code error;
  const bool has_frames = fs::exists(folder / "trajectory.txt", error);
  input.model.trajectory = has_frames ? ReadTrajectory(folder / "trajectory.txt")
                                      : ReadKeyframes(folder / "keyframes.txt");
  if (need == ExportNeed::kPoses) {
    return input;
  }
  ReadSceneOfRun(folder, input.model);
  UseMapOfRun(source, facts, need >= ExportNeed::kMap, input);
  if (!input.map) {
    input.model.keyframes = ReadKeyframes(folder / "keyframes.txt");
    ReadPointsOfRun(folder, input.model);
  } else if (need != ExportNeed::kMap) {
    UseSequence(source, facts, need == ExportNeed::kImages, input);
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
      CollectScene(loaded.map, CollectObjects(loaded.map, loaded.sensor.camera, {}), std::nullopt);
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
