// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/video_dataset.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hullslam/sequences/image_stream.h"
#include "hullslam/settings/settings.h"
#include "hullslam/util/error.h"
#include "run/load_settings.h"
#include "run/messages.h"
#include "util/counted.h"

namespace hullslam {
namespace {

class VideoDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {.sequence = "video file, or folder of PNG or JPEG images in the order of their names",
            .settings = "must be given unless --fov is",
            .groundtruth =
                "default: none; its time stamps are those of the images, which "
                "--stamp-offset can move"};
  }

  std::string ExpectedStamps() const override {
    return "--stamp-offset SECONDS, which is added to the stamps of the images";
  }

  void AddOptions(CLI::App& app) override {
    app.add_option("--fps", stream_options_.frames_per_second,
                   "images per second (default: the time stamps of the video; 30 for a folder)")
        ->type_name("N");
    app.add_option("--fov", fov_,
                   "horizontal field of view, for a first try with a camera whose calibration is "
                   "unknown: the lens is taken for free of distortion, so the map may be bent")
        ->type_name("DEGREES");
    app.add_option("--stamp-offset", stream_options_.stamp_offset,
                   "seconds that are added to the time stamps of the images, which begin at 0, for "
                   "example the time at which a recording was started")
        ->type_name("SECONDS");
  }

  DatasetInput Open(const RunArguments& arguments) override {
    CheckCamera(arguments);
    stream_options_.selection = arguments.selection;
    ImageStream stream = OpenImageStream(arguments.sequence, stream_options_);
    LoadedSettings loaded =
        fov_ ? LoadSettings({CameraOfFieldOfView(*fov_, stream.width, stream.height),
                             stream.frames_per_second},
                            "--fov", arguments.preset, arguments.overrides)
             : LoadSettings(arguments.settings, arguments.preset, arguments.overrides);
    if (!arguments.quiet) {
      PrintInput(stream, loaded.options);
    }
    std::vector<std::string> notes;
    if (!fov_) {
      notes.push_back(Describe(GivenSettings(arguments.settings)));
    }
    return {.settings = std::move(loaded),
            .sequence = std::move(stream.images),
            .notes = std::move(notes)};
  }

 private:
  // Throws InputError unless the camera is known in exactly one way.
  void CheckCamera(const RunArguments& arguments) const {
    if (arguments.settings.empty() && !fov_) {
      throw InputError(
          "neither --settings nor --fov is given, expected --settings FILE with the calibration of "
          "the camera, or --fov DEGREES for a first try without it");
    }
    if (!arguments.settings.empty() && fov_) {
      throw InputError(
          "--settings and --fov are both given, expected only one of them, because both say what "
          "the camera is");
    }
  }

  void PrintInput(const ImageStream& stream, const SystemOptions& options) const {
    Print("{} of {}x{} px, {}\n", Counted(stream.images.available, "image"), stream.width,
          stream.height, stream.images.stamps_note);
    if (fov_) {
      Print(
          "camera: a field of view of {:g} degrees (focal length {:.1f} px) without distortion, "
          "good for a first try only; calibrate the camera and use --settings\n",
          *fov_, options.camera.fx);
    }
  }

  ImageStreamOptions stream_options_;
  std::optional<double> fov_;  // degrees, horizontal
};

}  // namespace

std::unique_ptr<Dataset> MakeVideoDataset() { return std::make_unique<VideoDataset>(); }

}  // namespace hullslam
