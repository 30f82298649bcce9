// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/euroc_dataset.h"

#include <utility>

#include "hullslam/sequences/euroc_sequence.h"
#include "run/load_settings.h"

namespace hullslam {
namespace {

class EurocDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {.sequence = "folder with mav0, in the format ASL",
            .settings = "default: the camera of cam0/sensor.yaml in SEQUENCE",
            .groundtruth = "of the camera; default: state_groundtruth_estimate0 in SEQUENCE"};
  }

  DatasetInput Open(const RunArguments& arguments) override {
    EurocSequence sequence = OpenEurocSequence(arguments.sequence, arguments.selection);
    if (!arguments.settings.empty()) {
      return {.settings = LoadSettings(arguments.settings, arguments.preset, arguments.overrides),
              .sequence = std::move(sequence.images),
              .notes = {Describe(GivenSettings(arguments.settings))}};
    }
    return {.settings = LoadSettings(sequence.camera.calibration, arguments.sequence.string(),
                                     arguments.preset, arguments.overrides),
            .sequence = std::move(sequence.images),
            .notes = {Describe({"cam0/sensor.yaml", "the camera of the sequence"})}};
  }
};

}  // namespace

std::unique_ptr<Dataset> MakeEurocDataset() { return std::make_unique<EurocDataset>(); }

}  // namespace hullslam
