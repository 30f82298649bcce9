// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/kitti_dataset.h"

#include <utility>

#include "hullslam/sequences/stereo_sequence.h"
#include "run/load_settings.h"

namespace hullslam {
namespace {

class KittiLeftDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {.sequence =
                "folder of KITTI's odometry benchmark: image_0 or image_2, calib.txt and "
                "times.txt",
            .settings = "default: the left camera of calib.txt in SEQUENCE",
            .groundtruth =
                "default: groundtruth.txt or poses.txt in SEQUENCE, or poses/NAME.txt "
                "of the data set"};
  }

  DatasetInput Open(const RunArguments& arguments) override {
    LeftSequence sequence = OpenKittiImages(arguments.sequence, arguments.selection);
    if (!arguments.settings.empty()) {
      return {.settings = LoadSettings(arguments.settings, arguments.preset, arguments.overrides),
              .sequence = std::move(sequence.images),
              .notes = {Describe(GivenSettings(arguments.settings))}};
    }
    return {.settings = LoadSettings(sequence.calibration, arguments.sequence.string(),
                                     arguments.preset, arguments.overrides),
            .sequence = std::move(sequence.images),
            .notes = {Describe({"calib.txt", "the camera of the sequence"})}};
  }
};

}  // namespace

std::unique_ptr<Dataset> MakeKittiLeftDataset() { return std::make_unique<KittiLeftDataset>(); }

}  // namespace hullslam
