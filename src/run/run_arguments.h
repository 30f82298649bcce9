// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "hullslam/datasets/dataset.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/sequences/image_sequence.h"

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

// The command line options that all SLAM programs share.
struct RunArguments {
  // Not an option: each program sets its own. Monocular programs have no --associations.
  SensorKind sensor = SensorKind::kRgbd;
  std::string program = {};  // its name; not an option either
  std::filesystem::path sequence;
  std::filesystem::path settings;      // empty: chosen by FindDefaultSettings()
  std::filesystem::path vocabulary;    // empty: the default one; "none": none
  std::filesystem::path associations;  // empty: those of the sequence, or images paired by time
  std::filesystem::path groundtruth;   // empty: that of the sequence; "none": none
  FrameSelection selection;
  bool self_calibrate = false;
  std::string preset;                      // a name or a file; empty: none
  std::filesystem::path masks;             // empty: none
  std::string masks_format;                // empty: detected
  std::filesystem::path masks_right = {};  // of the right images of a stereo camera; empty: none
  std::filesystem::path mask_all = {};     // one mask for all images; empty: none
  std::filesystem::path mask_all_right = {};
  std::filesystem::path segment;  // network that makes masks; empty: none
  size_t segment_every = 1;
  std::filesystem::path odometry;  // poses of the camera by wheels or the like; empty: none
  bool live_poses = false;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path output = "out";
  bool overwrite = false;
  std::filesystem::path save_map;                               // empty: not saved
  double checkpoint = std::numeric_limits<double>::infinity();  // s between saved maps
  std::filesystem::path load_map;                               // empty: a new map
  std::filesystem::path mcap;                                   // empty: not written
  bool localization = false;
  bool keep_islands = false;
  bool threaded = false;
  bool realtime = false;
  bool strict = false;
  bool report = false;
  int view_port = -1;  // of --view; -1: no live view
  std::string view_address = "127.0.0.1";
  bool quiet = false;
  uint64_t seed = 0;
};

// Adds the options and the positional arguments: SEQUENCE, or ORB-SLAM2's VOCABULARY SETTINGS
// SEQUENCE ASSOCIATIONS (without ASSOCIATIONS if RunArguments::sensor is monocular). `arguments`
// and `positional` must outlive the app. Call FinishArguments after parsing.
void AddRunArguments(CLI::App& app, const DatasetHelp& help, RunArguments& arguments,
                     std::vector<std::string>& positional);
// The same for a program that reads every data set, with SEQUENCE alone: it has the options of all
// sensors. Call CheckSensorOptions when the sensor is known.
void AddAnyRunArguments(CLI::App& app, const DatasetHelp& help, RunArguments& arguments);
// Throws InputError for options that RunArguments::sensor does not have.
void CheckSensorOptions(const RunArguments& arguments);
// Copies the positional arguments to the fields that they stand for. Throws InputError unless there
// are 1 or 4 of them (1 or 3 for monocular programs).
void FinishArguments(const std::vector<std::string>& positional, RunArguments& arguments);

}  // namespace hullslam
