// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "hullslam/map/map.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// A keyframe and its image.
struct KeyframeImage {
  KeyframeId keyframe;
  FramePaths frame;
  // The stem of the image file, without blanks. No two images have the same name.
  std::string name;
};

// The keyframes whose images are in the sequence, by increasing id. If the map has several
// sessions, these are only keyframes of the sessions with the name `session`, because other
// sequences may have the same time stamps.
std::vector<KeyframeImage> FindKeyframeImages(const Map& map, const ImageSequence& sequence,
                                              const std::string& session);

}  // namespace hullslam
