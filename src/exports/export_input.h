// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exports/export_model.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"
#include "map/located_landmarks.h"

namespace hullslam {

// The input of an export, as the user names it.
struct ExportSource {
  std::filesystem::path input;     // the output folder of a run, or a file of --save-map
  std::filesystem::path map;       // of the run; empty: the one that its summary.json names
  std::filesystem::path sequence;  // likewise
};

// How much of a run a format needs. Each level includes the ones before.
enum class ExportNeed { kPoses, kScene, kMap, kImages };

struct MapOfRun {
  Map map;  // with one island only
  Sensor sensor;
  LocatedLandmarks located;
};

struct MasksOfRun {
  std::filesystem::path path;
  std::string format;
};

struct ExportInput {
  ExportModel model;  // `points` are grey
  std::optional<MapOfRun> map;
  std::optional<ImageSequence> sequence;
  std::string session;  // the name of the sequence
  std::optional<MasksOfRun> masks;
  // The files and folders that an export must not be written to.
  std::vector<std::filesystem::path> read;
  std::vector<std::string> notes;  // what is missing, for the user
};

// Reads what a format needs. The map is also used for ExportNeed::kScene if there is one, because
// it tells the colours of the points. Throws InputError, which names the file and what to do, if
// something that the format needs is missing or broken, or if the map is not the run's.
ExportInput ReadExportInput(const ExportSource& source, ExportNeed need);

}  // namespace hullslam
