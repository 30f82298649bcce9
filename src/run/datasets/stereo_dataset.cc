// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/stereo_dataset.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "frame/pair_check.h"
#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/load_settings.h"
#include "run/messages.h"
#include "settings/stereo_settings.h"

namespace hullslam {
namespace {

// Throws InputError that begins with `path` for pairs that cannot be used: swapped, twice the same
// image, not rectified. Some pairs of the sequence are looked at.
void CheckPairs(const std::filesystem::path& path, const ImageSequence& sequence,
                const PinholeCamera& camera) {
  constexpr size_t kPairs = 3;
  PairCheck check;
  for (size_t i = 0; i < std::min(kPairs, sequence.frames.size()); ++i) {
    try {
      const ImageInput pair =
          sequence.load(sequence.frames[i * (sequence.frames.size() - 1) / kPairs], camera);
      check.Add(pair.grey, pair.right);
    } catch (const InputError&) {  // the run will report this pair
      continue;
    }
  }
  if (const auto fault = check.FindFault()) {
    throw InputError(path.string() + ": " + *fault);
  }
}

std::string DescribeCamera(const PinholeCamera& camera) {
  return fmt::format("stereo: baseline {:.4f} m, focal length {:.1f} px in the rectified images",
                     camera.bf / camera.fx, camera.fx);
}

// Throws InputError if the settings do not tell how far the cameras are apart.
void CheckBaseline(const std::filesystem::path& file, const LoadedSettings& settings) {
  if (!settings.has_baseline && !HasRightCamera(file)) {
    throw InputError(file.string() +
                     ": has no baseline, expected Camera.bf (the baseline times Camera.fx) or the "
                     "calibration of both cameras");
  }
}

// Throws InputError if images are to be resized that must be rectified.
void CheckNotResized(const std::filesystem::path& file, const LoadedSettings& settings) {
  if (settings.read_width > 0 && MakeRectifier(file, settings.options.camera) != nullptr) {
    throw InputError(file.string() +
                     ": asks for resized images, which is not possible where both images are "
                     "rectified, expected neither Camera.newWidth, Camera.newHeight nor "
                     "Camera.imageScale");
  }
}

// The rectifier of a settings file (MakeRectifier), which is checked.
std::shared_ptr<const StereoRectifier> RectifierOf(const std::filesystem::path& file,
                                                   const LoadedSettings& settings) {
  CheckBaseline(file, settings);
  auto rectifier = MakeRectifier(file, settings.options.camera);
  CheckNotResized(file, settings);
  return rectifier;
}

// Warns of a baseline that no camera has, as that of a file in other units.
void WarnOfBaseline(const PinholeCamera& camera) {
  constexpr double kShortest = 0.01;  // m, of endoscopes
  constexpr double kLongest = 3.0;    // m, of cars
  const double baseline = camera.bf / camera.fx;
  if (baseline < kShortest || baseline > kLongest) {
    PrintError(
        "warning: the baseline is {:.3g} m, expected {} to {} m; Camera.bf is the baseline in "
        "metres times Camera.fx, and the translation between two cameras is in metres\n",
        baseline, kShortest, kLongest);
  }
}

DatasetInput Finish(const RunArguments& arguments, LoadedSettings settings, ImageSequence sequence,
                    std::vector<std::string> notes) {
  CheckPairs(arguments.sequence, sequence, settings.options.camera);
  WarnOfBaseline(settings.options.camera);
  notes.push_back(DescribeCamera(settings.options.camera));
  if (!sequence.stamps_note.empty()) {
    notes.push_back(sequence.stamps_note);
  }
  return {
      .settings = std::move(settings), .sequence = std::move(sequence), .notes = std::move(notes)};
}

// A data set whose files have the calibration of the pair.
class CalibratedPairs final : public Dataset {
 public:
  // The rectifier is that of --settings, which take the place of the calibration; null without.
  using Opener = std::function<StereoSequence(const std::filesystem::path&, const FrameSelection&,
                                              std::shared_ptr<const StereoRectifier> rectifier)>;
  CalibratedPairs(DatasetHelp help, std::string source, Opener open)
      : help_(std::move(help)), source_(std::move(source)), open_(std::move(open)) {}

  DatasetHelp Help(SensorKind /*sensor*/) const override { return help_; }

  DatasetInput Open(const RunArguments& arguments) override {
    std::optional<LoadedSettings> given;
    std::shared_ptr<const StereoRectifier> rectifier;
    if (!arguments.settings.empty()) {
      given = LoadSettings(arguments.settings, arguments.preset, arguments.overrides);
      CheckBaseline(arguments.settings, *given);
      rectifier = MakePairRectifier(arguments.settings, given->options.camera);
      CheckNotResized(arguments.settings, *given);
    }
    StereoSequence sequence = open_(arguments.sequence, arguments.selection, rectifier);
    const SystemOptions own = MakeSettings(sequence.calibration, arguments.sequence.string());
    if (!given) {
      given = LoadSettings(sequence.calibration, arguments.sequence.string(), arguments.preset,
                           arguments.overrides);
    }
    given->options.camera = own.camera;  // the images are rectified to this camera
    std::string note = Describe({source_, "the cameras of the sequence"});
    if (rectifier != nullptr) {
      note = Describe(GivenSettings(arguments.settings));
      sequence.images.choices["calibration"] =
          std::filesystem::absolute(arguments.settings).string();
    }
    return Finish(arguments, std::move(*given), std::move(sequence.images), {note});
  }

 private:
  DatasetHelp help_;
  std::string source_;
  Opener open_;
};

class StereoFolder final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {.sequence =
                "folder with left and right, or a video or folder of images that show both halves "
                "side by side",
            .settings =
                "default: camera.yaml in SEQUENCE; of rectified images with Camera.bf, or with "
                "both cameras as in files of ORB-SLAM2 (LEFT.K ...) and ORB-SLAM3 (Camera2.fx, "
                "Stereo.T_c1_c2)",
            .groundtruth = "default: groundtruth.txt in SEQUENCE"};
  }

  DatasetInput Open(const RunArguments& arguments) override {
    std::filesystem::path file = arguments.settings;
    if (file.empty()) {
      file = arguments.sequence / "camera.yaml";
      std::error_code error;
      if (!std::filesystem::exists(file, error)) {
        throw InputError(arguments.sequence.string() +
                         ": has no camera.yaml, expected --settings FILE with the calibration of "
                         "the stereo camera");
      }
    }
    LoadedSettings settings = LoadSettings(file, arguments.preset, arguments.overrides);
    const std::shared_ptr<const StereoRectifier> rectifier = RectifierOf(file, settings);
    ImageSequence sequence = OpenStereoFolder(
        arguments.sequence, {.rectifier = rectifier,
                             .frames_per_second = settings.options.frames_per_second,
                             .selection = arguments.selection});
    sequence.choices["frames_per_second"] = fmt::format("{}", settings.options.frames_per_second);
    if (rectifier != nullptr) {
      settings.options.camera = rectifier->camera();
      sequence.choices["calibration"] = std::filesystem::absolute(file).string();
    }
    return Finish(arguments, std::move(settings), std::move(sequence),
                  {Describe(GivenSettings(file))});
  }
};

class StereoBag final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {.sequence =
                "recording of ROS with two topics of images: an MCAP file, a .db3 file or a "
                "folder of rosbag2, or a bag of ROS 1",
            .settings = "default: the cameras of the two CameraInfo of the recording",
            .groundtruth = "default: none"};
  }

  void AddOptions(CLI::App& app) override {
    app.add_option(
           "--image-topic", options_.image_topic,
           "topic of the left images (default: of the topics whose names differ by left and "
           "right, infra1 and infra2, cam0 and cam1)")
        ->type_name("TOPIC");
    app.add_option("--right-topic", options_.right_topic,
                   "topic of the right images (default: likewise)")
        ->type_name("TOPIC");
    app.add_option("--info-topic", options_.info_topic,
                   "topic of the left camera (default: camera_info beside the images)")
        ->type_name("TOPIC");
    app.add_option("--right-info-topic", options_.right_info_topic,
                   "topic of the right camera (default: likewise)")
        ->type_name("TOPIC");
    app.add_flag("--recording-times", options_.use_recording_times,
                 "take the times at which the messages were recorded, not the stamps in them");
  }

  DatasetInput Open(const RunArguments& arguments) override {
    options_.need_camera = arguments.settings.empty();
    options_.selection = arguments.selection;
    std::optional<LoadedSettings> given;
    std::shared_ptr<const StereoRectifier> rectifier;
    if (!options_.need_camera) {
      given = LoadSettings(arguments.settings, arguments.preset, arguments.overrides);
      rectifier = RectifierOf(arguments.settings, *given);
    }
    BagPairs bag = OpenBagPairs(arguments.sequence, options_, rectifier);
    for (const std::string& warning : bag.warnings) {
      PrintError("warning: {}\n", warning);
    }
    if (!given) {
      given = LoadSettings(*bag.calibration, arguments.sequence.string(), arguments.preset,
                           arguments.overrides);
      given->options.camera = bag.calibration->camera;  // the images are rectified to this camera
    } else {
      bag.notes.push_back(Describe(GivenSettings(arguments.settings)));
    }
    if (rectifier != nullptr) {
      given->options.camera = rectifier->camera();
      bag.images.choices["calibration"] = std::filesystem::absolute(arguments.settings).string();
    }
    return Finish(arguments, std::move(*given), std::move(bag.images), std::move(bag.notes));
  }

 private:
  BagSequenceOptions options_;
};

}  // namespace

std::unique_ptr<Dataset> MakeStereoBagDataset() { return std::make_unique<StereoBag>(); }

std::unique_ptr<Dataset> MakeEurocStereoDataset() {
  return std::make_unique<CalibratedPairs>(
      DatasetHelp{.sequence = "folder with mav0, in the format ASL, with cam0 and cam1",
                  .settings = "default: the cameras of the two sensor.yaml, or of a camchain of "
                              "Kalibr, in SEQUENCE",
                  .groundtruth = "of the left camera; default: state_groundtruth_estimate0, mocap0 "
                                 "or groundtruth.txt in SEQUENCE"},
      "two sensor.yaml or a camchain", OpenEurocPairs);
}

std::unique_ptr<Dataset> MakeKittiDataset() {
  return std::make_unique<CalibratedPairs>(
      DatasetHelp{.sequence = "folder of KITTI's odometry benchmark: image_0 and image_1, or "
                              "image_2 and image_3, calib.txt and times.txt",
                  .settings = "default: the cameras of calib.txt in SEQUENCE",
                  .groundtruth = "default: groundtruth.txt or poses.txt in SEQUENCE, or "
                                 "poses/NAME.txt of the data set"},
      "calib.txt", OpenKittiPairs);
}

std::unique_ptr<Dataset> MakeStereoFolderDataset() { return std::make_unique<StereoFolder>(); }

}  // namespace hullslam
