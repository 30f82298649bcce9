// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/keypoint_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "features/find_near.h"
#include "support/fisheye_camera.h"

namespace hullslam {
namespace {

std::vector<uint32_t> Near(const PinholeCamera& camera, const Eigen::Vector2d& center) {
  // Undistorted, the second keypoint is 400 px from the first, but only some px in a fisheye image.
  std::vector<Keypoint> keypoints(2);
  keypoints[0].undistorted = {1400.0f, 240.0f};
  keypoints[1].undistorted = {1000.0f, 240.0f};
  std::vector<uint32_t> found;
  FindNear(MakeKeypointGrid(keypoints, camera), keypoints, center.cast<float>(), 40.0f, 0, 7,
           found);
  std::sort(found.begin(), found.end());
  return found;
}

TEST(KeypointGrid, IsThatOfTheRawImageWithAFisheye) {
  const PinholeCamera fisheye = FisheyeCamera();
  EXPECT_EQ(Near(fisheye, fisheye.Distort({1200.0, 240.0})), (std::vector<uint32_t>{0, 1}));
  PinholeCamera pinhole = fisheye;
  pinhole.lens = LensModel::kBrown;
  pinhole.k1 = pinhole.k2 = pinhole.k3 = pinhole.k4 = 0.0;
  EXPECT_EQ(Near(pinhole, {1390.0, 240.0}), (std::vector<uint32_t>{0}));
}

}  // namespace
}  // namespace hullslam
