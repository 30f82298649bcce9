// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/stereo_rectifier.h"

namespace hullslam {

// Whether a key of a settings file belongs to the calibration of a pair, which MakeRectifier()
// reads.
bool IsStereoKey(std::string_view key);

// The pair of a settings file that describes both cameras as they are:
// - of ORB-SLAM2: LEFT.K, LEFT.D, LEFT.R, LEFT.P, LEFT.width, LEFT.height, and the same for RIGHT;
// - of ORB-SLAM3: Camera2.fx and so on beside `camera`, the left one, with Stereo.T_c1_c2, the pose
//   of the second camera in the first one (Tlr, 3x4, in files before format 1.0);
// - of Kalibr: cam0 and cam1 of a camchain; of Basalt: its first two cameras;
// - of ROS: the camera_info of the left camera, beside which there is the right one's, whose
//   name has "right" instead of "left".
// A file with one camera, `camera`, and Camera.bf describes rectified images, for which the pair is
// absent, or two equal lenses that look in the same direction. Throws InputError with file, line
// and key.
std::optional<StereoCalibration> ReadStereoPair(const std::filesystem::path& file,
                                                const PinholeCamera& camera);

// Whether the file describes a right camera of its own, and not one camera with Camera.bf.
bool HasRightCamera(const std::filesystem::path& file);

// The rectifier of that pair; null without one.
std::shared_ptr<const StereoRectifier> MakeRectifier(const std::filesystem::path& file,
                                                     const PinholeCamera& camera);

// The same, but for one camera without distortion a rectifier that leaves the images as they are.
std::shared_ptr<const StereoRectifier> MakePairRectifier(const std::filesystem::path& file,
                                                         const PinholeCamera& camera);

}  // namespace hullslam
