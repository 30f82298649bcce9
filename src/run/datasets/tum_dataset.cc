// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/tum_dataset.h"

#include <string>
#include <utility>
#include <vector>

#include "hullslam/sequences/tum_sequence.h"
#include "run/input_warnings.h"
#include "run/load_settings.h"

namespace hullslam {
namespace {

class TumDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind sensor) const override {
    const bool has_depth = sensor == SensorKind::kRgbd;
    return {.sequence = has_depth ? "folder with rgb.txt and depth.txt, or with images in rgb and "
                                    "depth that are named by numbers or time stamps"
                                  : "folder with rgb.txt, or with images in rgb that are named by "
                                    "numbers or time stamps",
            .settings = kTumSettingsRule,
            .associations =
                "stamp rgb stamp depth (default: images are paired by their stamps, at "
                "most 0.02 s apart)"};
  }

  DatasetInput Open(const RunArguments& arguments) override {
    if (arguments.associations.empty()) {
      CheckTumFolder(arguments.sequence);  // before a settings file is sought by its name
    }
    const SettingsChoice settings = ChooseTumSettings(arguments.settings, arguments.sequence);
    LoadedSettings loaded = LoadSettings(settings.file, arguments.preset, arguments.overrides);
    const SystemOptions& options = loaded.options;
    ImageSequence sequence =
        OpenTumSequence(arguments.sequence, {.associations = arguments.associations,
                                             .use_depth = arguments.sensor == SensorKind::kRgbd,
                                             .frames_per_second = options.frames_per_second,
                                             .selection = arguments.selection});
    if (!arguments.settings.empty()) {
      WarnOfOtherSettings(arguments.settings, options.camera, arguments.sequence);
    }
    std::vector<std::string> notes = {Describe(settings)};
    if (!sequence.stamps_note.empty()) {
      notes.push_back(sequence.stamps_note);
    }
    return {
        .settings = std::move(loaded), .sequence = std::move(sequence), .notes = std::move(notes)};
  }
};

}  // namespace

std::unique_ptr<Dataset> MakeTumDataset() { return std::make_unique<TumDataset>(); }

}  // namespace hullslam
