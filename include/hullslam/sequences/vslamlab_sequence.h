// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"

namespace hullslam {

// A camera of the calibration.yaml of VSLAM-LAB (Fontan et al. 2024).
struct VslamlabCamera {
  CameraCalibration calibration;
  std::string depth_name;     // the name of its depth images; empty: it has none
  double depth_factor = 0.0;  // units of the depth images per metre; 0: not given
  // The file has a negative fy (ICL-NUIM): `calibration` has the positive one, and the poses of a
  // ground truth are mirrored (MirrorY() in geometry/mirror.h).
  bool is_mirrored = false;
};

// Reads the camera with the name `name` (such as "rgb_0") of the list `cameras`, in which each has
// `cam_name`, `cam_model` (pinhole, radtan4, radtan5), `focal_length`, `principal_point`,
// `image_dimension`, `fps`, and if it has them `distortion_coefficients`, `depth_name` and
// `depth_factor`. Throws InputError with the file and the key.
VslamlabCamera ReadVslamlabCamera(const std::filesystem::path& file, const std::string& name);

// The names of the left and the right camera.
using VslamlabPairNames = std::array<std::string, 2>;

// Reads a stereo camera: both cameras as ReadVslamlabCamera does, with their poses on the body, 16
// numbers by rows in `T_SC` or `T_BS`. Without distortion and rotation between them, their images
// are taken as they are. Throws InputError also for cameras that are no pair (StereoRectifier).
struct VslamlabPair {
  std::shared_ptr<const StereoRectifier> rectifier;
  CameraCalibration calibration;  // of the rectified images
};
VslamlabPair ReadVslamlabPair(const std::filesystem::path& file, const VslamlabPairNames& names);

struct VslamlabSequence {
  ImageSequence images;
  std::vector<int64_t> stamps;  // ns, of each frame of `images` as in the file
};

// Opens the images that a rgb.csv of VSLAM-LAB lists: columns `ts_NAME (ns)` and `path_NAME`,
// relative to `folder`, of the images `image_name` and of the depth images `depth_name` (empty: no
// depth). Throws InputError with file and line for a malformed line, stamps that do not increase
// and missing images, and with the columns of the file if one of these is not there.
VslamlabSequence OpenVslamlabSequence(const std::filesystem::path& folder,
                                      const std::filesystem::path& csv,
                                      const std::string& image_name, const std::string& depth_name);

// The same for the two images of a stereo camera, which are rectified when they are loaded.
VslamlabSequence OpenVslamlabPairs(const std::filesystem::path& folder,
                                   const std::filesystem::path& csv, const VslamlabPairNames& names,
                                   const VslamlabPair& pair);

}  // namespace hullslam
