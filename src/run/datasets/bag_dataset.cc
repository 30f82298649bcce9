// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/bag_dataset.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/util/error.h"
#include "run/load_settings.h"
#include "run/messages.h"

namespace hullslam {
namespace {

class BagDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind sensor) const override {
    return {.sequence =
                "recording of ROS: an MCAP file, a .db3 file or a folder of rosbag2, or a "
                "bag of ROS 1",
            .settings = sensor == SensorKind::kRgbd
                            ? "default: the camera of the recording's CameraInfo, and depth images "
                              "of 16 bits in millimetres"
                            : "default: the camera of the recording's CameraInfo",
            .associations = "not for recordings, whose images are paired by their stamps",
            .groundtruth = "default: none"};
  }

  void AddOptions(CLI::App& app) override {
    app.add_option("--image-topic", options_.image_topic,
                   "topic of the images (default: found by type, encoding and name)")
        ->type_name("TOPIC");
    app.add_option("--depth-topic", options_.depth_topic,
                   "topic of the depth images (default: found likewise; not for monocular SLAM)")
        ->type_name("TOPIC");
    app.add_option("--info-topic", options_.info_topic,
                   "topic of the camera (default: camera_info beside the images)")
        ->type_name("TOPIC");
    app.add_flag("--recording-times", options_.use_recording_times,
                 "take the times at which the messages were recorded, not the stamps in them");
    app.add_option("--float-units", options_.float_units,
                   "values of depth images of the encoding 32FC1 per metre (default: 1; 1000 if "
                   "they are in millimetres)")
        ->type_name("N");
  }

  DatasetInput Open(const RunArguments& arguments) override {
    if (!arguments.associations.empty()) {
      throw InputError(
          "--associations is given, but the images of a recording are paired by their stamps");
    }
    options_.use_depth = arguments.sensor == SensorKind::kRgbd;
    options_.need_camera = arguments.settings.empty();
    options_.selection = arguments.selection;
    BagSequence bag = OpenBagSequence(arguments.sequence, options_);
    for (const std::string& warning : bag.warnings) {
      PrintError("warning: {}\n", warning);
    }
    LoadedSettings loaded = Load(arguments, bag);
    if (!options_.need_camera) {
      bag.notes.push_back(Describe(GivenSettings(arguments.settings)));
    }
    return {.settings = std::move(loaded),
            .sequence = std::move(bag.images),
            .notes = std::move(bag.notes)};
  }

 private:
  static LoadedSettings Load(const RunArguments& arguments, const BagSequence& bag) {
    if (!bag.camera) {
      return LoadSettings(arguments.settings, arguments.preset, arguments.overrides);
    }
    // Depth images of ROS are in millimetres (REP 118). What the user sets comes later and wins.
    std::vector<std::string> overrides = {"DepthMapFactor=1000"};
    overrides.insert(overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
    return LoadSettings(*bag.camera, arguments.sequence.string(), arguments.preset, overrides);
  }

  BagSequenceOptions options_;
};

}  // namespace

std::unique_ptr<Dataset> MakeBagDataset() { return std::make_unique<BagDataset>(); }

}  // namespace hullslam
