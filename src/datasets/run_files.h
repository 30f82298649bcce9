// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hullslam/sequences/image_sequence.h"
#include "hullslam/system/system.h"
#include "map/located_landmarks.h"
#include "report/object_results.h"
#include "results/output_folder.h"
#include "scene/scene.h"

namespace hullslam {

// The results of a run, from which its files are made.
struct RunContent {
  std::shared_ptr<const Map> map;  // not null
  Trajectory trajectory;
  LocatedLandmarks landmarks;
  ObjectResults objects;                // with their fits
  Scene scene;                          // of these objects
  std::span<const LeftIsland> islands;  // those that have files of their own
};

// The results of a run after System::Finish. The map had `earlier_sessions` sessions before. The
// true trajectory may tell what is upwards. The system must outlive them.
RunContent CollectContent(const System& system, const std::string& sequence,
                          const std::optional<Trajectory>& groundtruth, size_t earlier_sessions,
                          bool keeps_islands);

struct RunFiles {
  const RunContent& content;
  const ImageSequence& sequence;
  const SystemOptions& options;
  std::optional<std::string> session;  // its title; absent: the run began with an empty map
  bool has_objects = false;
};

// Writes all files of a run but summary.json (docs/outputs.md): the settings, the trajectories and
// the landmarks, those of the islands, the ground truth if it had to be converted, and the files of
// the objects.
void WriteRunFiles(const RunFiles& files, OutputFolder& output);

// "session 2: desk"
std::string TitleOfSession(size_t number, const std::string& name);
// "_island2" for the second island that was begun: part of the names of its files.
std::string IslandSuffix(IslandId island);

}  // namespace hullslam
