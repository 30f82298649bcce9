// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

struct TumSequenceOptions {
  std::filesystem::path associations = {};  // empty: images are paired by time
  // False for programs that only use masks and poses. Then images may be missing, and depth.txt
  // too; frames without a depth image have an empty path.
  bool need_images = true;
  // False for monocular SLAM. Then all images of rgb.txt are frames, and no frame has depth.
  bool use_depth = true;
  // For images without a list whose names are numbers of frames: their stamps are number /
  // frames_per_second.
  double frames_per_second = 30.0;
  FrameSelection selection = {};
};

// Throws InputError, as OpenTumSequence() does, if the folder does not exist or if it has neither
// rgb.txt nor a folder `rgb`, nor the images of 7-Scenes or Replica. If it is one level too high or
// too low, the message names the right one.
void CheckTumFolder(const std::filesystem::path& folder);

// Opens a sequence in TUM's format. `rgb.txt` and `depth.txt` have one line `timestamp file` per
// image; the images are paired one to one, closest first, within 0.02 s. If an association file is
// given, its lines `timestamp rgb timestamp depth` are used instead. Without a list, the
// folders `rgb` and `depth` are enough if the names of the images have their time stamps or numbers
// of frames; frames with the same number belong together. So are the folders of 7-Scenes
// (frame-000000.color.png beside frame-000000.depth.png) and Replica (results/frame000000.jpg and
// results/depth000000.png). The ground truth is groundtruth.txt if it
// exists, else the poses of 7-Scenes (frame-000000.pose.txt) or Replica (traj.txt). Everything is
// checked that needs no decoding of images. Throws InputError with file and line for malformed
// lines and for stamps that do not increase, with the name of the first missing image, and with the
// smallest gap if no image can be paired.
ImageSequence OpenTumSequence(const std::filesystem::path& folder,
                              const TumSequenceOptions& options = {});

}  // namespace hullslam
