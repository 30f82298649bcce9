// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/stereo_sequence.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

DatasetHelp HelpOfKittiLeft(SensorKind /*sensor*/) {
  return {.sequence =
              "folder of KITTI's odometry benchmark: image_0 or image_2, calib.txt and "
              "times.txt; or a rectified drive of its raw data",
          .settings = "default: the left camera of calib.txt in SEQUENCE",
          .groundtruth =
              "default: groundtruth.txt or poses.txt in SEQUENCE, or poses/NAME.txt "
              "of the data set"};
}

bool IsKitti(const fs::path& folder, SensorKind /*sensor*/) {
  return IsFolderThere(folder / "image_0") || IsFolderThere(folder / "image_2") ||
         IsFolderThere(folder / "image_00" / "data") || IsFolderThere(folder / "image_02" / "data");
}

OpenedDataset OpenKittiLeft(const DatasetRequest& request) {
  LeftSequence sequence = OpenKittiImages(request.path, request.selection);
  return {.settings = SettingsOf(request, sequence.calibration),
          .sequence = std::move(sequence.images),
          .notes = {request.settings.empty()
                        ? DescribeSettings("the calibration of KITTI", "the camera of the sequence")
                        : DescribeGivenSettings(request.settings)}};
}

ImageSequence OpenKittiLeftImages(const ImagesRequest& request) {
  return OpenKittiImages(request.path).images;
}

}  // namespace

Dataset KittiLeftDataset() {
  return {.name = "kitti_left",
          .program = "kitti",
          .meaning = "a sequence of KITTI's odometry benchmark",
          .sensors = {SensorKind::kMonocular},
          .help = HelpOfKittiLeft,
          .options = {},
          .is_meant = IsKitti,
          .open = OpenKittiLeft,
          .open_images = OpenKittiLeftImages};
}

}  // namespace hullslam
