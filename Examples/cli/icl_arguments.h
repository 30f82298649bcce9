// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/run_arguments.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/system/options.h"

namespace hullslam {

// What the help of programs says that run on ICL-NUIM.
DatasetHelp IclHelp();

// Adds the options that only ICL-NUIM has. `icl` must outlive the app.
void AddIclArguments(CLI::App& app, IclSequenceOptions& icl);

// The settings of --settings, else camera.yaml in the sequence, else config/ICL.yaml, with the
// overrides of --set. A negative Camera.fy stands for its positive value.
SystemOptions LoadIclOptions(const RunArguments& arguments);

// Opens the sequence, and prints which package it is and how its ground truth is used. Those
// options of `icl` that other data sets have too are taken from `arguments`.
ImageSequence OpenIcl(const RunArguments& arguments, IclSequenceOptions icl,
                      const SystemOptions& options);

// The whole program: parses the command line, opens the sequence and runs SLAM with this sensor.
// Returns the exit code; throws InputError for bad input.
int RunIcl(SensorKind sensor, const std::string& name, const std::string& description, int argc,
           char** argv);

}  // namespace hullslam
