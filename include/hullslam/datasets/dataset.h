// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/loaded_settings.h"

namespace hullslam {

// What a data set lets the user choose, by the keys of DatasetOption. ImageSequence::choices has
// the same keys, so that a run can be opened again.
using DatasetChoices = std::map<std::string, std::string>;

// A choice that only some data sets have; on the command line it is the option --NAME.
struct DatasetOption {
  const char* name;     // "image-topic"
  const char* key;      // of the choice, such as "image_topic"
  const char* type;     // of the value, for --help, such as "TOPIC"
  const char* meaning;  // for --help
  // The value of a flag, which is given without one. Null for an option with a value.
  const char* flag = nullptr;
};

// How a data set is to be opened.
struct DatasetRequest {
  std::filesystem::path path;
  SensorKind sensor = SensorKind::kRgbd;
  // Of --settings; empty: the settings of the data set.
  std::filesystem::path settings = {};
  std::string preset = {};                  // as in LoadSettings()
  std::vector<std::string> overrides = {};  // key=value
  std::filesystem::path associations = {};  // pairs of images; empty: found by the data set
  std::filesystem::path groundtruth = {};   // only for data sets with `reads_groundtruth`
  FrameSelection selection = {};
  DatasetChoices choices = {};
  // False for programs that only use masks and poses: then images in TUM's format may be missing.
  bool need_images = true;
  // False for the calibration of a pair, whose points may be in other rows.
  bool need_rows = true;
};

// A sequence and the settings of its camera.
struct OpenedDataset {
  LoadedSettings settings;  // with the sensor
  ImageSequence sequence;
  std::vector<std::string> notes = {};  // facts about the input, for the user
};

// What the images alone need, without settings.
struct ImagesRequest {
  std::filesystem::path path;
  DatasetChoices choices = {};
  const char* origin = "";    // of the choices, for messages, such as " in summary.json"
  PinholeCamera camera = {};  // of the images, if it is known
  bool use_depth = false;
};

// Texts for --help.
struct DatasetHelp {
  std::string sequence;  // describes SEQUENCE
  std::string settings;  // the default of --settings
  // The lines of the file of --associations, and its default; empty without depth images.
  std::string associations = {};
  // The default of --groundtruth.
  std::string groundtruth = "default: groundtruth.txt in SEQUENCE";
};

// A data set. All programs, Python and the tools for finished runs find it in the table of
// Datasets(); a new data set is a row of this table.
struct Dataset {
  const char* name;                 // ImageSequence::dataset, which summary.json has
  const char* program;              // the name without the sensor: "tum" of rgbd_tum and mono_tum
  const char* meaning;              // "a sequence in the format of TUM RGB-D"
  std::vector<SensorKind> sensors;  // empty: its images can be used, but not run
  DatasetHelp (*help)(SensorKind sensor);
  std::span<const DatasetOption> options;
  // Whether this file or folder is such a data set and has the images of the sensor. Reads no more
  // than names, and for recordings their topics. Throws nothing.
  bool (*is_meant)(const std::filesystem::path& path, SensorKind sensor);
  // Reads the settings and opens the sequence. Throws InputError for bad input.
  OpenedDataset (*open)(const DatasetRequest& request);
  // Opens the images without their calibration; of a stereo camera those on the left come as they
  // are stored, unless the choices of a run say how it has rectified them.
  ImageSequence (*open_images)(const ImagesRequest& request);
  // The stamps that the ground truth should have, for the message that they fit no image.
  const char* expected_stamps = "stamps of the same clock";
  bool reads_groundtruth = false;  // open() reads the file of DatasetRequest::groundtruth
};

// The data sets, in the order in which a path is compared with them.
std::span<const Dataset> Datasets();

// The options of all data sets, each once.
std::vector<DatasetOption> AllDatasetOptions();
// Those that decide which images of the input are used, and what their names are.
std::vector<DatasetOption> OptionsOfImages();
// The texts for --help of a program that reads every data set.
DatasetHelp HelpOfAnyDataset();

// The data set of the program SENSOR_NAME, such as rgbd_tum. Throws InputError if there is none.
const Dataset& DatasetOfProgram(std::string_view program, SensorKind sensor);
// The name of this program.
std::string ProgramOf(const Dataset& dataset, SensorKind sensor);

// "RGB-D", "monocular" or "stereo".
const char* ToString(SensorKind sensor);

// What is found at a path.
struct FoundDataset {
  const Dataset* dataset = nullptr;  // not null
  SensorKind sensor = SensorKind::kRgbd;
  // "a sequence in the format of TUM RGB-D; runs RGB-D (--mono is possible too)"
  std::string note;
};

// Finds the data set at a path. Without a sensor, that with the most information is taken: RGB-D,
// then stereo, then monocular. If nothing is recognised, the last data set of the sensor is taken,
// whose error tells what it expects. Throws InputError if nothing is at the path.
FoundDataset FindDataset(const std::filesystem::path& path,
                         std::optional<SensorKind> sensor = std::nullopt);
// The same for a data set that is to be opened with these choices and this file of associations,
// which may be empty. They may tell the sensor. Throws InputError for choices that the data set
// does not have.
FoundDataset FindDataset(const std::filesystem::path& path, std::optional<SensorKind> sensor,
                         const DatasetChoices& choices,
                         const std::filesystem::path& associations = {});

// Opens a data set of this kind: reads the settings, resizes the images if the settings ask for it,
// and checks some pairs of a stereo camera (PairCheck). Throws InputError for bad input.
OpenedDataset OpenDataset(const Dataset& dataset, const DatasetRequest& request);
// Finds the data set at the path of the request, and opens it. The sensor of the request is not
// used.
OpenedDataset OpenFoundDataset(const std::optional<SensorKind>& sensor, DatasetRequest request);

// Opens the images of whatever is at the path; see Dataset::open_images. Throws InputError.
ImageSequence OpenImages(const std::filesystem::path& path, const DatasetChoices& choices = {});

// Gives the sequence the file of --groundtruth in place of its own ground truth; "none" takes the
// own one away. Throws InputError if the file cannot be read, or if no true pose has a stamp during
// the images. `expected` says for the message what the user can do then.
void UseGivenGroundtruth(const std::filesystem::path& file, const std::string& expected,
                         ImageSequence& sequence);

}  // namespace hullslam
