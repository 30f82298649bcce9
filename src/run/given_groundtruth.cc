// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/given_groundtruth.h"

#include <fmt/format.h>

#include <vector>

#include "hullslam/util/error.h"
#include "run/messages.h"

namespace hullslam {

void UseGivenGroundtruth(const std::filesystem::path& file, const std::string& expected,
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

std::optional<Trajectory> FindGroundtruth(const ImageSequence& sequence) {
  try {
    std::vector<std::string> notes;
    std::optional<Trajectory> truth = ReadGroundtruth(sequence, &notes);
    for (const std::string& note : notes) {
      PrintError("warning: ground truth: {}\n", note);
    }
    return truth;
  } catch (const InputError& error) {
    PrintError("warning: {}; the run goes on without ground truth\n", error.what());
    return std::nullopt;
  }
}

}  // namespace hullslam
