// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "exports/export_camera.h"
#include "exports/keyframe_images.h"
#include "hullslam/map/map.h"
#include "map/located_landmarks.h"
#include "results/output_folder.h"
#include "results/unit_mesh.h"

namespace hullslam {

// A reconstruction as COLMAP has it (https://colmap.github.io/format.html), of one camera without
// distortion, or of the two equal ones of a rectified pair. In COLMAP the centre of the first pixel
// is (0.5, 0.5); all pixels here are COLMAP's.

struct ColmapKeypoint {
  static constexpr uint64_t kNone = std::numeric_limits<uint64_t>::max();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  uint64_t point = kNone;  // id of the point that it shows
};

struct ColmapImage {
  uint32_t id = 0;  // 1 + the id of the keyframe; right images come after all others
  std::string name;
  uint32_t camera = 1;  // 2 for the right one of a pair
  Rigid3 cam_from_world;
  std::vector<ColmapKeypoint> keypoints = {};
};

struct ColmapSighting {
  uint32_t image = 0;     // id
  uint32_t keypoint = 0;  // index
};

struct ColmapPoint {
  uint64_t id = 0;  // from 1
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Colour colour{};
  double error = 0.0;                 // px, mean distance of the keypoints from the projections
  std::vector<ColmapSighting> track;  // at least two
};

struct ColmapModel {
  PinholeCamera camera;
  uint32_t cameras = 1;  // 2 for pairs
  std::vector<ColmapImage> images;
  std::vector<ColmapPoint> points;
};

// The model of the keyframes that have an image (name + ".png"). It has the keypoints inside of the
// images of `view`, and the landmarks that at least two of them show within 4 px. `colours` has one
// entry per landmark of `located`. With a `baseline` (m), each keyframe also has a right image
// (name + "_right.png"), with the keypoints whose columns in it are known.
ColmapModel MakeColmapModel(const Map& map, const LocatedLandmarks& located,
                            std::span<const Colour> colours, std::span<const KeyframeImage> images,
                            const ExportCamera& view, double baseline = 0.0);

// cameras.txt, images.txt and points3D.txt.
std::vector<FileContent> FormatColmapText(const ColmapModel& model);
// cameras.bin, images.bin and points3D.bin.
std::vector<FileContent> FormatColmapBinary(const ColmapModel& model);

}  // namespace hullslam
