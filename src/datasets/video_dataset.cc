// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRate = "frames_per_second";
constexpr const char* kOffset = "stamp_offset";

constexpr std::array<DatasetOption, 3> kVideoOptions = {
    {{"fps", kRate, "N",
      "images per second (default: the time stamps of the video; 30 for a folder)"},
     {"fov", "fov", "DEGREES",
      "horizontal field of view, for a first try with a camera whose calibration is unknown: the "
      "lens is taken for free of distortion, so the map may be bent"},
     {"stamp-offset", kOffset, "SECONDS",
      "seconds that are added to the time stamps of the images, which begin at 0, for example the "
      "time at which a recording was started"}}};

DatasetHelp HelpOfVideo(SensorKind /*sensor*/) {
  return {.sequence = "video file, or folder of PNG or JPEG images in the order of their names",
          .settings = "must be given unless --fov is",
          .groundtruth =
              "default: none; its time stamps are those of the images, which "
              "--stamp-offset can move"};
}

// The last row: every file may be a video.
bool IsVideo(const fs::path& path, SensorKind /*sensor*/) { return IsThere(path); }

ImageStreamOptions StreamOptionsOf(const DatasetChoices& choices, const char* origin = "") {
  return {.frames_per_second = NumberOf(choices, kRate, origin),
          .stamp_offset = NumberOf(choices, kOffset, origin).value_or(0.0)};
}

// Throws InputError unless the camera is known in exactly one way.
void CheckCamera(const DatasetRequest& request, const std::optional<double>& fov) {
  if (request.settings.empty() && !fov) {
    throw InputError(
        "neither --settings nor --fov is given, expected --settings FILE with the calibration of "
        "the camera, or --fov DEGREES for a first try without it; " +
        request.path.string() + " is read as a video or a folder of images");
  }
  if (!request.settings.empty() && fov) {
    throw InputError(
        "--settings and --fov are both given, expected only one of them, because both say what "
        "the camera is");
  }
}

OpenedDataset OpenVideoStream(const DatasetRequest& request) {
  const std::optional<double> fov = NumberOf(request.choices, "fov");
  CheckCamera(request, fov);
  ImageStreamOptions options = StreamOptionsOf(request.choices);
  options.selection = request.selection;
  ImageStream stream = OpenImageStream(request.path, options);
  for (const char* const key : {kRate, kOffset}) {
    if (const std::string text = TextOf(request.choices, key); !text.empty()) {
      stream.images.choices[key] = text;
    }
  }
  OpenedDataset opened;
  opened.notes.push_back(fmt::format("{} of {}x{} px", Counted(stream.images.available, "image"),
                                     stream.width, stream.height));
  if (fov) {
    opened.settings = LoadSettings(
        {CameraOfFieldOfView(*fov, stream.width, stream.height), stream.frames_per_second}, "--fov",
        request.preset, request.overrides);
    opened.notes.push_back(fmt::format(
        "camera: a field of view of {:g} degrees (focal length {:.1f} px) without distortion, "
        "good for a first try only; calibrate the camera and use --settings",
        *fov, opened.settings.options.camera.fx));
  } else {
    opened.settings = LoadSettings(request.settings, request.preset, request.overrides);
    opened.notes.push_back(DescribeGivenSettings(request.settings));
  }
  opened.sequence = std::move(stream.images);
  return opened;
}

ImageSequence OpenVideoImages(const ImagesRequest& request) {
  return OpenImageStream(request.path, StreamOptionsOf(request.choices, request.origin)).images;
}

// ---- VSLAM-LAB, whose own program calls HullSLAM's programs (scripts/vslamlab.py)

bool IsVslamLab(const fs::path& path, SensorKind /*sensor*/) {
  return IsThere(path / "rgb.csv") && IsThere(path / "rgb_0");
}

ImageSequence OpenVslamLabImages(const ImagesRequest& request) {
  return OpenImageStream(request.path / "rgb_0").images;
}

}  // namespace

Dataset VslamLabDataset() {
  return {.name = "vslamlab",
          .program = "",
          .meaning = "a sequence of VSLAM-LAB",
          .sensors = {},
          .help = HelpOfVideo,
          .options = {},
          .is_meant = IsVslamLab,
          .open = nullptr,
          .open_images = OpenVslamLabImages};
}

Dataset VideoDataset() {
  return {.name = "video",
          .program = "video",
          .meaning = "a video or a folder of images",
          .sensors = {SensorKind::kMonocular},
          .help = HelpOfVideo,
          .options = kVideoOptions,
          .is_meant = IsVideo,
          .open = OpenVideoStream,
          .open_images = OpenVideoImages,
          .expected_stamps = "--stamp-offset SECONDS, which is added to the stamps of the images"};
}

}  // namespace hullslam
