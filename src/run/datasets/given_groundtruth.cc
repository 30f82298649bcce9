// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/datasets/given_groundtruth.h"

#include <fmt/format.h>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"

namespace hullslam {

void CheckGivenGroundtruth(const std::filesystem::path& file, const ImageSequence& images,
                           const std::string& expected) {
  const Trajectory truth = ReadTrajectory(file);
  const double first = images.frames.front().timestamp;
  const double last = images.frames.back().timestamp;
  if (truth.empty() || truth.back().timestamp < first || truth.front().timestamp > last) {
    throw InputError(fmt::format(
        "{}: {}, but the images are from {:.6f} to {:.6f} s; expected {}", file.string(),
        truth.empty() ? std::string("has no poses")
                      : fmt::format("has poses from {:.6f} to {:.6f} s", truth.front().timestamp,
                                    truth.back().timestamp),
        first, last, expected));
  }
}

}  // namespace hullslam
