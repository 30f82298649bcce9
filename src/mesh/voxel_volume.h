// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "hullslam/camera/pinhole.h"
#include "hullslam/frame/sensor.h"
#include "hullslam/geometry/rigid3.h"
#include "util/task_runner.h"

namespace hullslam {

// A depth image as a volume takes it. The images have the size of the raw image of the camera.
struct DepthView {
  PinholeCamera camera;
  // The pose of the camera while a row (or a column) of the raw image was exposed, one per row from
  // the top; of a global shutter a single one.
  std::vector<Rigid3> cam_from_world;
  ReadoutDirection readout = ReadoutDirection::kRows;
  cv::Mat rays;           // CV_32FC2, x and y of the point at z = 1 that a pixel shows
  cv::Mat inverse_depth;  // CV_32FC1, 1/m along z, 0 where the depth is not used
  cv::Mat cosine;         // CV_32FC1, of the angle between the ray and the normal of the surface
  cv::Mat weight;         // CV_32FC1, > 0 where the depth is used
  cv::Mat colour;         // CV_8UC3, BGR

  // The index of the pose while this raw pixel was exposed.
  size_t PoseIndex(const Eigen::Vector2d& raw) const {
    const double at = std::max(0.0, raw[readout == ReadoutDirection::kRows ? 1 : 0]) + 0.5;
    return std::min(static_cast<size_t>(at), cam_from_world.size() - 1);
  }
};

// A truncated signed distance function (Curless and Levoy 1996) in voxels of one size. Only blocks
// of 8 x 8 x 8 voxels near measured surfaces have memory, and are found by a hash of their place
// (Nießner et al. 2013). The same views in the same order give the same bits on any number of
// threads.
class VoxelVolume {
 public:
  static constexpr int kSide = 8;  // voxels

  struct Voxel {
    float distance = 0.0F;             // m, from the nearest surface, positive in front of it
    float weight = 0.0F;               // 0: not seen
    std::array<uint16_t, 3> colour{};  // red, green, blue of sRGB in units of 1/256
    uint16_t has_colour = 0;
  };
  struct Block {
    Eigen::Vector3i place;  // of its first voxel is kSide * place, in voxels from the origin
    std::array<Voxel, static_cast<size_t>(kSide) * kSide * kSide> voxels{};  // x changes fastest
  };

  // `voxel` is the distance between voxels and `truncation` the largest distance that is kept, m.
  VoxelVolume(double voxel, double truncation) : voxel_(voxel), truncation_(truncation) {}

  // Adds a view: in each voxel that it sees in front of a surface, or at most the truncation behind
  // it, the distance to the plane of the surface is averaged with the earlier ones. Returns false,
  // and adds nothing, if the volume would have more than `most_blocks` then.
  bool Add(const DepthView& view, size_t most_blocks, TaskRunner& runner);

  double voxel() const { return voxel_; }
  double truncation() const { return truncation_; }
  const std::vector<std::unique_ptr<Block>>& blocks() const { return blocks_; }
  const Block* Find(const Eigen::Vector3i& place) const;

 private:
  // The place of a block as one number. Nothing for a place that is too far away.
  static std::optional<uint64_t> KeyOf(const Eigen::Vector3i& place);
  // The keys of new blocks that the surfaces of a view are in or nearby, sorted. `farthest` is at
  // least the largest depth of the view, m.
  std::vector<uint64_t> TouchedBlocks(const DepthView& view, double farthest,
                                      TaskRunner& runner) const;
  void AddKeysOfRow(const DepthView& view, int row, int step, std::vector<uint64_t>& keys) const;

  double voxel_;
  double truncation_;
  std::vector<std::unique_ptr<Block>> blocks_;
  std::unordered_map<uint64_t, size_t> index_;  // of the blocks, by their keys
};

}  // namespace hullslam
