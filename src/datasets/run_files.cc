// SPDX-License-Identifier: GPL-3.0-or-later
#include "datasets/run_files.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "eval/object_metrics.h"
#include "hullslam/results/trajectory_file.h"
#include "hullslam/settings/settings.h"
#include "results/object_file.h"
#include "results/ply_file.h"
#include "scene/make_scene.h"
#include "system/compose_trajectory.h"
#include "system/make_sensor.h"

namespace hullslam {
namespace {

std::string MapPly(const std::vector<Eigen::Vector3d>& landmarks, const Trajectory& keyframes) {
  std::vector<Eigen::Vector3d> centers;
  for (const StampedPose& pose : keyframes) {
    centers.push_back(pose.world_from_cam.translation);
  }
  return FormatMapPly(landmarks, centers);
}

// The poses of the keyframes, with one part per session. A run that began with an empty map has one
// part without a title.
std::vector<TrajectoryPart> KeyframeParts(const RunFiles& files) {
  const Map& map = *files.content.map;
  std::vector<TrajectoryPart> parts;
  if (!files.session) {
    parts.push_back({.title = {}, .poses = KeyframeTrajectory(map)});
  } else {
    parts.push_back({.title = {}, .poses = KeyframeTrajectory(map, 0)});
    for (size_t number = 1; number <= map.sessions().size(); ++number) {
      parts.push_back({.title = TitleOfSession(number, map.sessions()[number - 1].name),
                       .poses = KeyframeTrajectory(map, number)});
    }
  }
  for (TrajectoryPart& part : parts) {
    part.poses = AsRead(files.sequence, std::move(part.poses));
  }
  return parts;
}

void WriteIslands(const RunFiles& files, OutputFolder& output) {
  const Sensor sensor = MakeSensor(files.options);
  for (const LeftIsland& island : files.content.islands) {
    const std::string name = IslandSuffix(island.id);
    const Trajectory keyframes = KeyframeTrajectory(*island.map);
    output.Write({"trajectory" + name + ".txt",
                  FormatTrajectory(AsRead(files.sequence, island.trajectory))});
    output.Write(
        {"keyframes" + name + ".txt", FormatTrajectory(AsRead(files.sequence, keyframes))});
    output.Write(
        {"map" + name + ".ply", MapPly(LocateLandmarks(*island.map, sensor).positions, keyframes)});
  }
}

}  // namespace

RunContent CollectContent(const System& system, const std::string& sequence,
                          const std::optional<Trajectory>& groundtruth, size_t earlier_sessions,
                          bool keeps_islands) {
  const SystemOptions& options = system.options();
  RunContent content;
  content.trajectory = system.trajectory();
  content.map = system.map() != nullptr ? system.map() : std::make_shared<const Map>();
  content.objects = MeasuredObjects(*content.map, options.camera, sequence);
  if (content.map->sessions().size() > earlier_sessions && earlier_sessions > 0) {
    content.objects.changes = system.object_changes();
  }
  content.scene = MakeScene(*content.map, content.objects, groundtruth);
  content.landmarks = LocateLandmarks(*content.map, MakeSensor(options));
  if (keeps_islands) {
    content.islands = system.left_islands();
  }
  return content;
}

void WriteRunFiles(const RunFiles& files, OutputFolder& output) {
  const RunContent& content = files.content;
  const TrajectoryPart trajectory = {.title = files.session.value_or(std::string()),
                                     .poses = AsRead(files.sequence, content.trajectory)};
  output.Write({"settings.yaml", FormatSettings(files.options)});
  output.Write({"trajectory.txt", FormatTrajectory(std::span(&trajectory, 1))});
  output.Write({"keyframes.txt", FormatTrajectory(KeyframeParts(files))});
  output.Write({"map.ply", MapPly(content.landmarks.positions, KeyframeTrajectory(*content.map))});
  WriteIslands(files, output);
  if (files.sequence.converted_groundtruth) {
    output.Write({"groundtruth.txt", FormatTrajectory(*files.sequence.converted_groundtruth)});
  }
  if (files.has_objects) {
    for (const FileContent& file : ObjectFiles(content.objects, content.scene)) {
      output.Write(file);
    }
  }
}

std::string TitleOfSession(size_t number, const std::string& name) {
  return fmt::format("session {}: {}", number, name);
}

std::string IslandSuffix(IslandId island) { return fmt::format("_island{}", island.value + 1); }

}  // namespace hullslam
