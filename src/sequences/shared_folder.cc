// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/shared_folder.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "files/plausible.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "results/pose_file.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kColourOf7Scenes = ".color.";

void NoteMissing(const std::string& reason, FramePoses& read) {
  ++read.missing;
  read.reason = read.missing == 1 ? reason : read.reason;
}

// The matrix world from camera, as four rows of four numbers.
Rigid3 ReadMatrixFile(const fs::path& path) {
  constexpr const char* kExpected =
      "expected four rows of four numbers, which are a rotation and a translation";
  Eigen::Matrix4d matrix;
  Eigen::Index rows = 0;
  ForEachRow(path, [&](const TextRow& row) {
    if (row.columns.size() != 4 || rows == 4) {
      row.Fail(kExpected);
    }
    for (Eigen::Index j = 0; j < 4; ++j) {
      matrix(rows, j) = row.Number(static_cast<size_t>(j), "an element", kMostMetres);
    }
    ++rows;
  });
  const std::optional<Rigid3> pose =
      rows == 4 ? PoseOfMatrix(matrix.topRows<3>()) : std::optional<Rigid3>();
  if (!pose) {
    throw InputError(fmt::format("{}: is no matrix of a pose, {}", path.string(), kExpected));
  }
  return *pose;
}

FramePoses Read7Scenes(const fs::path& folder, std::span<const FramePaths> frames,
                       double /*frames_per_second*/) {
  FramePoses read;
  for (const FramePaths& frame : frames) {
    const std::string image = frame.image.filename().string();
    const fs::path path = folder / (image.substr(0, image.find(kColourOf7Scenes)) + ".pose.txt");
    std::error_code unreadable;
    read.has_files = read.has_files || fs::exists(path, unreadable);
    try {
      read.poses.push_back({frame.timestamp, ReadMatrixFile(path)});
    } catch (const InputError& error) {
      NoteMissing(error.what(), read);
    }
  }
  return read;
}

FramePoses ReadReplica(const fs::path& folder, std::span<const FramePaths> frames,
                       double frames_per_second) {
  const fs::path path = folder / "traj.txt";
  std::error_code unreadable;
  FramePoses read{.has_files = fs::exists(path, unreadable)};
  std::unordered_map<long, Rigid3> rows;
  try {
    for (const StampedPose& row : ReadPoseFile(path).poses) {
      rows.emplace(std::lround(row.timestamp), row.world_from_cam);
    }
  } catch (const InputError& error) {
    read.missing = frames.size();
    read.reason = error.what();
    return read;
  }
  for (const FramePaths& frame : frames) {
    const long number = std::lround(frame.timestamp * frames_per_second);
    if (const auto found = rows.find(number); found != rows.end()) {
      read.poses.push_back({frame.timestamp, found->second});
    } else {
      NoteMissing(fmt::format("{}: row {} has no pose", path.string(), number + 1), read);
    }
  }
  return read;
}

constexpr std::array<SharedFolder, 2> kSharedFolders = {
    {{"7-Scenes", "", kColourOf7Scenes, ".depth.", Read7Scenes},
     {"Replica", "results", "frame", "depth", ReadReplica}}};

}  // namespace

const SharedFolder* FindSharedFolder(const fs::path& folder) {
  for (const SharedFolder& shared : kSharedFolders) {
    std::error_code error;
    bool has_colour = false;
    bool has_depth = false;
    for (fs::directory_iterator entry(folder / shared.folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      has_colour = has_colour || name.find(shared.colour) != std::string::npos;
      has_depth = has_depth || name.find(shared.depth) != std::string::npos;
      if (has_colour && has_depth) {
        return &shared;
      }
    }
  }
  return nullptr;
}

std::optional<Trajectory> ReadSharedPoses(const SharedFolder& shared, const fs::path& folder,
                                          std::span<const FramePaths> frames,
                                          double frames_per_second,
                                          std::vector<std::string>& warnings) {
  FramePoses read = shared.read_poses(folder, frames, frames_per_second);
  if (!read.has_files) {
    return std::nullopt;
  }
  if (read.missing > 0) {
    warnings.push_back(fmt::format("{} of {} frames have no true pose, the first because of: {}",
                                   read.missing, frames.size(), read.reason));
  }
  return read.poses.empty() ? std::nullopt : std::optional(std::move(read.poses));
}
}  // namespace hullslam
