// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/run_sequence.h"

#include <system_error>

#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/sequences/tum_sequence.h"

namespace hullslam {

namespace fs = std::filesystem;

std::optional<fs::path> FindRunInput(const std::string& input, const fs::path& run_folder) {
  std::error_code error;
  if (input.empty()) {
    return std::nullopt;
  }
  if (fs::exists(input, error)) {
    return fs::path(input);
  }
  const fs::path absolute = fs::absolute(run_folder, error);
  for (fs::path folder = absolute; !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / input, error)) {
      return folder / input;
    }
    if (folder == folder.root_path()) {
      break;
    }
  }
  return std::nullopt;
}

ImageSequence OpenRunSequence(const std::string& program, const fs::path& sequence,
                              const PinholeCamera& camera, bool use_depth) {
  if (program.ends_with("_euroc")) {
    return OpenEurocSequence(sequence).images;
  }
  if (program.ends_with("_icl")) {
    return OpenIclSequence(sequence, camera, {}, {.use_depth = use_depth}).images;
  }
  if (program.ends_with("_bag")) {
    return OpenBagSequence(sequence, {.use_depth = use_depth, .need_camera = false}).images;
  }
  if (program.ends_with("_video")) {
    return OpenImageStream(sequence).images;
  }
  return OpenTumSequence(sequence, {.use_depth = use_depth});
}

}  // namespace hullslam
