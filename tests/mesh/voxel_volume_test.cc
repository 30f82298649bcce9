// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/voxel_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "support/drawn_depth.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

constexpr double kVoxel = 0.02;
constexpr double kTruncation = 0.08;
constexpr size_t kMany = 100'000;

const Eigen::Vector3d kNormal = Eigen::Vector3d(-0.3, 0.1, -1.0).normalized();
const HitDistance kPlane = PlaneAt(kNormal, -1.5);

// Calls `check` with each seen voxel and its place, m.
template <typename Check>
size_t ForSeenVoxels(const VoxelVolume& volume, const Check& check) {
  size_t count = 0;
  for (const auto& block : volume.blocks()) {
    for (int i = 0; i < 512; ++i) {
      const VoxelVolume::Voxel& voxel = block->voxels[static_cast<size_t>(i)];
      if (voxel.weight > 0.0F) {
        const Eigen::Vector3i at = 8 * block->place + Eigen::Vector3i(i % 8, i / 8 % 8, i / 64);
        check(voxel, volume.voxel() * at.cast<double>());
        ++count;
      }
    }
  }
  return count;
}

// The largest error of the distances of voxels beside the plane. (Of others it is a share of the
// distance, because the normal of the surface is only known roughly.) `least` becomes the least
// true one.
double MostError(const VoxelVolume& volume, double& least) {
  double most = 0.0;
  least = 0.0;
  const size_t count = ForSeenVoxels(volume, [&](const auto& voxel, const Eigen::Vector3d& place) {
    const double distance = kNormal.dot(place) + 1.5;
    if (std::abs(distance) < kVoxel) {
      most = std::max(most, std::abs(distance - static_cast<double>(voxel.distance)));
    }
    least = std::min(least, distance);
  });
  EXPECT_GT(count, 1000U);
  return most;
}

TEST(VoxelVolume, HasTheDistancesFromAPlaneForEveryLens) {
  SerialRunner runner;
  SystemOptions fisheye = SmallCameraOptions();
  fisheye.camera = FisheyeCamera();
  for (const SystemOptions& options : {SmallCameraOptions(), fisheye}) {
    VoxelVolume volume(kVoxel, kTruncation);
    for (const double x : {-0.3, 0.0, 0.4}) {
      const Rigid3 pose = LookAt({x, 0.1, 0.0}, {0.0, 0.0, 1.5});
      ASSERT_TRUE(volume.Add(DrawView(options, {pose}, kPlane), kMany, runner));
    }
    double least = 0.0;
    EXPECT_LT(MostError(volume, least), 0.05 * kVoxel);
    EXPECT_GE(least, -1.02 * kTruncation);
  }
}

// 4 cm between the top and the bottom row: a single pose would be wrong by two voxels.
TEST(VoxelVolume, TakesEachRowAtItsTime) {
  SerialRunner runner;
  SystemOptions options = SmallCameraOptions();
  options.readout_time = 0.04;
  const PointVelocity velocity{{0.0, 0.5, 0.0}, {0.0, 0.0, -1.0}};
  const Rigid3 middle = LookAt({0.0, 0.0, 0.0}, {0.0, 0.0, 1.5});
  const std::vector<Rigid3> poses = PosesOfRows(options, middle, velocity);
  ASSERT_EQ(poses.size(), 120U);
  DepthView view = DrawView(options, poses, kPlane);
  VoxelVolume volume(kVoxel, kTruncation);
  ASSERT_TRUE(volume.Add(view, kMany, runner));
  double least = 0.0;
  EXPECT_LT(MostError(volume, least), 0.05 * kVoxel);
  view.cam_from_world = {middle};
  VoxelVolume ignorant(kVoxel, kTruncation);
  ASSERT_TRUE(ignorant.Add(view, kMany, runner));
  EXPECT_GT(MostError(ignorant, least), 0.5 * kVoxel);
}

TEST(VoxelVolume, WeighsViewsAndColours) {
  SerialRunner runner;
  const SystemOptions options = SmallCameraOptions();
  const Rigid3 pose = LookAt({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  const auto plane = [](double z) { return PlaneAt(Eigen::Vector3d::UnitZ(), z); };
  VoxelVolume volume(kVoxel, kTruncation);
  DepthView near = DrawView(options, {pose}, plane(1.0), {0, 0, 100});
  DepthView far = DrawView(options, {pose}, plane(1.02), {0, 200, 0});
  near.weight.setTo(3.0F, near.weight > 0.0F);
  far.weight.setTo(1.0F, far.weight > 0.0F);
  near.cosine.setTo(1.0F);
  far.cosine.setTo(1.0F);
  ASSERT_TRUE(volume.Add(near, kMany, runner));
  ASSERT_TRUE(volume.Add(far, kMany, runner));
  ForSeenVoxels(volume, [&](const auto& voxel, const Eigen::Vector3d& place) {
    if (place.head<2>().norm() < 0.001 && std::abs(place.z() - 0.98) < 0.001) {
      EXPECT_NEAR(voxel.distance, (3.0 * 0.02 + 0.04) / 4.0, 1e-5);
      EXPECT_EQ(voxel.colour[0], 75 * 256);
      EXPECT_EQ(voxel.colour[1], 50 * 256);
      EXPECT_EQ(voxel.colour[2], 0);
    }
  });
}

TEST(VoxelVolume, OnlyBlocksNearSurfacesHaveMemory) {
  SerialRunner runner;
  const DepthView view = DrawView(SmallCameraOptions(), {LookAt({0, 0, 0}, {0, 0, 1})}, kPlane);
  VoxelVolume volume(kVoxel, kTruncation);
  ASSERT_TRUE(volume.Add(view, kMany, runner));
  const size_t needed = volume.blocks().size();
  // The camera sees 1.7 m^2 of the plane at 1.5 m, and a block has 0.16 m x 0.16 m. Its distance
  // from the plane is at most the truncation, so there are two to four layers.
  EXPECT_GT(needed, 100U);
  EXPECT_LT(needed, 400U);
  ASSERT_TRUE(volume.Add(view, needed, runner));
  EXPECT_EQ(volume.blocks().size(), needed) << "the same view needs no more";
  VoxelVolume small(kVoxel, kTruncation);
  EXPECT_FALSE(small.Add(view, needed - 1, runner));
  EXPECT_TRUE(small.blocks().empty());
}

TEST(VoxelVolume, FindsBlocksByTheirPlaces) {
  SerialRunner runner;
  VoxelVolume volume(kVoxel, kTruncation);
  const DepthView view = DrawView(SmallCameraOptions(), {LookAt({0, 0, 0}, {0, 0, 1})}, kPlane);
  ASSERT_TRUE(volume.Add(view, kMany, runner));
  for (const auto& block : volume.blocks()) {
    EXPECT_EQ(volume.Find(block->place), block.get());
  }
  EXPECT_EQ(volume.Find({1000, 0, 0}), nullptr);
  EXPECT_EQ(volume.Find({1 << 30, 0, 0}), nullptr);
}

TEST(VoxelVolume, AnEmptyViewAddsNothing) {
  SerialRunner runner;
  VoxelVolume volume(kVoxel, kTruncation);
  const HitDistance nothing = SphereAt({0.0, 0.0, -5.0}, 1.0);
  EXPECT_TRUE(volume.Add(DrawView(SmallCameraOptions(), {Rigid3()}, nothing), 0, runner));
  EXPECT_TRUE(volume.blocks().empty());
}

TEST(VoxelVolume, ThreadsGiveTheSameBits) {
  SerialRunner serial;
  ParallelRunner parallel(3);
  VoxelVolume one(kVoxel, kTruncation);
  VoxelVolume other(kVoxel, kTruncation);
  for (const double x : {-0.3, 0.0, 0.4}) {
    const DepthView view =
        DrawView(SmallCameraOptions(), {LookAt({x, 0.0, 0.0}, {0.0, 0.0, 1.5})}, kPlane);
    ASSERT_TRUE(one.Add(view, kMany, serial));
    ASSERT_TRUE(other.Add(view, kMany, parallel));
  }
  ASSERT_EQ(one.blocks().size(), other.blocks().size());
  for (size_t i = 0; i < one.blocks().size(); ++i) {
    ASSERT_EQ(one.blocks()[i]->place, other.blocks()[i]->place);
    ASSERT_EQ(std::memcmp(one.blocks()[i]->voxels.data(), other.blocks()[i]->voxels.data(),
                          sizeof(one.blocks()[i]->voxels)),
              0);
  }
}

}  // namespace
}  // namespace hullslam
