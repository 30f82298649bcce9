// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/image_input.h"

namespace hullslam {

struct RgbdFramePaths {
  double timestamp = 0.0;  // of the colour image, s
  std::filesystem::path rgb;
  std::filesystem::path depth;
  size_t number = 0;  // among all lines of rgb.txt, or of the association file, from 0
};

// The frames `first`, `first + stride`, ... up to `last` (inclusive), counted from 0.
struct FrameSelection {
  size_t first = 0;
  size_t last = std::numeric_limits<size_t>::max();
  size_t stride = 1;
};

struct TumSequenceOptions {
  std::filesystem::path associations = {};  // empty: pairs are formed here
  // False for programs that work with masks and poses: images may be missing, and so may depth.txt;
  // frames without a depth image have an empty path then.
  bool need_images = true;
  FrameSelection selection = {};
};

struct TumSequence {
  std::vector<RgbdFramePaths> frames;  // in order of time, those selected
  size_t unpaired = 0;                 // colour images without depth within 0.02 s, of all
  std::optional<std::filesystem::path> groundtruth;  // groundtruth.txt, where there is one
};

// Opens a sequence in TUM's format: `rgb.txt` and `depth.txt` with `timestamp file` a line, paired
// one to one, the closest first, within 0.02 s; or an association file with `timestamp rgb
// timestamp depth` a line. All that can be told without decoding is checked: InputError names file
// and line for malformed lines and for stamps that do not increase, the first image that is
// missing, and the smallest gap where no image has a partner.
TumSequence OpenTumSequence(const std::filesystem::path& folder,
                            const TumSequenceOptions& options = {});

// Decodes one frame. Throws InputError for an image that ReadGreyImage() or ReadDepthImage()
// refuses or whose size is not the camera's.
ImageInput LoadRgbd(const RgbdFramePaths& paths, const PinholeCamera& camera);

}  // namespace hullslam
