// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>

#include "exports/export_camera.h"
#include "hullslam/features/feature_grid.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The metres of one unit of the depth images that nerfstudio is given: its own default.
inline constexpr double kNerfstudioDepthUnit = 0.001;

// A frame of transforms.json. The paths are relative to that file; empty if there is none.
struct NerfstudioFrame {
  std::string image;
  std::string depth;
  std::string mask;
  Rigid3 world_from_cam;
};

// transforms.json of nerfstudio (https://docs.nerf.studio/quickstart/data_conventions.html), of a
// camera without distortion. nerfstudio has the axes of OpenGL: the camera looks along its -z, and
// y points up in the image. `points` is the path of the PLY file that Gaussian splatting starts
// from.
std::string FormatTransforms(const PinholeCamera& camera, std::span<const NerfstudioFrame> frames,
                             const std::string& points);

// The units of a 16-bit depth image per metre. The map does not have this setting, but the features
// have the depths at their pixels in metres. Absent if fewer than ten keypoints have a depth.
std::optional<double> MeasureDepthUnits(const FrameFeatures& features, const PinholeCamera& camera,
                                        const cv::Mat& depth);

// The raw depth image (as in ImageInput) for the pixels of `view`: CV_16UC1 in units of
// kNerfstudioDepthUnit, 0 where the depth is unknown or above 65.535 m. `units_per_metre` is
// ignored for images in metres (CV_32FC1).
cv::Mat MakeDepthImage(const cv::Mat& depth, double units_per_metre, const ExportCamera& view);

}  // namespace hullslam
