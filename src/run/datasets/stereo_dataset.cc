// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/stereo_dataset.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <utility>

#include "frame/pair_check.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/stereo_sequence.h"
#include "hullslam/util/error.h"
#include "run/command_line.h"
#include "run/load_settings.h"
#include "run/messages.h"
#include "settings/stereo_settings.h"

namespace hullslam {
namespace {

// Throws InputError for pairs that cannot be used: swapped, twice the same image, not rectified.
void CheckPairs(const std::filesystem::path& path, const ImageSequence& sequence,
                const PinholeCamera& camera) {
  constexpr size_t kPairs = 3;
  PairCheck check;
  for (size_t i = 0; i < std::min(kPairs, sequence.frames.size()); ++i) {
    const ImageInput pair =
        sequence.load(sequence.frames[i * (sequence.frames.size() - 1) / kPairs], camera);
    check.Add(pair.grey, pair.right);
  }
  if (const auto fault = check.FindFault()) {
    throw InputError(path.string() + ": " + *fault);
  }
}

std::string DescribeCamera(const PinholeCamera& camera) {
  return fmt::format("stereo: baseline {:.4f} m, focal length {:.1f} px in the rectified images",
                     camera.bf / camera.fx, camera.fx);
}

DatasetInput Finish(const RunArguments& arguments, LoadedSettings settings, ImageSequence sequence,
                    std::string note) {
  CheckPairs(arguments.sequence, sequence, settings.options.camera);
  std::vector<std::string> notes = {std::move(note), DescribeCamera(settings.options.camera)};
  if (!sequence.stamps_note.empty()) {
    notes.push_back(sequence.stamps_note);
  }
  return {
      .settings = std::move(settings), .sequence = std::move(sequence), .notes = std::move(notes)};
}

// A data set whose files have the calibration of the pair.
class CalibratedPairs final : public Dataset {
 public:
  using Opener = std::function<StereoSequence(const std::filesystem::path&, const FrameSelection&)>;
  CalibratedPairs(DatasetHelp help, std::string source, Opener open)
      : help_(std::move(help)), source_(std::move(source)), open_(std::move(open)) {}

  DatasetHelp Help(SensorKind /*sensor*/) const override { return help_; }

  DatasetInput Open(const RunArguments& arguments) override {
    StereoSequence sequence = open_(arguments.sequence, arguments.selection);
    const SystemOptions own = MakeSettings(sequence.calibration, arguments.sequence.string());
    LoadedSettings settings =
        arguments.settings.empty()
            ? LoadSettings(sequence.calibration, arguments.sequence.string(), arguments.preset,
                           arguments.overrides)
            : LoadSettings(arguments.settings, arguments.preset, arguments.overrides);
    settings.options.camera = own.camera;  // the images are rectified to this camera
    const std::string note = Describe({source_, "the cameras of the sequence"});
    return Finish(arguments, std::move(settings), std::move(sequence.images), note);
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
    const std::shared_ptr<const StereoRectifier> rectifier =
        MakeRectifier(file, settings.options.camera);
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
                  Describe(GivenSettings(file)));
  }
};

}  // namespace

std::unique_ptr<Dataset> MakeEurocStereoDataset() {
  return std::make_unique<CalibratedPairs>(
      DatasetHelp{.sequence = "folder with mav0, in the format ASL, with cam0 and cam1",
                  .settings = "default: the cameras of the two sensor.yaml in SEQUENCE",
                  .groundtruth = "of the rectified left camera; default: "
                                 "state_groundtruth_estimate0 or groundtruth.txt in SEQUENCE"},
      "cam0/sensor.yaml and cam1/sensor.yaml", OpenEurocPairs);
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
