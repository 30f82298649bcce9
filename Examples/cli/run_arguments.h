// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "hullslam/io/tum_sequence.h"

namespace hullslam {

// The command line that all programs that run SLAM have in common.
struct RunArguments {
  std::filesystem::path sequence;
  std::filesystem::path settings;    // empty: by the name of the sequence
  std::filesystem::path vocabulary;  // empty: none
  TumSequenceOptions tum;
  std::filesystem::path masks;         // empty: none
  std::string masks_format;            // empty: detected
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path output = "out";
  bool threaded = false;
  bool realtime = false;
  bool strict = false;
  bool quiet = false;
  uint64_t seed = 0;
};

// Adds the options and the positional arguments: SEQUENCE, or ORB-SLAM2's VOCABULARY SETTINGS
// SEQUENCE ASSOCIATIONS. `arguments` must outlive the app; FinishArguments sorts the positional
// ones out.
void AddRunArguments(CLI::App& app, RunArguments& arguments, std::vector<std::string>& positional);
// Throws InputError for another number of positional arguments than 1 or 4.
void FinishArguments(const std::vector<std::string>& positional, RunArguments& arguments);

}  // namespace hullslam
