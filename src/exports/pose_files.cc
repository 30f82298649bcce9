// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>

#include "exports/single_files.h"

namespace hullslam {

std::string FormatKittiPoses(const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory) {
    const Eigen::Matrix<double, 3, 4> matrix = pose.world_from_cam.ToMatrix();
    for (Eigen::Index i = 0; i < 12; ++i) {
      fmt::format_to(std::back_inserter(text), "{:.9e}{}", matrix(i / 4, i % 4),
                     i < 11 ? ' ' : '\n');
    }
  }
  return text;
}

std::string FormatEurocPoses(const Trajectory& trajectory) {
  std::string text =
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z []\n";
  for (const StampedPose& pose : trajectory) {
    // A double has only 16 digits, so the microseconds of a stamp of today are known, but not the
    // nanoseconds.
    const auto microseconds = static_cast<int64_t>(std::llround(pose.timestamp * 1e6));
    const Eigen::Vector3d& p = pose.world_from_cam.translation;
    const Eigen::Quaterniond& q = pose.world_from_cam.rotation;
    fmt::format_to(std::back_inserter(text),
                   "{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n", microseconds * 1000,
                   p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  return text;
}

}  // namespace hullslam
