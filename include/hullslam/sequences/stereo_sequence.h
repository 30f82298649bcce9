// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

#include "hullslam/frame/stereo_rectifier.h"
#include "hullslam/sequences/image_sequence.h"
#include "hullslam/settings/settings.h"

namespace hullslam {

// The pairs of a stereo camera. The loader of the images rectifies them.
struct StereoSequence {
  ImageSequence images;
  CameraCalibration calibration;  // of the rectified images, with the baseline
};

// Opens a sequence of KITTI's odometry benchmark (Geiger et al., CVPR 2012): rectified images in
// `image_0` and `image_1` (or in `image_2` and `image_3`, in colour), `calib.txt` with the 3x4
// projections P0 to P3, and `times.txt` with seconds. The ground truth is `groundtruth.txt` or
// `poses.txt` in the folder, or `poses/NAME.txt` of the data set. So are rectified drives of its
// raw data, with `image_00/data` and so on, `image_00/timestamps.txt`, and calib_cam_to_cam.txt in
// the folder or above it. Throws InputError with file and line. A `rectifier` replaces the
// calibration.
StereoSequence OpenKittiPairs(const std::filesystem::path& folder,
                              const FrameSelection& selection = {},
                              const std::shared_ptr<const StereoRectifier>& rectifier = nullptr);

// The images of one camera of a stereo sequence.
struct LeftSequence {
  ImageSequence images;
  CameraCalibration calibration;
};

// Opens the left camera of such a sequence, `image_0` or `image_2`. Neither the right images nor
// their projection need exist.
LeftSequence OpenKittiImages(const std::filesystem::path& folder,
                             const FrameSelection& selection = {});

struct StereoFolderOptions {
  // The calibration of the images as read. Null: they are rectified.
  std::shared_ptr<const StereoRectifier> rectifier = nullptr;
  double frames_per_second = 30.0;  // of a folder without stamps
  FrameSelection selection = {};
};

// Opens pairs of two forms: a folder with the subfolders `left` (or `rgb`) and `right`, or
// `image_left` and `image_right` as of TartanAir, with the poses of pose_left.txt, whose
// images have the same names, or the same last numbers in them, or are equally many; or a video or
// a folder of images that show both halves of a pair side by side, the left one first. Stamps are
// in the names if these are seconds or nanoseconds, else index / frames_per_second; a video has its
// own stamps. Throws InputError for anything else, and if fewer than half of the left images
// have a partner; a warning counts images without one.
ImageSequence OpenStereoFolder(const std::filesystem::path& path,
                               const StereoFolderOptions& options = {});

}  // namespace hullslam
