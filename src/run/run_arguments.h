// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/frame/sensor.h"
#include "hullslam/sequences/image_sequence.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// The command line options that all programs share which run SLAM.
struct RunArguments {
  // Not an option: each program has its own. A monocular one has no associations of depth images.
  SensorKind sensor = SensorKind::kRgbd;
  std::string program = {};  // its name; not an option either
  std::filesystem::path sequence;
  std::filesystem::path settings;      // empty: chosen by FindDefaultSettings()
  std::filesystem::path vocabulary;    // empty: the default one; "none": none
  std::filesystem::path associations;  // empty: those of the sequence, or images paired by time
  FrameSelection selection;
  std::filesystem::path masks;         // empty: none
  std::string masks_format;            // empty: detected
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path output = "out";
  bool overwrite = false;
  std::filesystem::path save_map;  // empty: not saved
  std::filesystem::path load_map;  // empty: a new map
  bool localization = false;
  bool threaded = false;
  bool realtime = false;
  bool strict = false;
  bool quiet = false;
  uint64_t seed = 0;
};

// What the help says about the data set of a program.
struct DatasetHelp {
  std::string sequence;  // what SEQUENCE is
  std::string settings;  // what is used without --settings
  // The lines of the file of --associations, and what is used without it; not for monocular
  // cameras.
  std::string associations = {};
};

// Adds the options and the positional arguments: SEQUENCE, or ORB-SLAM2's VOCABULARY SETTINGS
// SEQUENCE ASSOCIATIONS (without ASSOCIATIONS if RunArguments::sensor is monocular). `arguments`
// and `positional` must outlive the app. Call FinishArguments after parsing.
void AddRunArguments(CLI::App& app, const DatasetHelp& help, RunArguments& arguments,
                     std::vector<std::string>& positional);
// Copies the positional arguments to the fields that they stand for. Throws InputError unless there
// are 1 or 4 of them, 1 or 3 for a monocular camera.
void FinishArguments(const std::vector<std::string>& positional, RunArguments& arguments);

}  // namespace hullslam
