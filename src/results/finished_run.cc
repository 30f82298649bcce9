// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/finished_run.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "files/json_file.h"
#include "files/text_rows.h"
#include "hullslam/eval/ate.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"
#include "results/object_file.h"
#include "results/output_folder.h"
#include "results/scene_file.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

AlignmentKind ReadAlignment(const JsonNode& top) {
  const JsonNode alignment = top.At("trajectory").At("alignment");
  const std::string name = alignment.Text();
  for (const AlignmentKind kind :
       {AlignmentKind::kNone, AlignmentKind::kSe3, AlignmentKind::kSim3}) {
    if (name == ToString(kind)) {
      return kind;
    }
  }
  alignment.Fail("none, se3 or sim3");
}

// The text of a member; empty if it is absent or null.
std::string TextOf(const JsonNode& node, const char* key) {
  return node.Has(key) ? node.At(key).Text() : std::string();
}

SequenceOfRun ReadSequence(const JsonNode& provenance, const std::string& program) {
  SequenceOfRun sequence{.path = TextOf(provenance, "sequence"),
                         .dataset = TextOf(provenance, "dataset"),
                         .program = program};
  if (provenance.Has("sequence_choices")) {
    for (const auto& [name, choice] : provenance.At("sequence_choices").Members()) {
      sequence.choices[name] = choice.Text();
    }
  }
  return sequence;
}

// The poses of the rectified camera, from the poses of the camera as read.
Trajectory OfRectified(const SequenceOfRun& sequence, Trajectory as_read) {
  const auto choice = sequence.choices.find("rectified_from_left");
  if (choice == sequence.choices.end()) {
    return as_read;
  }
  Eigen::Quaterniond q;
  if (!ParseFinites(choice->second, q.coeffs()) || !(q.norm() > 0.0)) {
    throw InputError(
        fmt::format("rectified_from_left in summary.json is '{}', expected a rotation x y z w",
                    ShowText(choice->second)));
  }
  return OfOtherCamera(std::move(as_read),
                       Inverse(Rigid3(q.normalized(), Eigen::Vector3d::Zero())));
}

}  // namespace

bool FinishedRun::Has(const std::string& name) const {
  std::error_code error;
  return fs::exists(folder / name, error);
}

std::optional<fs::path> FinishedRun::Find(const std::string& path) const {
  std::error_code error;
  if (path.empty()) {
    return std::nullopt;
  }
  if (fs::exists(path, error)) {
    return fs::path(path);
  }
  for (fs::path above = fs::absolute(folder, error); !above.empty(); above = above.parent_path()) {
    if (fs::exists(above / path, error)) {
      return above / path;
    }
    if (above == above.root_path()) {
      break;
    }
  }
  return std::nullopt;
}

Trajectory FinishedRun::ReadPoses() const { return OfRectified(sequence, ReadPosesAsRead()); }

Trajectory FinishedRun::ReadPosesAsRead() const {
  return ReadTrajectory(folder / "trajectory.txt");
}

Trajectory FinishedRun::ReadKeyframePoses() const {
  return OfRectified(sequence, ReadKeyframes(folder / "keyframes.txt"));
}

std::optional<PlyPoints> FinishedRun::ReadLandmarkPoints() const {
  return Has("map.ply") ? std::optional(ReadMapLandmarks(folder / "map.ply")) : std::nullopt;
}

std::optional<PlySurface> FinishedRun::ReadSurface() const {
  return Has(kSurfaceFile) ? std::optional(ReadPlySurface(folder / kSurfaceFile)) : std::nullopt;
}

std::optional<ObjectResults> FinishedRun::ReadObjectResults() const {
  return Has("objects.json") ? std::optional(ReadObjects(folder / "objects.json")) : std::nullopt;
}

std::optional<Scene> FinishedRun::ReadSceneGraph() const {
  return Has("scene.json") ? std::optional(ReadScene(folder / "scene.json")) : std::nullopt;
}

std::optional<Trajectory> FinishedRun::ReadConvertedGroundtruth() const {
  return Has("groundtruth.txt")
             ? std::optional(OfRectified(sequence, ReadTrajectory(folder / "groundtruth.txt")))
             : std::nullopt;
}

FinishedRun OpenFinishedRun(const fs::path& folder) {
  FinishedRun run;
  run.folder = folder;
  if (!run.Has("summary.json")) {
    throw InputError(folder.string() +
                     ": has no summary.json, expected the output folder of a run");
  }
  const fs::path file = folder / "summary.json";
  run.summary = std::make_shared<const nlohmann::json>(ReadJson(file));
  const JsonNode top(file, *run.summary);
  run.alignment = ReadAlignment(top);
  run.keyframes = top.At("map").At("keyframes").Count();
  run.landmarks = top.At("map").At("landmarks").Count();
  const JsonNode provenance = top.At("provenance");
  if (provenance.Members().empty()) {  // which refuses what is no object
    provenance.Fail("what the run was made from");
  }
  run.program = TextOf(provenance, "program");
  run.version = TextOf(provenance, "version");
  run.sequence = ReadSequence(provenance, run.program);
  run.masks = TextOf(provenance, "masks");
  run.masks_format = TextOf(provenance, "masks_format");
  run.map = TextOf(provenance, "map");
  return run;
}

}  // namespace hullslam
