// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/results/trajectory_file.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "files/plausible.h"
#include "files/staged_file.h"
#include "files/text_rows.h"
#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

StampedPose ParsePose(const TextRow& row) {
  constexpr size_t kColumns = 8;
  if (row.columns.size() != kColumns) {
    row.Fail(
        fmt::format("{} columns, expected 8: timestamp tx ty tz qx qy qz qw", row.columns.size()));
  }
  StampedPose pose;
  pose.timestamp = row.Stamp(0);
  Rigid3& world_from_cam = pose.world_from_cam;
  world_from_cam.translation = {row.Number(1, "tx", kMostMetres), row.Number(2, "ty", kMostMetres),
                                row.Number(3, "tz", kMostMetres)};
  world_from_cam.rotation = row.Rotation(7, 4, 5, 6);
  return pose;
}

// The number as it is to be written with 9 decimals: without the sign of a number that becomes 0.
double Rounded(double value) {
  constexpr double kHalf = 5e-10;
  return std::abs(value) <= kHalf ? 0.0 : value;
}

void AppendPoses(const Trajectory& trajectory, std::string& text) {
  for (const StampedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.world_from_cam.translation;
    Eigen::Vector4d q = pose.world_from_cam.rotation.normalized().coeffs();
    Check(t.allFinite() && q.allFinite(), "a number of a pose is not finite");
    if (q.w() < 0.0) {
      q = -q;
    }
    fmt::format_to(std::back_inserter(text),
                   "{:.6f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", pose.timestamp,
                   Rounded(t.x()), Rounded(t.y()), Rounded(t.z()), Rounded(q.x()), Rounded(q.y()),
                   Rounded(q.z()), Rounded(q.w()));
  }
}

}  // namespace

Trajectory ReadTrajectory(const std::filesystem::path& path) {
  Trajectory trajectory;
  ForEachRow(path, [&](const TextRow& row) {
    const StampedPose pose = ParsePose(row);
    if (trajectory.empty() || pose.timestamp > trajectory.back().timestamp) {
      trajectory.push_back(pose);
    } else if (pose.timestamp == trajectory.back().timestamp) {
      trajectory.back() = pose;
    } else {
      row.Fail(fmt::format("time stamp {:.6f} is before the one of the previous pose, {:.6f}",
                           pose.timestamp, trajectory.back().timestamp));
    }
  });
  if (trajectory.empty()) {
    throw InputError(path.string() + ": has no poses");
  }
  return trajectory;
}

Trajectory ReadKeyframes(const std::filesystem::path& path) {
  Trajectory keyframes;
  ForEachRow(path, [&](const TextRow& row) { keyframes.push_back(ParsePose(row)); });
  if (keyframes.empty()) {
    throw InputError(path.string() + ": has no poses");
  }
  return keyframes;
}

std::string FormatTrajectory(const Trajectory& trajectory) {
  const TrajectoryPart part{.title = {}, .poses = trajectory};
  return FormatTrajectory({&part, 1});
}

void WriteTrajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  WriteFileAtomically(path, FormatTrajectory(trajectory));
}

std::string FormatTrajectory(std::span<const TrajectoryPart> parts) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const TrajectoryPart& part : parts) {
    if (!part.title.empty()) {
      text += "# " + ShowText(part.title) + '\n';
    }
    AppendPoses(part.poses, text);
  }
  return text;
}

}  // namespace hullslam
