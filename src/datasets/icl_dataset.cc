// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array<DatasetOption, 1> kIclOptions = {
    {{"groundtruth-y", "groundtruth_y", "NAME",
      "up or down: direction of the y axis of the ground truth's cameras; with up (fy < 0) the "
      "ground truth is mirrored (default: the direction that agrees with the depth images)"}}};

DatasetHelp HelpOfIcl(SensorKind /*sensor*/) {
  return {.sequence = "folder of ICL-NUIM with rgb/N.png, depth/N.png and associations.txt",
          .settings = "default: camera.yaml in SEQUENCE; without it, config/ICL.yaml",
          .associations = "index depth index rgb (default: associations.txt in SEQUENCE)",
          .groundtruth =
              "TUM's format with indices of frames as time stamps; default: *.gt.freiburg or "
              "groundtruth.txt in SEQUENCE"};
}

// Folders of TUM have a list of their images, or images whose names are not whole numbers.
bool IsIcl(const fs::path& folder, SensorKind sensor) {
  const auto has_frame = [&](const char* images) {
    return IsThere(folder / images / "0.png") || IsThere(folder / images / "1.png");
  };
  return IsThere(folder / "associations.txt") && !IsThere(folder / "rgb.txt") && has_frame("rgb") &&
         (sensor != SensorKind::kRgbd || has_frame("depth"));
}

CameraYAxis ReadYAxis(const DatasetChoices& choices) {
  const std::string text = TextOf(choices, "groundtruth_y");
  if (text.empty()) {
    return CameraYAxis::kMeasure;
  }
  if (text != "up" && text != "down") {
    throw InputError(fmt::format("--groundtruth-y is '{}', expected up or down", ShowText(text)));
  }
  return text == "up" ? CameraYAxis::kUp : CameraYAxis::kDown;
}

std::pair<fs::path, std::string> ChooseIclSettings(const DatasetRequest& request) {
  if (!request.settings.empty()) {
    return {request.settings, "as --settings says"};
  }
  if (fs::path own = request.path / "camera.yaml"; IsThere(own)) {
    return {std::move(own), "in the folder of the sequence"};
  }
  return {FindConfigFolder() / "ICL.yaml", "the camera of ICL-NUIM"};
}

// A negative Camera.fy in the settings is replaced by its positive value.
OpenedDataset OpenIcl(const DatasetRequest& request) {
  const auto [file, reason] = ChooseIclSettings(request);
  OpenedDataset opened{
      .settings = LoadSettings(file, request.preset, request.overrides, NegativeFy::kPositive),
      .sequence = {},
      .notes = {}};
  const bool has_truth = request.groundtruth != "none";
  const SystemOptions& options = opened.settings.options;
  IclSequence icl = OpenIclSequence(request.path, options.camera, options.depth,
                                    {.associations = request.associations,
                                     .groundtruth = has_truth ? request.groundtruth : fs::path(),
                                     .groundtruth_y = ReadYAxis(request.choices),
                                     .use_depth = request.sensor == SensorKind::kRgbd,
                                     .selection = request.selection});
  opened.sequence = std::move(icl.images);
  opened.notes = {
      "ground truth: " +
          (icl.groundtruth_note.empty() || !has_truth ? std::string("none") : icl.groundtruth_note),
      DescribeSettings(file, reason)};
  return opened;
}

// Without a camera the depth images cannot tell where the y axis of the ground truth points.
ImageSequence OpenIclImages(const ImagesRequest& request) {
  if (request.camera.width == 0) {
    return OpenTumSequence(request.path, {.use_depth = request.use_depth});
  }
  return OpenIclSequence(
             request.path, request.camera, {},
             {.groundtruth_y = ReadYAxis(request.choices), .use_depth = request.use_depth})
      .images;
}

}  // namespace

Dataset IclDataset() {
  return {.name = "icl",
          .program = "icl",
          .meaning = "a sequence of ICL-NUIM",
          .sensors = {SensorKind::kRgbd, SensorKind::kMonocular},
          .help = HelpOfIcl,
          .options = kIclOptions,
          .is_meant = IsIcl,
          .open = OpenIcl,
          .open_images = OpenIclImages,
          .reads_groundtruth = true};
}

}  // namespace hullslam
