// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/euroc_dataset.h"

#include <utility>

#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/util/error.h"
#include "run/load_settings.h"

namespace hullslam {
namespace {

class EurocDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {
        .sequence = "folder with mav0, in the format ASL",
        .settings = "default: the camera of cam0/sensor.yaml or a camchain of Kalibr in SEQUENCE",
        .groundtruth = "of the camera; default: state_groundtruth_estimate0 or mocap0 in SEQUENCE"};
  }

  DatasetInput Open(const RunArguments& arguments) override {
    EurocSequence sequence = OpenEurocSequence(arguments.sequence, arguments.selection);
    if (!arguments.settings.empty()) {
      return {.settings = LoadSettings(arguments.settings, arguments.preset, arguments.overrides),
              .sequence = std::move(sequence.images),
              .notes = {Describe(GivenSettings(arguments.settings))}};
    }
    if (!sequence.camera) {
      throw InputError(arguments.sequence.string() +
                       ": has neither cam0/sensor.yaml nor a camchain of Kalibr, expected one of "
                       "them or --settings FILE");
    }
    return {.settings = LoadSettings(sequence.camera->calibration, arguments.sequence.string(),
                                     arguments.preset, arguments.overrides),
            .sequence = std::move(sequence.images),
            .notes = {Describe({sequence.calibration, "the camera of the sequence"})}};
  }
};

}  // namespace

std::unique_ptr<Dataset> MakeEurocDataset() { return std::make_unique<EurocDataset>(); }

}  // namespace hullslam
