// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/run_sequence.h"

#include <system_error>

#include "hullslam/sequences/bag_sequence.h"
#include "hullslam/sequences/euroc_sequence.h"
#include "hullslam/sequences/icl_sequence.h"
#include "hullslam/sequences/image_stream.h"
#include "hullslam/sequences/tum_sequence.h"

namespace hullslam {

namespace fs = std::filesystem;

std::optional<fs::path> FindSequence(const std::string& sequence, const fs::path& run_folder) {
  std::error_code error;
  if (sequence.empty()) {
    return std::nullopt;
  }
  if (fs::exists(sequence, error)) {
    return fs::path(sequence);
  }
  const fs::path absolute = fs::absolute(run_folder, error);
  for (fs::path folder = absolute; !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / sequence, error)) {
      return folder / sequence;
    }
    if (folder == folder.root_path()) {
      break;
    }
  }
  return std::nullopt;
}

ImageSequence OpenRunSequence(const std::string& program, const fs::path& sequence,
                              const PinholeCamera& camera) {
  if (program.ends_with("_euroc")) {
    return OpenEurocSequence(sequence).images;
  }
  if (program.ends_with("_icl")) {
    return OpenIclSequence(sequence, camera, {}, {.use_depth = false}).images;
  }
  if (program.ends_with("_bag")) {
    return OpenBagSequence(sequence, {.use_depth = false, .need_camera = false}).images;
  }
  if (program.ends_with("_video")) {
    return OpenImageStream(sequence).images;
  }
  return OpenTumSequence(sequence, {.use_depth = false});
}

}  // namespace hullslam
