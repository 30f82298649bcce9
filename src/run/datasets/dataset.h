// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "hullslam/sequences/image_sequence.h"
#include "run/load_settings.h"
#include "run/run_arguments.h"

namespace hullslam {

// The data that a SLAM run needs from a data set.
struct DatasetInput {
  LoadedSettings settings;  // the sensor is set by the caller
  ImageSequence sequence;
  std::vector<std::string> notes = {};  // lines that the run prints when its input was checked
};

// A data set on the command line: its help, its own options, and its reader. A new data set is a
// class that implements this interface, and a program in Examples (docs/architecture.md).
class Dataset {
 public:
  Dataset() = default;
  virtual ~Dataset() = default;
  Dataset(const Dataset&) = delete;
  Dataset& operator=(const Dataset&) = delete;

  virtual DatasetHelp Help(SensorKind sensor) const = 0;
  // Adds options that only this data set has.
  virtual void AddOptions(CLI::App& /*app*/) {}
  // The stamps that --groundtruth should have, for the message that they fit no image.
  virtual std::string ExpectedStamps() const { return "stamps of the same clock"; }
  // Whether Open() reads the file of --groundtruth itself.
  virtual bool ReadsGroundtruth() const { return false; }
  // Opens the sequence and reads the settings. May print facts about them. Throws InputError for
  // bad input.
  virtual DatasetInput Open(const RunArguments& arguments) = 0;
};

}  // namespace hullslam
