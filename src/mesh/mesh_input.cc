// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "datasets/run_sequence.h"
#include "eval/object_metrics.h"
#include "files/json_file.h"
#include "files/paths.h"
#include "hullslam/datasets/dataset.h"
#include "hullslam/map_files/map_file.h"
#include "hullslam/masks/open_masks.h"
#include "hullslam/settings/settings.h"
#include "hullslam/util/error.h"
#include "map/islands.h"
#include "masks/mask_all.h"
#include "results/finished_run.h"
#include "scene/up_direction.h"
#include "system/compose_trajectory.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNeedsDepth =
    "a mesh needs the depth of an RGB-D or a stereo camera, expected a run or a map that has it";

std::vector<ObjectResult> MappedOf(std::vector<ObjectResult> objects) {
  std::erase_if(objects, [](const ObjectResult& o) { return o.state != ObjectState::kMapped; });
  return objects;
}

fs::path FindSequence(const MeshSource& source, const FinishedRun& run) {
  const std::optional<fs::path> path =
      source.sequence.empty() ? run.Find(run.sequence.path) : std::optional(source.sequence);
  if (!path) {
    throw InputError(
        fmt::format("{}: the sequence '{}' of the run is not found, expected --sequence PATH",
                    source.input.string(), ShowText(run.sequence.path)));
  }
  return *path;
}

void OpenMasksOf(const fs::path& path, const std::string& format, MeshInput& input) {
  const cv::Size size = SizeAsRead(input.sequence, input.options.camera);
  input.masks = OpenMasks({path, format, size.width, size.height}, MaskFrames(input.sequence));
  input.read.push_back(path);
}

// The masks of the run, and that of all images.
void UseMasksOfRun(const MeshSource& source, const FinishedRun& run, MeshInput& input) {
  const fs::path summary = run.folder / "summary.json";
  const JsonNode provenance = JsonNode(summary, *run.summary).At("provenance");
  if (provenance.Has("mask_all")) {
    const std::string path = provenance.At("mask_all").At("path").Text();
    if (const std::optional<fs::path> found = run.Find(path)) {
      input.options.mask_all = ReadMaskAll(*found, input.sequence, input.options.camera);
    } else {
      input.notes.push_back("the mask of all images '" + path + "' is not found");
    }
  }
  if (!source.masks.empty()) {
    return;
  }
  if (const std::optional<fs::path> masks = run.Find(run.masks)) {
    OpenMasksOf(*masks, run.masks_format, input);
  } else if (!run.masks.empty() || provenance.Has("network")) {
    input.notes.push_back(
        fmt::format("the masks of the run are not found{}, so things that move are not left out; "
                    "--masks PATH names masks",
                    run.masks.empty() ? ", since a network made them" : " at '" + run.masks + "'"));
  }
}

void OpenRun(const MeshSource& source, MeshInput& input) {
  const FinishedRun run = OpenFinishedRun(source.input);
  if (!run.IsMetric()) {
    throw InputError(
        fmt::format("{}: the run is monocular; {}", source.input.string(), kNeedsDepth));
  }
  const fs::path settings =
      source.settings.empty() ? source.input / "settings.yaml" : source.settings;
  if (source.settings.empty() && !run.Has("settings.yaml")) {
    throw InputError(settings.string() +
                     ": is missing, because an earlier version has made the run; expected "
                     "--settings FILE with the settings of the run");
  }
  input.options = ReadSettings(settings, source.overrides);
  const fs::path sequence = FindSequence(source, run);
  input.sequence = OpenRunSequence(run.sequence, sequence, input.options.camera, true);
  input.read = {sequence};
  input.poses = run.ReadPoses();
  input.keyframes = StampsOf(run.ReadKeyframePoses());
  std::ranges::sort(input.keyframes);  // those of several sessions are not in order
  if (std::optional<ObjectResults> objects = run.ReadObjectResults()) {
    input.objects = MappedOf(std::move(objects->objects));
  }
  input.up = run.ReadSceneGraph().value_or(Scene()).up;
  UseMasksOfRun(source, run, input);
}

// The poses of the keyframes that this sequence has given.
Trajectory PosesOfSession(const Map& map, const fs::path& sequence) {
  if (map.sessions().size() < 2) {
    return KeyframeTrajectory(map);
  }
  Trajectory poses;
  for (size_t number = 1; number <= map.sessions().size(); ++number) {
    if (map.sessions()[number - 1].name == CanonicalName(sequence)) {
      const Trajectory more = KeyframeTrajectory(map, number);
      poses.insert(poses.end(), more.begin(), more.end());
    }
  }
  std::ranges::stable_sort(poses, {}, &StampedPose::timestamp);
  return poses;
}

void OpenMap(const MeshSource& source, MeshInput& input) {
  if (source.sequence.empty()) {
    throw InputError(source.input.string() +
                     ": a map has no images, expected --sequence PATH with those of its run");
  }
  StoredMap stored = ReadMap(source.input);
  KeepOnlyIsland(stored.map, MainIsland(stored.map));
  OpenedDataset opened = OpenFoundDataset(
      stored.settings.sensor,
      {.path = source.sequence, .settings = source.settings, .overrides = source.overrides});
  input.options = std::move(opened.settings.options);
  input.sequence = std::move(opened.sequence);
  if (!(input.options.camera == stored.settings.camera)) {
    throw InputError(fmt::format(
        "{}: the map was made with another camera than that of {}, expected --settings FILE with "
        "the settings of its run",
        source.input.string(), source.sequence.string()));
  }
  input.read = {source.input, source.sequence};
  input.poses = PosesOfSession(stored.map, source.sequence);
  input.keyframes = StampsOf(input.poses);
  input.objects = MappedOf(MeasuredObjects(stored.map, input.options.camera, {}).objects);
}

bool HasDepth(const ImageSequence& sequence) {
  return std::ranges::any_of(sequence.frames, [](const FramePaths& frame) {
    return !frame.depth.empty() || !frame.right.empty();
  });
}

}  // namespace

MeshInput OpenMeshInput(const MeshSource& source) {
  MeshInput input;
  std::error_code error;
  if (!fs::exists(source.input, error)) {
    throw InputError(source.input.string() +
                     ": does not exist, expected the output folder of a run or a map file");
  }
  fs::is_directory(source.input, error) ? OpenRun(source, input) : OpenMap(source, input);
  if (!HasDepth(input.sequence)) {
    throw InputError(fmt::format("{}: has no depth images and no right images; {}",
                                 source.input.string(), kNeedsDepth));
  }
  if (!source.masks.empty()) {
    OpenMasksOf(source.masks, source.masks_format, input);
  }
  if (!input.up) {
    input.up = UpFromImages(input.poses);
  }
  return input;
}

}  // namespace hullslam
