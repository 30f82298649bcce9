// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/util/stamp_pairing.h"

namespace hullslam {

// The images of one camera of a pair, in order of time.
struct StampedCamera {
  std::string name;                // for messages
  std::span<const double> stamps;  // s
};

// Pairs the images of two cameras whose stamps may differ: one to one, closest first, within a
// twentieth of the time between two images. Adds a warning about images without a partner. Throws
// InputError that begins with `origin` if fewer than half of the images have one, and if the stamps
// of the two cameras drift apart.
std::vector<IndexPair> PairStereoStamps(const std::string& origin, const StampedCamera& left,
                                        const StampedCamera& right, double frames_per_second,
                                        std::vector<std::string>& warnings);

// Reads the images, and the right images if there are some, from their files. Without depth images,
// images of 16 bits are images too.
void LoadWithoutDepth(ImageSequence& sequence);

// The images of the frames show both halves of a pair, the left one first.
void SplitHalves(ImageSequence& sequence);

// Rectifies the pairs. `rectifier` is null for images that are rectified already.
void RectifyPairs(const std::shared_ptr<const StereoRectifier>& rectifier, ImageSequence& sequence);

}  // namespace hullslam
