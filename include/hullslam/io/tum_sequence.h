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
  size_t number = 0;  // index among the images of rgb.txt or of the association file, from 0
};

// Selects the frames `first`, `first + stride`, ... up to and including `last`, counted from 0.
struct FrameSelection {
  size_t first = 0;
  size_t last = std::numeric_limits<size_t>::max();
  size_t stride = 1;
};

struct TumSequenceOptions {
  std::filesystem::path associations = {};  // empty: images are paired by time
  // False for programs that only use masks and poses. Then images may be missing, and depth.txt
  // too; frames without a depth image have an empty path.
  bool need_images = true;
  FrameSelection selection = {};
};

struct TumSequence {
  std::vector<RgbdFramePaths> frames;  // the selected frames, in order of time
  size_t available = 0;  // frames of the whole sequence, of which `frames` is the selection
  size_t unpaired = 0;   // colour images of the whole sequence without depth within 0.02 s
  std::optional<std::filesystem::path> groundtruth;  // groundtruth.txt if it exists
};

// Opens a sequence in TUM's format: `rgb.txt` and `depth.txt` with one line `timestamp file` per
// image, which are paired one to one, closest first, within 0.02 s; or an association file with
// lines `timestamp rgb timestamp depth`. Everything that needs no decoding is checked. InputError
// names file and line of malformed lines and of stamps that do not increase, the first missing
// image, and the smallest gap if no image can be paired.
TumSequence OpenTumSequence(const std::filesystem::path& folder,
                            const TumSequenceOptions& options = {});

// Decodes one frame. Throws InputError for an image that ReadGreyImage() or ReadDepthImage()
// rejects, or that does not have the size of the camera.
ImageInput LoadRgbd(const RgbdFramePaths& paths, const PinholeCamera& camera);

}  // namespace hullslam
