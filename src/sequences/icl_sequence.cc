// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/icl_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "sequences/icl_groundtruth.h"
#include "sequences/image_list.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// Whether the folder has the package of ICL-NUIM for POV-Ray, whose images are scene_NN_NNNN.png.
bool HasPovrayImages(const fs::path& folder) {
  const std::vector<fs::path> files = ListFolder(folder);
  return std::any_of(files.begin(), files.end(), [](const fs::path& file) {
    return file.extension() == ".png" && file.filename().string().starts_with("scene_");
  });
}

fs::path FindAssociations(const fs::path& folder) {
  fs::path path = folder / "associations.txt";
  std::error_code error;
  if (!fs::exists(path, error) && HasPovrayImages(folder)) {
    throw InputError(folder.string() +
                     ": is ICL-NUIM's package for POV-Ray, expected \"TUM RGB-D compatible PNGs\" "
                     "of the same sequence: rgb/N.png, depth/N.png and associations.txt");
  }
  return path;
}

double Index(const TextRow& row, size_t column, std::string_view name) {
  const double index = row.Number(column, name);
  if (index < 0.0 || index != std::floor(index) || index > kMostImages) {
    row.Fail(
        fmt::format("{} is '{}', expected the index of a frame; lists with times in seconds "
                    "are those of TUM",
                    name, row.columns[column]));
  }
  return index;
}

// Whether the file is in a folder of this name.
bool IsIn(const char* folder, std::string_view file) {
  return fs::path(file).parent_path().filename() == folder;
}

FramePaths ParsePair(const TextRow& row, const fs::path& folder) {
  constexpr size_t kColumns = 4;
  CheckColumns(row, kColumns, "index depth index rgb");
  const double index = Index(row, 2, "index of the image");
  if (Index(row, 0, "index of the depth image") != index) {
    row.Fail(fmt::format("the indices '{}' and '{}' differ, expected depth and image of one frame",
                         row.columns[0], row.columns[2]));
  }
  if (IsIn("rgb", row.columns[1]) || IsIn("depth", row.columns[3])) {
    row.Fail(
        fmt::format("the files are '{}' and '{}', expected the depth image first, as in "
                    "ICL-NUIM",
                    row.columns[1], row.columns[3]));
  }
  return {index / kIclFramesPerSecond, ImageFile(row, 3, folder), ImageFile(row, 1, folder)};
}

std::vector<FramePaths> ReadPairs(const fs::path& folder, const fs::path& associations,
                                  std::vector<std::string>& warnings) {
  const fs::path path = associations.empty() ? FindAssociations(folder) : associations;
  ListedFrames list;
  ForEachRow(path, [&](const TextRow& row) { AddFrame(row, ParsePair(row, folder), list); });
  return TakeFrames(path, std::move(list), warnings);
}

// ---- ground truth

std::optional<fs::path> FindGroundtruth(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::path& file : ListFolder(folder)) {
    const std::string name = file.filename().string();
    if (name.ends_with(".gt.freiburg") || name == "groundtruth.txt") {
      files.push_back(file);
    }
  }
  if (files.size() > 1) {
    throw InputError(fmt::format("{}: has {} and {}, expected --groundtruth FILE to say which",
                                 folder.string(), files[0].filename().string(),
                                 files[1].filename().string()));
  }
  return files.empty() ? std::nullopt : std::optional(files.front());
}

struct ChosenAxis {
  bool is_up = true;
  std::string reason;
};

ChosenAxis ChooseAxis(const fs::path& path, const YAxisVotes& votes) {
  const auto percent = [&](size_t pixels) {
    return 100.0 * static_cast<double>(pixels) / static_cast<double>(votes.pixels);
  };
  if (votes.pixels == 0) {
    throw InputError(path.string() +
                     ": no two depth images could be compared with its poses, so it is unclear "
                     "where the y axis of its cameras points; expected --groundtruth-y up or down");
  }
  const double up = percent(votes.both + votes.only_up);
  const double down = percent(votes.both + votes.only_down);
  // If the mirror does not change the motion, both axes predict the same depth.
  constexpr double kSame = 0.5;    // largest % of the pixels that agree with only one of the axes
  constexpr double kLeast = 50.0;  // least % of the pixels that agree with the right axis
  constexpr size_t kFactor = 2;    // how many times more pixels agree with only the right axis
  if (percent(votes.only_up + votes.only_down) < kSame && up >= kLeast) {
    return {true, "as ICL-NUIM says; the depth images agree with y down as well"};
  }
  const bool is_up = votes.only_up > votes.only_down;
  const size_t less = std::min(votes.only_up, votes.only_down);
  if (std::max(up, down) < kLeast || std::max(votes.only_up, votes.only_down) < kFactor * less) {
    throw InputError(fmt::format(
        "{}: {:.0f} % of the depth agrees with poses of cameras whose y axis points up (fy < 0), "
        "and {:.0f} % with y down, so it is unclear; expected --groundtruth-y up or down",
        path.string(), up, down));
  }
  return {is_up,
          fmt::format("{:.0f} % of the depth agrees with y up, {:.0f} % with y down", up, down)};
}

void AddGroundtruth(const fs::path& path, const PinholeCamera& camera, const DepthOptions& depth,
                    CameraYAxis said, IclSequence& sequence) {
  Trajectory trajectory = ReadIndexedTrajectory(path);
  const ChosenAxis axis =
      said == CameraYAxis::kMeasure
          ? ChooseAxis(path, MeasureYAxis(sequence.images, trajectory, camera, depth))
          : ChosenAxis{said == CameraYAxis::kUp, "as --groundtruth-y says"};
  sequence.groundtruth_note = fmt::format("{}, poses of cameras with y {} ({})", path.string(),
                                          axis.is_up ? "up, mirrored" : "down", axis.reason);
  sequence.images.converted_groundtruth =
      axis.is_up ? MirrorY(std::move(trajectory)) : std::move(trajectory);
}

}  // namespace

IclSequence OpenIclSequence(const fs::path& folder, const PinholeCamera& camera,
                            const DepthOptions& depth, const IclSequenceOptions& options) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string() + ": no such folder, expected a sequence of ICL-NUIM");
  }
  IclSequence sequence;
  sequence.images.dataset = "icl";
  sequence.images.frames = ReadPairs(folder, options.associations, sequence.images.warnings);
  SelectFrames(folder, options.selection, sequence.images);
  if (!options.groundtruth.empty()) {
    AddGroundtruth(options.groundtruth, camera, depth, options.groundtruth_y, sequence);
  } else {
    try {
      if (const std::optional<fs::path> file = FindGroundtruth(folder)) {
        AddGroundtruth(*file, camera, depth, options.groundtruth_y, sequence);
      }
    } catch (const InputError& fault) {  // nobody asked for it
      sequence.images.warnings.push_back(
          fmt::format("{}; the run goes on without ground truth", fault.what()));
    }
  }
  if (!options.use_depth) {
    for (FramePaths& frame : sequence.images.frames) {
      frame.depth.clear();
    }
  }
  CheckImagesExist(sequence.images.frames);
  return sequence;
}

}  // namespace hullslam
