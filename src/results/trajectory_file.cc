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

// The seven numbers of a pose in TUM's order.
void AppendPose(const Rigid3& pose, std::string& text) {
  const Eigen::Vector3d& t = pose.translation;
  Eigen::Vector4d q = pose.rotation.normalized().coeffs();
  Check(t.allFinite() && q.allFinite(), "a number of a pose is not finite");
  if (q.w() < 0.0) {
    q = -q;
  }
  fmt::format_to(std::back_inserter(text), " {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}",
                 Rounded(t.x()), Rounded(t.y()), Rounded(t.z()), Rounded(q.x()), Rounded(q.y()),
                 Rounded(q.z()), Rounded(q.w()));
}

void AppendPoses(const Trajectory& trajectory, std::string& text) {
  for (const StampedPose& pose : trajectory) {
    fmt::format_to(std::back_inserter(text), "{:.6f}", pose.timestamp);
    AppendPose(pose.world_from_cam, text);
    text += '\n';
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

std::string FormatLivePoses(std::span<const TrackedFrame> frames) {
  std::string text = "# timestamp tx ty tz qx qy qz qw";
  for (int row = 1; row <= 6; ++row) {
    for (int column = row; column <= 6; ++column) {
      text += fmt::format(" c{}{}", row, column);
    }
  }
  text +=
      " odom_tx odom_ty odom_tz odom_qx odom_qy odom_qz odom_qw vx vy vz wx wy wz step "
      "corrected_at "
      "pose_quality prior\n";
  for (const TrackedFrame& frame : frames) {
    if (frame.state != TrackingState::kTracked || !frame.odometry) {
      continue;
    }
    const Odometry& odometry = *frame.odometry;
    fmt::format_to(std::back_inserter(text), "{:.6f}", frame.timestamp);
    AppendPose(frame.world_from_cam(), text);
    const Eigen::Matrix<double, 6, 6> covariance =
        frame.covariance.value_or(Eigen::Matrix<double, 6, 6>::Zero());
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = row; column < 6; ++column) {
        fmt::format_to(std::back_inserter(text), " {:.6g}", covariance(row, column));
      }
    }
    AppendPose(odometry.odom_from_cam, text);
    const Eigen::Vector3d& v = odometry.linear_velocity;
    const Eigen::Vector3d& w = odometry.angular_velocity;
    fmt::format_to(std::back_inserter(text),
                   " {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {} {} {:.3f} {}\n", v.x(), v.y(),
                   v.z(), w.x(), w.y(), w.z(), ToString(odometry.step), odometry.corrected_at.value,
                   frame.quality, ToString(frame.prior));
  }
  return text;
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
