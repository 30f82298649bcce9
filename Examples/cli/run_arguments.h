// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/io/tum_sequence.h"

namespace hullslam {

// The command line options that all programs share which run SLAM.
struct RunArguments {
  std::filesystem::path sequence;
  std::filesystem::path settings;    // empty: chosen by FindDefaultSettings()
  std::filesystem::path vocabulary;  // empty: the default one; "none": none
  TumSequenceOptions tum;
  std::filesystem::path masks;         // empty: none
  std::string masks_format;            // empty: detected
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path output = "out";
  std::filesystem::path save_map;  // empty: not saved
  std::filesystem::path load_map;  // empty: a new map
  bool localization = false;
  bool threaded = false;
  bool realtime = false;
  bool strict = false;
  bool quiet = false;
  uint64_t seed = 0;
};

// Adds the options and the positional arguments: SEQUENCE, or ORB-SLAM2's VOCABULARY SETTINGS
// SEQUENCE ASSOCIATIONS. `arguments` and `positional` must outlive the app. Call FinishArguments
// after parsing.
void AddRunArguments(CLI::App& app, RunArguments& arguments, std::vector<std::string>& positional);
// Copies the positional arguments to the fields that they stand for. Throws InputError unless there
// are 1 or 4 of them.
void FinishArguments(const std::vector<std::string>& positional, RunArguments& arguments);

}  // namespace hullslam
