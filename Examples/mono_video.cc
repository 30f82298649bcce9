// SPDX-License-Identifier: GPL-3.0-or-later
// Runs monocular SLAM on a video file or a folder of images.
#include <optional>

#include "cli/input_warnings.h"
#include "cli/messages.h"
#include "cli/program.h"
#include "cli/run_arguments.h"
#include "cli/slam_run.h"
#include "hullslam/io/image_stream.h"
#include "hullslam/io/settings.h"
#include "hullslam/util/error.h"

namespace {

using FieldOfView = std::optional<double>;  // degrees, horizontal

void AddVideoArguments(CLI::App& app, hullslam::ImageStreamOptions& stream, FieldOfView& fov) {
  app.add_option("--fps", stream.frames_per_second,
                 "images per second (default: the time stamps of the video; 30 for a folder)")
      ->type_name("N");
  app.add_option("--fov", fov,
                 "horizontal field of view, for a first try with a camera whose calibration is "
                 "unknown: the lens is taken for free of distortion, so the map may be bent")
      ->type_name("DEGREES");
}

// Throws InputError unless the camera is known in exactly one way.
void CheckCamera(const hullslam::RunArguments& arguments, const FieldOfView& fov) {
  if (arguments.settings.empty() && !fov) {
    throw hullslam::InputError(
        "neither --settings nor --fov is given, expected --settings FILE with the calibration of "
        "the camera, or --fov DEGREES for a first try without it");
  }
  if (!arguments.settings.empty() && fov) {
    throw hullslam::InputError(
        "--settings and --fov are both given, expected only one of them, because both say what the "
        "camera is");
  }
}

hullslam::SystemOptions LoadVideoOptions(const hullslam::RunArguments& arguments,
                                         const FieldOfView& fov,
                                         const hullslam::ImageStream& stream) {
  hullslam::SystemOptions options =
      fov ? hullslam::LoadSettings(
                {hullslam::CameraOfFieldOfView(*fov, stream.width, stream.height),
                 stream.frames_per_second},
                "--fov", arguments.overrides)
          : hullslam::LoadSettings(arguments.settings, arguments.overrides);
  options.sensor = arguments.sensor;
  return options;
}

void PrintInput(const hullslam::ImageStream& stream, const FieldOfView& fov,
                const hullslam::SystemOptions& options) {
  hullslam::Print("{} images of {}x{} px, {}\n", stream.images.available, stream.width,
                  stream.height, stream.stamps_note);
  if (fov) {
    hullslam::Print(
        "camera: a field of view of {:g} degrees (focal length {:.1f} px) without distortion, good "
        "for a first try only; calibrate the camera and use --settings\n",
        *fov, options.camera.fx);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return hullslam::RunMain(
      [](int count, char** words) {
        CLI::App app("Runs monocular SLAM on a video file or a folder of images.", "mono_video");
        hullslam::RunArguments arguments;
        arguments.sensor = hullslam::SensorKind::kMonocular;
        hullslam::ImageStreamOptions stream_options;
        FieldOfView fov;
        std::vector<std::string> positional;
        hullslam::AddRunArguments(
            app,
            {.sequence = "video file, or folder of PNG or JPEG images in the order of their names",
             .settings = "must be given unless --fov is"},
            arguments, positional);
        AddVideoArguments(app, stream_options, fov);
        if (!hullslam::ParseCommandLine(app, count, words)) {
          return static_cast<int>(hullslam::kDone);
        }
        hullslam::FinishArguments(positional, arguments);
        CheckCamera(arguments, fov);
        stream_options.selection = arguments.selection;
        const hullslam::ImageStream stream =
            hullslam::OpenImageStream(arguments.sequence, stream_options);
        const hullslam::SystemOptions options = LoadVideoOptions(arguments, fov, stream);
        if (!arguments.quiet) {
          PrintInput(stream, fov, options);
        }
        return hullslam::RunSlam(arguments, options, stream.images);
      },
      argc, argv);
}
