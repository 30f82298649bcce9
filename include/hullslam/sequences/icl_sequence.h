// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The direction of the y axis of the cameras to which the poses of a ground truth belong. Up means
// fy < 0: the poses and their world are left-handed, and are mirrored before they are used.
// kMeasure: the depth images decide.
enum class CameraYAxis { kMeasure, kUp, kDown };

struct IclSequenceOptions {
  std::filesystem::path associations = {};  // empty: associations.txt
  // Empty: the only file of the folder named *.gt.freiburg or groundtruth.txt.
  std::filesystem::path groundtruth = {};
  CameraYAxis groundtruth_y = CameraYAxis::kMeasure;
  // False for monocular SLAM: frames have no depth.
  bool use_depth = true;
  FrameSelection selection = {};
};

struct IclSequence {
  // The time stamps of the frames and of the ground truth are index / 30 s. The poses of the ground
  // truth belong to right-handed cameras with y down.
  ImageSequence images;
  // A text for the user: which ground truth is used and how it was converted. Empty if there is
  // none.
  std::string groundtruth_note;
};

// Opens a sequence of ICL-NUIM (Handa et al., ICRA 2014) in its package "TUM RGB-D compatible
// PNGs": rgb/N.png, depth/N.png and associations.txt. `camera` (with fy > 0) and `depth` describe
// the images; they are used to find out where the y axis points. Throws InputError that asks for
// --groundtruth-y if the depth images do not tell where y points; names file and line of malformed
// lines, and the first missing image.
IclSequence OpenIclSequence(const std::filesystem::path& folder, const PinholeCamera& camera,
                            const DepthOptions& depth, const IclSequenceOptions& options = {});

}  // namespace hullslam
