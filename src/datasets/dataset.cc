// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/datasets/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "frame/pair_check.h"
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
// reported by the run.
void CheckPairs(const fs::path& path, const ImageSequence& sequence, const PinholeCamera& camera) {
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
  if (const auto fault = check.FindFault()) {
    throw InputError(path.string() + ": " + *fault);
  }
}

}  // namespace

std::span<const Dataset> Datasets() {
  static const std::array kDatasets = {
      BagDataset(),         StereoBagDataset(),    VslamLabDataset(), EurocDataset(),
      EurocStereoDataset(), KittiLeftDataset(),    KittiDataset(),    IclDataset(),
      TumDataset(),         StereoFolderDataset(), VideoDataset()};
  return kDatasets;
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

OpenedDataset OpenDataset(const Dataset& dataset, const DatasetRequest& request) {
  OpenedDataset opened = dataset.open(request);
  SystemOptions& options = opened.settings.options;
  options.sensor = request.sensor;
  if (request.sensor == SensorKind::kStereo) {
    CheckPairs(request.path, opened.sequence, options.camera);
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

}  // namespace hullslam
