// SPDX-License-Identifier: GPL-3.0-or-later
#include "sequences/frame_colour.h"

#include <algorithm>
#include <cmath>

#include "sequences/image_list.h"

namespace hullslam {

const FramePaths* FindFrameAt(const ImageSequence& sequence, double timestamp) {
  const auto difference = [timestamp](const FramePaths& frame) {
    return std::abs(frame.timestamp - timestamp);
  };
  const auto nearest = std::ranges::min_element(sequence.frames, {}, difference);
  return nearest != sequence.frames.end() && difference(*nearest) <= kSameMoment ? &*nearest
                                                                                 : nullptr;
}

cv::Mat LoadColour(const ImageSequence& sequence, const FramePaths& frame,
                   const PinholeCamera& camera) {
  cv::Mat image = sequence.load_colour(frame);
  CheckImageSize(frame.image.string(), image, camera);
  return image;
}

}  // namespace hullslam
