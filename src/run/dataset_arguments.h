// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "hullslam/datasets/dataset.h"
#include "hullslam/segmentation/segmenter.h"
#include "segmentation/sequence_masks.h"

namespace CLI {
class App;
}  // namespace CLI

namespace CLI {
class App;
}  // namespace CLI

namespace hullslam {

void AddSelection(CLI::App& app, FrameSelection& selection);  // --first, --last, --stride
// Adds --settings. `rule` is its default in words.
void AddSettingsArgument(CLI::App& app, const std::string& rule, std::filesystem::path& settings);
// Adds --preset.
void AddPresetArgument(CLI::App& app, std::string& preset);

// Adds the options of a data set, whose values become choices. `choices` must outlive the app.
void AddDatasetOptions(CLI::App& app, std::span<const DatasetOption> options,
                       DatasetChoices& choices);

// The arguments of a program that reads every data set.
struct AnyDatasetArguments {
  std::optional<SensorKind> sensor = {};  // empty: the one with the most information
  DatasetChoices choices = {};
};

// Adds --mono, --rgbd, --stereo and the options of all data sets. `arguments` must outlive the app.
void AddAnyDatasetOptions(CLI::App& app, AnyDatasetArguments& arguments);

// Opens a data set, and prints the warnings of its settings.
OpenedDataset OpenDatasetLoudly(const Dataset& dataset, const DatasetRequest& request);

// Finds and opens the data set at the path of the request, as OpenDatasetLoudly() does. The sensor
// and the choices of the request are those of `arguments`.
OpenedDataset OpenAnyDataset(const AnyDatasetArguments& arguments, DatasetRequest request);

// The ground truth of the sequence. SLAM does not need it: what was skipped or converted is printed
// as a warning, and if it cannot be used, so is the reason, and the result is absent.
std::optional<Trajectory> FindGroundtruth(const ImageSequence& sequence);

// Adds --masks and --masks-format, which write to `path` and `format`. Both must outlive the app.
void AddMaskArguments(CLI::App& app, std::filesystem::path& path, std::string& format);
// Adds --masks-right, after AddMaskArguments().
void AddRightMaskArgument(CLI::App& app, std::filesystem::path& path);
// Adds --mask-all, and with a stereo camera --mask-all-right.
void AddMaskAllArgument(CLI::App& app, std::filesystem::path& path);
void AddRightMaskAllArgument(CLI::App& app, std::filesystem::path& path);
// Adds --segment and --segment-every, after AddMaskArguments().
void AddNetworkArguments(CLI::App& app, std::filesystem::path& network, size_t& every);
// Adds the options of a network: --names, --classes, --min-score, --size, --threads and --boxes.
// `options` must outlive the app.
void AddSegmenterOptions(CLI::App& app, SegmenterOptions& options);
// Adds only the option for the format, under the given names, for programs that take the masks as a
// positional argument.
void AddMaskFormat(CLI::App& app, std::string& format, const std::string& names);

// The request for masks of the images of a sequence as they are read. `camera` is that of the
// images that the sequence gives. Throws InputError for a format without a path.
MaskRequest RequestOf(const std::filesystem::path& path, const std::string& format,
                      const ImageSequence& sequence, const PinholeCamera& camera);

}  // namespace hullslam
