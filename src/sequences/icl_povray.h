// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "hullslam/camera/pinhole.h"
#include "hullslam/geometry/trajectory.h"
#include "hullslam/sequences/image_sequence.h"

namespace hullslam {

// The original package of ICL-NUIM: for each frame the files scene_SS_NNNN.png (image), .depth
// (text: for each pixel, row by row, the distance of the surface along the ray) and .txt (the
// camera of POVRay). `units` is the number of units of length of these files per metre.

// Whether the folder has an image of the package. Throws InputError if it cannot be read.
bool HasPovrayFrames(const std::filesystem::path& folder);

// All frames of the folder, by increasing index, with the time stamp index / 30 s. The paths of the
// depth files are filled in whether the files exist or not. Throws InputError if there are none or
// if they are of two scenes.
std::vector<FramePaths> ListPovrayFrames(const std::filesystem::path& folder);

// The camera of a .txt file, from its lines `cam_pos = [x, y, z]';`, `cam_dir` and `cam_up`.
// POVRay's world is left-handed, and the y axis of its camera points up. The result is the pose of
// the right-handed camera in the mirrored world (MirrorY), m. Throws InputError with file and line.
Rigid3 ReadPovrayCamera(const std::filesystem::path& path, double units);

// The poses of all frames. Absent if the first frame has no .txt file. Throws InputError if the
// first frame has one but another frame has none.
std::optional<Trajectory> ReadPovrayTrajectory(const std::vector<FramePaths>& frames, double units);

// Reads a .depth file and converts its distances along the rays to depths along z, m, CV_32FC1.
// Throws InputError unless the file has one number >= 0 for each pixel of the camera.
cv::Mat ReadRayDepth(const std::filesystem::path& path, const PinholeCamera& camera, double units);

// Like LoadFrame(), but reads the depth with ReadRayDepth() instead of ReadDepthImage().
ImageInput LoadPovrayFrame(const FramePaths& frame, const PinholeCamera& camera, double units);

}  // namespace hullslam
