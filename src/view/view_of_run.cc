// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_of_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/run_sequence.h"
#include "hullslam/util/error.h"
#include "map/located_landmarks.h"
#include "results/finished_run.h"
#include "view/aligned_truth.h"
#include "view/point_colours.h"
#include "view/run_pictures.h"
#include "view/view_of_map.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr size_t kMostPictures = 80;

// Adds a part of the model. If its file is broken, the part is left out, and a note says why.
void AddPart(const char* part, ViewModel& model, const std::function<void()>& add) {
  try {
    add();
  } catch (const InputError& error) {
    model.notes.push_back(fmt::format("{} left out: {}", part, error.what()));
  }
}

void AddHead(const FinishedRun& run, ViewModel& model) {
  model.summary = *run.summary;
  model.program = run.program;
  model.sequence = run.sequence.path;
  model.version = run.version;
  model.is_metric = run.IsMetric();
  const fs::path sequence = fs::path(model.sequence).lexically_normal();
  model.title = sequence.has_filename() ? sequence.filename() : sequence.parent_path().filename();
  if (model.title.empty()) {
    model.title = fs::absolute(run.folder).lexically_normal().filename();
  }
}

void AddPoses(const FinishedRun& run, ViewModel& model) {
  AddPart("trajectory", model, [&] { model.trajectory = run.ReadPoses(); });
  AddPart("keyframes", model, [&] {
    model.keyframes.poses = run.ReadKeyframePoses();
    for (uint32_t id = 0; id < model.keyframes.poses.size(); ++id) {
      model.keyframes.ids.push_back(id);
    }
  });
}

// Without the map, all landmarks have the colour of the file, which says nothing.
void AddLandmarks(const FinishedRun& run, ViewModel& model) {
  AddPart("landmarks", model, [&] {
    PlyPoints points = run.ReadLandmarkPoints().value_or(PlyPoints());
    model.landmarks.total = points.positions.size();
    model.landmarks.positions = std::move(points.positions);
    if (points.left_out > 0) {
      model.notes.push_back(fmt::format(
          "{} points of map.ply left out: not finite or more than 1e6 m away", points.left_out));
    }
  });
}

void AddObjects(const FinishedRun& run, ViewModel& model) {
  AddPart("objects", model, [&] {
    std::optional<ObjectResults> report = run.ReadObjectResults();
    if (!report) {
      return;
    }
    model.camera = report->camera;
    model.changes = std::move(report->changes).value_or(std::vector<ChangedObject>());
    for (ObjectResult& object : report->objects) {
      model.objects.push_back({std::move(object), {}, {}});
    }
  });
}

void AddScene(const FinishedRun& run, ViewModel& model) {
  AddPart("relations", model, [&] {
    Scene scene = run.ReadSceneGraph().value_or(Scene());
    model.up = scene.up ? scene.up : model.up;
    for (ViewObject& object : model.objects) {
      if (const SceneObject* const body = scene.Find(object.object.id)) {
        object.body = *body;
      }
    }
    model.relations = std::move(scene.relations);
  });
}

std::optional<Trajectory> FindGroundtruth(const FinishedRun& run, const ImageSequence* sequence) {
  std::optional<Trajectory> converted = run.ReadConvertedGroundtruth();
  return converted || sequence == nullptr ? converted : ReadGroundtruth(*sequence);
}

// The part of the ground truth during the run, with a margin of half a second.
Trajectory DuringRun(const Trajectory& groundtruth, const Trajectory& run) {
  constexpr double kMargin = 0.5;
  Trajectory part;
  std::copy_if(groundtruth.begin(), groundtruth.end(), std::back_inserter(part),
               [&](const StampedPose& pose) {
                 return pose.timestamp >= run.front().timestamp - kMargin &&
                        pose.timestamp <= run.back().timestamp + kMargin;
               });
  return part;
}

void CompareWithTruth(const std::optional<Trajectory>& groundtruth, AlignmentKind alignment,
                      ViewModel& model) {
  if (model.trajectory.empty() || !groundtruth) {
    return;
  }
  const std::string failure =
      AddGroundtruth(DuringRun(*groundtruth, model.trajectory), alignment, model);
  if (!failure.empty()) {
    model.notes.push_back("ground truth left out: " + failure);
  }
}

void AddPictures(const ImageSequence& sequence, const RunMemory& memory, ViewModel& model) {
  std::vector<ImageTask> tasks = PictureTasks(kMostPictures, model);
  std::optional<PointColours> colours;
  if (memory.map != nullptr) {
    colours.emplace(*memory.map, LocateLandmarks(*memory.map, *memory.sensor).ids);
    for (ImageTask& task : ColourTasks(*memory.map, *model.camera, *colours)) {
      tasks.push_back(std::move(task));
    }
  }
  const size_t count = tasks.size();
  const LeftOutTasks left_out = RunImageTasks(sequence, *model.camera, std::move(tasks));
  if (colours && left_out.absent + left_out.unreadable < count) {
    model.landmarks.colours = colours->Colours();
  }
  if (left_out.absent > 0 && left_out.absent == count) {
    model.notes.push_back("images left out: the sequence has none of the run's keyframes");
  }
  if (left_out.unreadable > 0) {
    model.notes.push_back(
        fmt::format("{} of {} pictures of keyframes left out: their images cannot be read",
                    left_out.unreadable, count));
  }
  for (ViewObject& object : model.objects) {
    std::erase_if(object.cutouts, [](const ViewPicture& cutout) { return cutout.jpeg.empty(); });
  }
}

// The sequence of the run, if it is still there.
std::optional<ImageSequence> ReopenSequence(const FinishedRun& run, ViewModel& model) {
  std::optional<ImageSequence> sequence;
  const std::optional<fs::path> path = run.Find(run.sequence.path);
  if (!path) {
    model.notes.push_back(fmt::format(
        "images and ground truth left out: the sequence \"{}\" is not found", model.sequence));
    return sequence;
  }
  AddPart("images", model, [&] {
    sequence = OpenRunSequence(run.sequence, *path, model.camera.value_or(PinholeCamera{}));
  });
  return sequence;
}

void AddPresetOverrides(ViewModel& model) {
  ViewSettings settings;
  settings.explanation =
      "The settings are complete only in a report that was written by the run itself (--report).";
  const Json& provenance = model.summary["provenance"];
  const Json overrides =
      provenance.is_object() ? provenance.value("preset_overrides", Json::array()) : Json::array();
  for (const Json& entry : overrides.is_array() ? overrides : Json::array()) {
    const auto text = [&](const char* key) {
      return entry.is_object() && entry.contains(key) && entry[key].is_string()
                 ? entry[key].get<std::string>()
                 : std::string();
    };
    settings.changed.push_back({text("key"), text("value"), text("preset_value")});
  }
  model.settings = std::move(settings);
}

}  // namespace

void AddSurface(const FinishedRun& run, ViewModel& model) {
  AddPart("surface", model, [&] { model.surface = run.ReadSurface().value_or(PlySurface()); });
}

ViewModel ViewOfRun(const fs::path& folder, const RunMemory& memory) {
  const FinishedRun run = OpenFinishedRun(folder);
  ViewModel model;
  AddHead(run, model);
  AddPoses(run, model);
  AddSurface(run, model);
  AddObjects(run, model);
  if (memory.map != nullptr) {
    model.camera = memory.sensor->camera;
    AddMap(*memory.map, *memory.sensor, *memory.options, model);
  } else {
    AddLandmarks(run, model);
  }
  std::optional<ImageSequence> reopened;
  const ImageSequence* sequence = memory.sequence;
  if (sequence == nullptr) {
    reopened = ReopenSequence(run, model);
    sequence = reopened ? &*reopened : nullptr;
  }
  std::optional<Trajectory> groundtruth;
  AddPart("ground truth", model, [&] {
    groundtruth = FindGroundtruth(run, sequence);
    CompareWithTruth(groundtruth, run.alignment, model);
  });
  AddUp(groundtruth, model);
  AddScene(run, model);
  if (sequence != nullptr && model.camera) {
    AddPictures(*sequence, memory, model);
  }
  if (memory.settings != nullptr) {
    model.settings = *memory.settings;
  } else {
    AddPresetOverrides(model);
  }
  return model;
}

}  // namespace hullslam
