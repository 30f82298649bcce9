// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "datasets/row_tools.h"
#include "datasets/rows.h"
#include "hullslam/sequences/tum_sequence.h"
#include "hullslam/util/error.h"
#include "sequences/shared_folder.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

DatasetHelp HelpOfTum(SensorKind sensor) {
  const bool has_depth = sensor == SensorKind::kRgbd;
  return {.sequence = has_depth ? "folder with rgb.txt and depth.txt, or with images in rgb and "
                                  "depth that are named by numbers or time stamps"
                                : "folder with rgb.txt, or with images in rgb that are named by "
                                  "numbers or time stamps",
          .settings =
              "default: camera.yaml in SEQUENCE; without it, the file in config/ that fits "
              "the folder's name, such as TUM1.yaml for freiburg1",
          .associations =
              "stamp rgb stamp depth (default: images are paired by their stamps, at "
              "most 0.02 s apart)"};
}

bool IsTum(const fs::path& folder, SensorKind sensor) {
  try {
    CheckTumFolder(folder);
  } catch (const InputError&) {
    return false;
  }
  if (sensor != SensorKind::kRgbd) {
    return true;
  }
  return IsThere(folder / "rgb.txt")
             ? IsThere(folder / "depth.txt")
             : IsFolderThere(folder / "depth") || FindSharedFolder(folder) != nullptr;
}

// A warning if the settings that the user gave have other intrinsics than those that belong to the
// sequence: camera.yaml in its folder, or the file that is found by its name. Empty if not.
std::string CompareSettings(const fs::path& given, const PinholeCamera& camera,
                            const fs::path& sequence) {
  constexpr double kMost = 0.005;  // of the focal length; a new calibration differs by less
  fs::path file;
  PinholeCamera own;
  try {
    file = FindDefaultSettings(sequence, FindConfigFolder());
    own = ReadSettings(file).camera;
  } catch (const InputError&) {
    return {};  // the sequence has no settings of its own
  }
  for (const auto& [name, value, expected] :
       {std::tuple("fx", camera.fx, own.fx), std::tuple("fy", camera.fy, own.fy),
        std::tuple("cx", camera.cx, own.cx), std::tuple("cy", camera.cy, own.cy)}) {
    if (std::abs(value - expected) > kMost * own.fx) {
      return fmt::format(
          "{}: Camera.{} is {:g}, but the settings of this sequence, {}, have {:g}; are these the "
          "settings of another camera?",
          given.string(), name, value, file.string(), expected);
    }
  }
  return {};
}

// The settings file of the folder, and why it is taken.
std::pair<fs::path, std::string> FindOwnSettings(const fs::path& folder) {
  fs::path found = FindDefaultSettings(folder, FindConfigFolder());
  const bool is_own = found == folder / "camera.yaml";
  return {std::move(found),
          is_own ? "in the folder of the sequence" : "by the name of the folder of the sequence"};
}

OpenedDataset OpenTum(const DatasetRequest& request) {
  if (request.associations.empty()) {
    CheckTumFolder(request.path);  // before a settings file is sought by its name
  }
  auto [file, reason] = request.settings.empty()
                            ? FindOwnSettings(request.path)
                            : std::pair(request.settings, std::string("as --settings says"));
  OpenedDataset opened{.settings = LoadSettings(file, request.preset, request.overrides),
                       .sequence = {},
                       .notes = {DescribeSettings(file, reason)}};
  const SystemOptions& options = opened.settings.options;
  opened.sequence = OpenTumSequence(request.path, {.associations = request.associations,
                                                   .need_images = request.need_images,
                                                   .use_depth = request.sensor == SensorKind::kRgbd,
                                                   .frames_per_second = options.frames_per_second,
                                                   .selection = request.selection});
  if (!request.settings.empty()) {
    if (std::string warning = CompareSettings(file, options.camera, request.path);
        !warning.empty()) {
      opened.sequence.warnings.insert(opened.sequence.warnings.begin(), std::move(warning));
    }
  }
  return opened;
}

ImageSequence OpenTumImages(const ImagesRequest& request) {
  return OpenTumSequence(request.path, {.use_depth = request.use_depth});
}

}  // namespace

Dataset TumDataset() {
  return {.name = "tum",
          .program = "tum",
          .meaning = "a sequence in the format of TUM RGB-D",
          .sensors = {SensorKind::kRgbd, SensorKind::kMonocular},
          .help = HelpOfTum,
          .options = {},
          .is_meant = IsTum,
          .open = OpenTum,
          .open_images = OpenTumImages};
}

}  // namespace hullslam
