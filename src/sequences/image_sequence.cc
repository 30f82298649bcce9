// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/sequences/image_sequence.h"

#include <fmt/format.h>

#include "hullslam/results/trajectory_file.h"
#include "hullslam/util/error.h"
#include "sequences/image_file.h"
#include "sequences/image_list.h"

namespace hullslam {

ImageInput LoadFrame(const FramePaths& frame, const PinholeCamera& camera) {
  ImageInput image{frame.timestamp, ReadGreyImage(frame.image),
                   frame.depth.empty() ? cv::Mat() : ReadDepthImage(frame.depth)};
  if (!frame.depth.empty() && image.grey.size() != image.depth.size()) {
    throw InputError(fmt::format("{}: {}x{} px, expected the size of its colour image {}, {}x{}",
                                 frame.depth.string(), image.depth.cols, image.depth.rows,
                                 frame.image.filename().string(), image.grey.cols,
                                 image.grey.rows));
  }
  CheckImageSize(frame.image.string(), image.grey, camera);
  return image;
}

std::optional<Trajectory> ReadGroundtruth(const ImageSequence& sequence) {
  if (sequence.converted_groundtruth) {
    return sequence.converted_groundtruth;
  }
  return sequence.groundtruth ? std::optional(ReadTrajectory(*sequence.groundtruth)) : std::nullopt;
}

}  // namespace hullslam
