// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/road.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "synthetic/renderer.h"
#include "synthetic/scenes.h"

namespace hullslam::synthetic {
namespace {

// An eighth of the size of the camera of the road.
PinholeCamera SmallRoadCamera() {
  PinholeCamera camera = RoadCamera();
  camera.width = 153;
  camera.height = 46;
  camera.fx /= 8.0;
  camera.fy /= 8.0;
  camera.cx = (camera.cx + 0.5) / 8.0 - 0.5;
  camera.cy = (camera.cy + 0.5) / 8.0 - 0.5;
  return camera;
}

TEST(Road, IsClosedAndNothingIsNear) {
  const int frames = DefaultFrames(SceneKind::kRoad);
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const Scene scene = BuildScene(SceneKind::kRoad, frames, seed);
    EXPECT_TRUE(scene.objects.empty());
    const Renderer renderer(scene, SmallRoadCamera());
    for (int frame = 0; frame < frames; frame += 30) {
      double nearest = 0.0;
      double farthest = 0.0;
      cv::minMaxLoc(renderer.Render(frame / kFramesPerSecond).depth, &nearest, &farthest);
      EXPECT_GT(nearest, kRoadNearest) << "frame " << frame << ", seed " << seed;
      EXPECT_GT(farthest, 2.0 * kRoadNearest) << "frame " << frame << ", seed " << seed;
    }
  }
}

TEST(RoadPath, MovesAMetrePerFrameForwards) {
  const RoadPath path{.phase = 1.0};
  for (int frame = 0; frame < 150; ++frame) {
    const Rigid3 motion = Inverse(path.WorldFromCam(frame / kFramesPerSecond)) *
                          path.WorldFromCam((frame + 1) / kFramesPerSecond);
    EXPECT_NEAR(motion.translation.norm(), 1.0, 0.01);
    EXPECT_GT(motion.translation.z(), 0.98);
    EXPECT_LT(LogSo3(motion.rotation).norm(), 0.01);
  }
}

TEST(RoadCamera, HasTheBaselineOfItsPair) {
  EXPECT_NEAR(RoadCamera().bf / RoadCamera().fx, 0.54, 1e-9);
  EXPECT_EQ(RoadCamera(), CameraOf(SceneKind::kRoad));
}

}  // namespace
}  // namespace hullslam::synthetic
