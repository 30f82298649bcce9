// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/datasets/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "frame/input_check.h"
#include "hullslam/util/error.h"
#include "sequences/resized_images.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// In the order in which more information is used.
constexpr std::array kSensors = {SensorKind::kRgbd, SensorKind::kStereo, SensorKind::kMonocular};

bool Has(const Dataset& dataset, SensorKind sensor) {
  return std::ranges::count(dataset.sensors, sensor) > 0;
}

const Dataset* FindMeant(const fs::path& path, SensorKind sensor) {
  const std::span<const Dataset> all = Datasets();
  const auto found = std::ranges::find_if(all, [&](const Dataset& dataset) {
    return Has(dataset, sensor) && dataset.is_meant(path, sensor);
  });
  return found != all.end() ? &*found : nullptr;
}

const char* OptionOf(SensorKind sensor) {
  switch (sensor) {
    case SensorKind::kRgbd:
      return "--rgbd";
    case SensorKind::kStereo:
      return "--stereo";
    default:
      return "--mono";
  }
}

// " (--mono is possible, too)"; empty if nothing else is.
std::string DescribeOthers(const fs::path& path, SensorKind chosen) {
  std::string others;
  for (const SensorKind sensor : kSensors) {
    if (sensor != chosen && FindMeant(path, sensor) != nullptr) {
      others += (others.empty() ? "" : " and ") + std::string(OptionOf(sensor));
    }
  }
  return others.empty() ? others : fmt::format(" ({} would do, too)", others);
}

// Throws InputError that begins with `path` for pairs that cannot be used: swapped, twice the same
// image, not rectified. Some pairs of the sequence are looked at; a pair that cannot be read is
// reported by the run. Without `need_rows` pairs need not be rectified; else a doubt is a warning.
void CheckPairs(const fs::path& path, bool need_rows, const PinholeCamera& camera,
                ImageSequence& sequence) {
  constexpr size_t kPairs = 3;
  PairCheck check;
  for (size_t i = 0; i < std::min(kPairs, sequence.frames.size()); ++i) {
    try {
      const ImageInput pair =
          sequence.load(sequence.frames[i * (sequence.frames.size() - 1) / kPairs], camera);
      check.Add(pair.grey, pair.right);
    } catch (const InputError&) {
      continue;
    }
  }
  if (const auto fault = check.FindFault(need_rows)) {
    throw InputError(path.string() + ": " + *fault);
  }
  if (const auto doubt = check.FindDoubt(); doubt && need_rows) {
    sequence.warnings.push_back(path.string() + ": " + *doubt);
  }
}

const DatasetOption* FindOption(std::span<const DatasetOption> options, std::string_view key) {
  const auto found =
      std::ranges::find_if(options, [&](const DatasetOption& option) { return option.key == key; });
  return found != options.end() ? &*found : nullptr;
}

}  // namespace

std::span<const Dataset> Datasets() {
  static const std::array kDatasets = {
      BagDataset(),         StereoBagDataset(),    VslamLabDataset(), EurocDataset(),
      EurocStereoDataset(), KittiLeftDataset(),    KittiDataset(),    IclDataset(),
      TumDataset(),         StereoFolderDataset(), VideoDataset()};
  return kDatasets;
}

std::vector<DatasetOption> AllDatasetOptions() {
  std::vector<DatasetOption> all;
  for (const Dataset& dataset : Datasets()) {
    for (const DatasetOption& option : dataset.options) {
      if (std::ranges::none_of(all, [&](const DatasetOption& other) {
            return std::string_view(other.name) == option.name;
          })) {
        all.push_back(option);
      }
    }
  }
  return all;
}

std::vector<DatasetOption> OptionsOfImages() {
  std::vector<DatasetOption> options = AllDatasetOptions();
  std::erase_if(options, [](const DatasetOption& option) {
    const std::string_view key = option.key;
    return key != "image_topic" && key != "times" && key != "side_by_side";
  });
  return options;
}

DatasetHelp HelpOfAnyDataset() {
  return {.sequence =
              "what a SLAM program reads: a sequence of TUM, ICL-NUIM, EuRoC or KITTI, stereo "
              "pairs, a recording of ROS, a video or a folder of images",
          .settings = "default: those of the sequence; a video or a folder of images has none",
          .associations = "stamp rgb stamp depth",
          .groundtruth = "default: that of the sequence"};
}

const Dataset& DatasetOfProgram(std::string_view program, SensorKind sensor) {
  for (const Dataset& dataset : Datasets()) {
    if (program == dataset.program && Has(dataset, sensor)) {
      return dataset;
    }
  }
  throw InputError(fmt::format("there is no {} data set '{}'", ToString(sensor), program));
}

const char* ToString(SensorKind sensor) {
  switch (sensor) {
    case SensorKind::kRgbd:
      return "RGB-D";
    case SensorKind::kStereo:
      return "stereo";
    default:
      return "monocular";
  }
}

std::string ProgramOf(const Dataset& dataset, SensorKind sensor) {
  const char* const prefix = sensor == SensorKind::kRgbd     ? "rgbd"
                             : sensor == SensorKind::kStereo ? "stereo"
                                                             : "mono";
  return fmt::format("{}_{}", prefix, dataset.program);
}

FoundDataset FindDataset(const fs::path& path, std::optional<SensorKind> sensor) {
  if (!IsThere(path)) {
    throw InputError(path.string() + ": no such file or folder, expected a sequence");
  }
  FoundDataset found;
  if (sensor) {
    found = {FindMeant(path, *sensor), *sensor, {}};
  } else {
    for (const SensorKind kind : kSensors) {
      if (found.dataset == nullptr) {
        found = {FindMeant(path, kind), kind, {}};
      }
    }
  }
  if (found.dataset == nullptr) {
    for (const Dataset& dataset : Datasets()) {
      found.dataset = Has(dataset, found.sensor) ? &dataset : found.dataset;
    }
  }
  found.note =
      fmt::format("{}: {}, {}{}", path.string(), found.dataset->meaning, ToString(found.sensor),
                  sensor ? std::string() : DescribeOthers(path, found.sensor));
  return found;
}

FoundDataset FindDataset(const fs::path& path, std::optional<SensorKind> sensor,
                         const DatasetChoices& choices, const fs::path& associations) {
  if (!sensor && !associations.empty()) {
    sensor = SensorKind::kRgbd;
  }
  if (!sensor && choices.contains("side_by_side")) {
    sensor = SensorKind::kStereo;
  }
  FoundDataset found = FindDataset(path, sensor);
  for (const auto& [key, value] : choices) {
    if (FindOption(found.dataset->options, key) == nullptr) {
      const std::vector<DatasetOption> all = AllDatasetOptions();
      throw InputError(fmt::format("--{} is given, but {} is {}, which has no such choice",
                                   FindOption(all, key)->name, path.string(),
                                   found.dataset->meaning));
    }
  }
  return found;
}

OpenedDataset OpenFoundDataset(const std::optional<SensorKind>& sensor, DatasetRequest request) {
  const FoundDataset found =
      FindDataset(request.path, sensor, request.choices, request.associations);
  request.sensor = found.sensor;
  return OpenDataset(*found.dataset, request);
}

OpenedDataset OpenDataset(const Dataset& dataset, const DatasetRequest& request) {
  OpenedDataset opened = dataset.open(request);
  SystemOptions& options = opened.settings.options;
  options.sensor = request.sensor;
  if (request.sensor == SensorKind::kStereo) {
    CheckPairs(request.path, request.need_rows, options.camera, opened.sequence);
    opened.notes.push_back(
        fmt::format("stereo: baseline {:.4f} m, focal length {:.1f} px in the rectified images",
                    options.camera.bf / options.camera.fx, options.camera.fx));
  }
  if (!opened.sequence.stamps_note.empty()) {
    opened.notes.push_back(opened.sequence.stamps_note);
  }
  if (const SettingsNotes& notes = opened.settings.notes; notes.read_width > 0) {
    ResizeImages(notes.read_width, notes.read_height, options.camera, opened.sequence);
    opened.notes.push_back("images are resized from " + opened.sequence.choices["resized_from"]);
  }
  return opened;
}

ImageSequence OpenImages(const fs::path& path, const DatasetChoices& choices) {
  if (choices.contains("side_by_side")) {
    return StereoFolderDataset().open_images({.path = path, .choices = choices});
  }
  for (const Dataset& dataset : Datasets()) {
    // Of a stereo camera these are the left images.
    const SensorKind sensor = dataset.sensors.empty() || Has(dataset, SensorKind::kMonocular)
                                  ? SensorKind::kMonocular
                                  : dataset.sensors.front();
    if (dataset.is_meant(path, sensor)) {
      return dataset.open_images({.path = path, .choices = choices});
    }
  }
  return VideoDataset().open_images({.path = path, .choices = choices});
}

void UseGivenGroundtruth(const fs::path& file, const std::string& expected,
                         ImageSequence& sequence) {
  sequence.groundtruth.reset();
  sequence.converted_groundtruth.reset();
  if (file == "none") {
    return;
  }
  sequence.groundtruth = file;
  const Trajectory truth = ReadGroundtruth(sequence).value();
  const double first = sequence.frames.front().timestamp;
  const double last = sequence.frames.back().timestamp;
  if (truth.back().timestamp < first || truth.front().timestamp > last) {
    throw InputError(fmt::format(
        "{}: has poses from {:.6f} to {:.6f} s, but the images are from {:.6f} to "
        "{:.6f} s; expected {}",
        file.string(), truth.front().timestamp, truth.back().timestamp, first, last, expected));
  }
}

}  // namespace hullslam
