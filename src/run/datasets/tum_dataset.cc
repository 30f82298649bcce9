// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/tum_dataset.h"

#include <utility>

#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/settings/settings.h"
#include "run/input_warnings.h"

namespace hullslam {
namespace {

class TumDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind sensor) const override {
    const bool has_depth = sensor == SensorKind::kRgbd;
    return {.sequence = has_depth ? "folder with rgb.txt and depth.txt" : "folder with rgb.txt",
            .settings =
                "default: camera.yaml in SEQUENCE; without it, the file in config/ that "
                "fits the folder's name, such as TUM1.yaml for freiburg1",
            .associations =
                "stamp rgb stamp depth (default: images are paired by their stamps, at "
                "most 0.02 s apart)"};
  }

  DatasetInput Open(const RunArguments& arguments) override {
    ImageSequence sequence =
        OpenTumSequence(arguments.sequence, {.associations = arguments.associations,
                                             .use_depth = arguments.sensor == SensorKind::kRgbd,
                                             .selection = arguments.selection});
    return {
        .options = LoadSettings(arguments.settings.empty()
                                    ? FindDefaultSettings(arguments.sequence, FindConfigFolder())
                                    : arguments.settings,
                                arguments.overrides),
        .sequence = std::move(sequence)};
  }
};

}  // namespace

std::unique_ptr<Dataset> MakeTumDataset() { return std::make_unique<TumDataset>(); }

}  // namespace hullslam
