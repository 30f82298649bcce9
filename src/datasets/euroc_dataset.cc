// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

DatasetHelp HelpOfEuroc(SensorKind /*sensor*/) {
  return {
      .sequence = "folder with mav0, in the format ASL",
      .settings = "default: the camera of cam0/sensor.yaml or a camchain of Kalibr in SEQUENCE",
      .groundtruth = "of the camera; default: state_groundtruth_estimate0 or mocap0 in SEQUENCE"};
}

bool IsEuroc(const fs::path& folder, SensorKind /*sensor*/) {
  return IsThere(folder / "mav0" / "cam0") || IsThere(folder / "cam0" / "data.csv");
}

OpenedDataset OpenEuroc(const DatasetRequest& request) {
  EurocSequence sequence = OpenEurocSequence(request.path, request.selection);
  const bool is_given = !request.settings.empty();
  if (!is_given && !sequence.camera) {
    throw InputError(request.path.string() +
                     ": has neither cam0/sensor.yaml nor a camchain of Kalibr, expected one of "
                     "them or --settings FILE");
  }
  return {
      .settings =
          SettingsOf(request, sequence.camera ? sequence.camera->calibration : CameraCalibration()),
      .sequence = std::move(sequence.images),
      .notes = {is_given ? DescribeGivenSettings(request.settings)
                         : DescribeSettings(sequence.calibration, "the camera of the sequence")}};
}

ImageSequence OpenEurocImages(const ImagesRequest& request) {
  return OpenEurocSequence(request.path).images;
}

}  // namespace

Dataset EurocDataset() {
  return {.name = "euroc",
          .program = "euroc",
          .meaning = "a sequence of EuRoC, in the format ASL",
          .sensors = {SensorKind::kMonocular},
          .help = HelpOfEuroc,
          .options = {},
          .is_meant = IsEuroc,
          .open = OpenEuroc,
          .open_images = OpenEurocImages};
}

}  // namespace hullslam
