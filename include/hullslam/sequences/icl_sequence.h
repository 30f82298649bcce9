// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "hullslam/camera/depth.h"
#include "hullslam/camera/pinhole.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The packages in which ICL-NUIM (Handa et al., ICRA 2014) is published; see docs/datasets.md.
enum class IclPackage {
  kDetect,  // kTum or kPovray, depending on the files in the folder
  kTum,     // the PNG images compatible with TUM: rgb/N.png, depth/N.png, associations.txt
  kPovray,  // the original one: scene_00_NNNN.png, .depth and .txt
};

// The direction of the y axis of the cameras to which the poses of a ground truth belong. Up means
// fy < 0: the poses and their world are left-handed, and are mirrored before they are used.
// kMeasure: the depth images decide.
enum class CameraYAxis { kMeasure, kUp, kDown };

struct IclSequenceOptions {
  IclPackage package = IclPackage::kDetect;
  std::filesystem::path associations = {};  // empty: associations.txt (only package kTum)
  // Empty: the cameras of the .txt files (package kPovray), else the only file of the folder named
  // *.gt.freiburg or groundtruth.txt.
  std::filesystem::path groundtruth = {};
  CameraYAxis groundtruth_y = CameraYAxis::kMeasure;
  double povray_units = 1.0;  // lengths in the .depth and .txt files per metre
  // False for monocular SLAM: frames have no depth.
  bool use_depth = true;
  FrameSelection selection = {};
};

struct IclSequence {
  // The time stamps of the frames and of the ground truth are index / 30 s. The poses of the ground
  // truth are those of right-handed cameras with y down.
  ImageSequence images;
  IclPackage package = IclPackage::kTum;
  // A text for the user: which ground truth is used and how it was converted. Empty if there is
  // none.
  std::string groundtruth_note;
};

// Opens a sequence of ICL-NUIM. `camera` (with fy > 0) and `depth` describe the images; they are
// used to find out where the y axis points. Throws InputError that asks for --package if the files
// of the folder do not tell which package it is, and for --groundtruth-y if the depth images do not
// tell where y points; names file and line of malformed lines, and the first missing image.
IclSequence OpenIclSequence(const std::filesystem::path& folder, const PinholeCamera& camera,
                            const DepthOptions& depth, const IclSequenceOptions& options = {});

}  // namespace hullslam
