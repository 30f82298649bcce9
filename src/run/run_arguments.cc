// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/run_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <system_error>

#include "hullslam/map_files/vocabulary_file.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/dataset_arguments.h"
#include "run/more_outputs.h"
#include "run/view_arguments.h"
#include "run/vocabularies.h"

namespace hullslam {
namespace {

// The positional arguments of ORB-SLAM2.
std::string LongForm(SensorKind sensor) {
  return sensor == SensorKind::kMonocular ? "VOCABULARY SETTINGS SEQUENCE"
                                          : "VOCABULARY SETTINGS SEQUENCE ASSOCIATIONS";
}

// Places in the long form.
constexpr size_t kVocabularyPlace = 0;
constexpr size_t kSettingsPlace = 1;
constexpr size_t kSequencePlace = 2;

bool IsSettingsFile(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  std::error_code error;
  return (extension == ".yaml" || extension == ".yml") &&
         std::filesystem::is_regular_file(path, error);
}

bool IsFolder(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_directory(path, error);
}

// Refuses arguments of the long form in another order. Settings files and folders may also be
// something else, so they are refused only if there is none at their own place.
void CheckOrder(const std::vector<std::string>& positional, const std::string& form) {
  const bool has_settings = IsSettingsFile(positional[kSettingsPlace]);
  const bool has_folder = IsFolder(positional[kSequencePlace]);
  const auto refuse = [&](const std::string& argument, const char* kind) {
    throw InputError(argument + " is " + kind + "; the order is " + form);
  };
  for (size_t place = kVocabularyPlace + 1; place < positional.size(); ++place) {
    if (IsVocabularyFile(positional[place])) {
      refuse(positional[place], "a vocabulary");
    }
  }
  for (const std::string& argument : positional) {
    if (!has_settings && IsSettingsFile(argument)) {
      refuse(argument, "a settings file");
    }
    if (!has_folder && IsFolder(argument)) {
      refuse(argument, "a folder");
    }
  }
}

void AddGroundtruth(CLI::App& app, const DatasetHelp& help, RunArguments& arguments) {
  app.add_option("--groundtruth", arguments.groundtruth,
                 "true trajectory, for the error of the run, in any form of docs/outputs.md; none: "
                 "without (" +
                     help.groundtruth + ")")
      ->type_name("FILE");
}

// The options for masks and for lists of images. Those of one kind of sensor are left out unless
// the program has it.
void AddSensorArguments(CLI::App& app, const DatasetHelp& help, bool has_depth, bool has_pairs,
                        RunArguments& arguments) {
  AddSettingsArgument(app, help.settings, arguments.settings);
  app.add_flag("--self-calibrate", arguments.self_calibrate,
               "first calibrate the camera on these images, as `hullslam calibrate` does: from "
               "--settings on if it is given, else from nothing");
  AddPresetArgument(app, arguments.preset);
  AddVocabularyArgument(app, arguments.vocabulary);
  if (has_depth) {
    app.add_option("--associations", arguments.associations,
                   "file with one pair of images per line: " + help.associations);
  }
  AddGroundtruth(app, help, arguments);
  AddMaskArguments(app, arguments.masks, arguments.masks_format);
  if (has_pairs) {
    AddRightMaskArgument(app, arguments.masks_right);
  }
  AddMaskAllArgument(app, arguments.mask_all);
  if (has_pairs) {
    AddRightMaskAllArgument(app, arguments.mask_all_right);
  }
  AddNetworkArguments(app, arguments.segment, arguments.segment_every);
}

// The options that all SLAM programs have.
void AddCommonArguments(CLI::App& app, RunArguments& arguments) {
  AddOverrides(app, arguments.overrides);
  AddOutputArguments(app, arguments.output, arguments.overwrite);
  auto* const save_map =
      app.add_option("--save-map", arguments.save_map,
                     "file for the map at the end of the run; replaces an earlier one");
  auto* const checkpoint = app.add_option("--checkpoint", arguments.checkpoint,
                                          "also save the map so often during the run, s");
  ExpectNumber(*checkpoint->needs(save_map), 0.01, 1e6);
  auto* const load_map = app.add_option(
      "--load-map", arguments.load_map,
      "file of --save-map: the run goes on with this map, as a new session. Tracking "
      "is lost until a frame is found in it");
  app.add_flag("--localization", arguments.localization,
               "only find the poses in the map of --load-map; nothing in it is changed")
      ->needs(load_map);
  app.add_flag("--keep-islands", arguments.keep_islands,
               "also write the parts of the map that could not be joined to the rest after the "
               "camera was lost, each with its own trajectory (trajectory_island2.txt and so on) "
               "and, with --save-map, its own map file");
  app.add_option("--odometry", arguments.odometry,
                 "FILE in TUM's form: poses of the camera by wheels or an inertial sensor, which "
                 "predict poses and bridge images that show too little (odometry.sigma_way)");
  app.add_flag("--live-poses", arguments.live_poses,
               "also write live_poses.txt: poses when they were tracked, covariances, odometry");
  AddMcapOption(app, arguments.mcap);
  app.add_flag("--threaded", arguments.threaded,
               "run mapping in its own thread: faster, but results differ a little between runs");
  app.add_flag("--realtime", arguments.realtime,
               "process the images no faster than the camera took them, by their stamps");
  app.add_option("--seed", arguments.seed,
                 "seed of the random choices in initialisation, relocalisation and loop closing")
      ->check(WholeNumber(0))
      ->capture_default_str();
  AddSelection(app, arguments.selection);
  app.add_flag("--strict", arguments.strict,
               "stop at an image that cannot be read instead of skipping the frame");
  AddReportFlag(app, arguments.report);
  AddViewArguments(app, arguments);
  AddDebugFlag(app);
  app.add_flag("--quiet", arguments.quiet, "print nothing but warnings and errors");
  AddVersionAndExitCodes(
      app, "done",
      "the run failed, was interrupted (the results up to then are written, and summary.json says "
      "so), lost too many frames (run.max_lost_share, run.max_lost_at_end), or could not save its "
      "map or its recording or print its report");
}

}  // namespace

void AddRunArguments(CLI::App& app, const DatasetHelp& help, RunArguments& arguments,
                     std::vector<std::string>& positional) {
  app.add_option("ARGUMENTS", positional,
                 "SEQUENCE: " + help.sequence + "\nor " + LongForm(arguments.sensor) +
                     ", in the order of ORB-SLAM2");
  AddSensorArguments(app, help, arguments.sensor == SensorKind::kRgbd,
                     arguments.sensor == SensorKind::kStereo, arguments);
  AddCommonArguments(app, arguments);
}

void AddAnyRunArguments(CLI::App& app, const DatasetHelp& help, RunArguments& arguments) {
  app.add_option("SEQUENCE", arguments.sequence, help.sequence)->required();
  AddSensorArguments(app, help, true, true, arguments);
  AddCommonArguments(app, arguments);
}

void CheckSensorOptions(const RunArguments& arguments) {
  const auto refuse = [&](const char* option, const std::filesystem::path& given,
                          SensorKind expected) {
    if (!given.empty() && arguments.sensor != expected) {
      throw InputError(fmt::format("{} is given, but the run is {}, expected {}", option,
                                   ToString(arguments.sensor), ToString(expected)));
    }
  };
  refuse("--associations", arguments.associations, SensorKind::kRgbd);
  refuse("--masks-right", arguments.masks_right, SensorKind::kStereo);
  refuse("--mask-all-right", arguments.mask_all_right, SensorKind::kStereo);
}

void FinishArguments(const std::vector<std::string>& positional, RunArguments& arguments) {
  if (positional.size() == 1) {
    arguments.sequence = positional[0];
    return;
  }
  const bool has_associations = arguments.sensor == SensorKind::kRgbd;
  if (positional.size() != (has_associations ? 4 : 3)) {
    throw InputError(std::to_string(positional.size()) +
                     " positional arguments, expected SEQUENCE or " + LongForm(arguments.sensor) +
                     " (see --help)");
  }
  CheckOrder(positional, LongForm(arguments.sensor));
  arguments.vocabulary = positional[kVocabularyPlace];
  arguments.settings = positional[kSettingsPlace];
  arguments.sequence = positional[kSequencePlace];
  if (has_associations) {
    arguments.associations = positional[3];
  }
}

}  // namespace hullslam
