// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/icl_dataset.h"

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <utility>

#include "hullslam/sequences/icl_sequence.h"
#include "run/command_line.h"
#include "run/load_settings.h"
#include "run/messages.h"

namespace hullslam {
namespace {

// Adds an option whose value is one of the names. The field is set to the enumerator of this name.
template <typename Enum>
void AddNamed(CLI::App& app, const std::string& option, const std::map<std::string, Enum>& values,
              Enum& field, const std::string& help) {
  app.add_option_function<std::string>(
         option, [&field, values](const std::string& name) { field = values.at(name); }, help)
      ->check(CLI::IsMember(values).description(""))
      ->type_name("NAME");
}

class IclDataset final : public Dataset {
 public:
  DatasetHelp Help(SensorKind /*sensor*/) const override {
    return {.sequence = "folder of ICL-NUIM with rgb/N.png, depth/N.png and associations.txt",
            .settings = "default: camera.yaml in SEQUENCE; without it, config/ICL.yaml",
            .associations = "index depth index rgb (default: associations.txt in SEQUENCE)",
            .groundtruth =
                "TUM's format with indices of frames as time stamps; default: *.gt.freiburg or "
                "groundtruth.txt in SEQUENCE"};
  }

  bool ReadsGroundtruth() const override { return true; }

  void AddOptions(CLI::App& app) override {
    AddNamed<CameraYAxis>(
        app, "--groundtruth-y", {{"up", CameraYAxis::kUp}, {"down", CameraYAxis::kDown}},
        icl_.groundtruth_y,
        "direction of the y axis of the ground truth's cameras; with up (fy < 0) the ground truth "
        "is mirrored (default: the direction that agrees with the depth images)");
  }

  // A negative Camera.fy in the settings is replaced by its positive value.
  DatasetInput Open(const RunArguments& arguments) override {
    const SettingsChoice settings = ChooseIclSettings(arguments.settings, arguments.sequence);
    LoadedSettings loaded =
        LoadSettings(settings.file, arguments.preset, arguments.overrides, NegativeFy::kPositive);
    icl_.associations = arguments.associations;
    icl_.groundtruth = arguments.groundtruth == "none" ? "" : arguments.groundtruth;
    icl_.use_depth = arguments.sensor == SensorKind::kRgbd;
    icl_.selection = arguments.selection;
    IclSequence sequence =
        OpenIclSequence(arguments.sequence, loaded.options.camera, loaded.options.depth, icl_);
    if (!arguments.quiet) {
      Print("ground truth: {}\n",
            sequence.groundtruth_note.empty() || arguments.groundtruth == "none"
                ? "none"
                : sequence.groundtruth_note);
    }
    return {.settings = std::move(loaded),
            .sequence = std::move(sequence.images),
            .notes = {Describe(settings)}};
  }

 private:
  IclSequenceOptions icl_;
};

}  // namespace

std::unique_ptr<Dataset> MakeIclDataset() { return std::make_unique<IclDataset>(); }

}  // namespace hullslam
