// SPDX-License-Identifier: GPL-3.0-or-later
#include "synthetic/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "hullslam/util/error.h"
#include "synthetic/renderer.h"
#include "synthetic/sequence_writer.h"
#include "synthetic/tests/image_motion.h"

namespace hullslam::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr SceneKind kAll[] = {SceneKind::kDesk,     SceneKind::kRoom,  SceneKind::kLowTexture,
                              SceneKind::kDynamic,  SceneKind::kHouse, SceneKind::kTwins,
                              SceneKind::kRotation, SceneKind::kWall,  SceneKind::kTurns,
                              SceneKind::kPushed,   SceneKind::kRoad};

TEST(SceneKind, NamesAreParsedAndPrinted) {
  for (const SceneKind kind : kAll) {
    EXPECT_EQ(ParseSceneKind(SceneName(kind)), kind);
  }
  EXPECT_THROW(ParseSceneKind("kitchen"), InputError);
  EXPECT_THROW(ParseSceneKind(""), InputError);
}

void ExpectClosedFurnishedAndSlowEnoughToTrack(SceneKind kind, int step) {
  const int frames = DefaultFrames(kind);
  const Scene scene = BuildScene(kind, frames, 1);
  const Renderer renderer(scene, SmallCamera());
  EXPECT_GE(scene.objects.size(), 15U);
  for (int i = 0; i < frames; i += step) {
    const double time = i / 30.0;
    const RenderedFrame frame = renderer.Render(time);
    EXPECT_LT(LargestMotion(scene, frame, time), 27.0) << "frame " << i;
    double nearest = 0.0;
    cv::minMaxLoc(frame.depth, &nearest, nullptr);
    EXPECT_GT(nearest, 0.3) << "frame " << i;
  }
}

TEST(Scenes, AreClosedFurnishedAndSlowEnoughToTrack) {
  for (const SceneKind kind :
       {SceneKind::kDesk, SceneKind::kRoom, SceneKind::kLowTexture, SceneKind::kDynamic}) {
    SCOPED_TRACE(SceneName(kind));
    ExpectClosedFurnishedAndSlowEnoughToTrack(kind, 20);
  }
}

TEST(Scenes, HouseIsClosedFurnishedAndSlowEnoughToTrack) {
  ExpectClosedFurnishedAndSlowEnoughToTrack(SceneKind::kHouse, 20);
}

TEST(Scenes, TwinsIsClosedFurnishedAndSlowEnoughToTrack) {
  ExpectClosedFurnishedAndSlowEnoughToTrack(SceneKind::kTwins, 30);
}

TEST(Scenes, InRotationTheCameraOnlyTurns) {
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const Scene scene = BuildScene(SceneKind::kRotation, 300, seed);
    const Rigid3 start = scene.world_from_cam(0.0);
    for (double time = 1.0; time < 10.0; time += 1.0) {
      const Rigid3 pose = scene.world_from_cam(time);
      EXPECT_EQ(pose.translation, start.translation);
      EXPECT_GT(AngularDistance(pose.rotation, scene.world_from_cam(time - 1.0).rotation), 0.1);
    }
    const RenderedFrame frame = Renderer(scene, SmallCamera()).Render(0.0);
    EXPECT_LT(LargestMotion(scene, frame, 0.0), 27.0);
    double nearest = 0.0;
    cv::minMaxLoc(frame.depth, &nearest, nullptr);
    EXPECT_GT(nearest, 0.3);
  }
}

// The turns are fast, but neighbouring images share most of their view, and the velocity changes
// smoothly.
TEST(Scenes, InTurnsTheCameraTurnsFastAboutAllAxes) {
  constexpr double kStep = 1.0 / kFramesPerSecond;
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const Scene scene = BuildScene(SceneKind::kTurns, 300, seed);
    Vector3d fastest = Vector3d::Zero();
    int fast = 0;
    for (int i = 0; i < 300; ++i) {
      const Rigid3 motion =
          Inverse(scene.world_from_cam(kStep * i)) * scene.world_from_cam(kStep * (i + 1));
      const Vector3d velocity = LogSo3(motion.rotation) / kStep;
      fastest = fastest.cwiseMax(velocity.cwiseAbs());
      fast += velocity.norm() > 1.0 ? 1 : 0;
      EXPECT_LT(velocity.norm(), 3.5);
      EXPECT_LT(motion.translation.norm(), 0.05);
    }
    EXPECT_GT(fastest.minCoeff(), 1.2);
    EXPECT_GT(fast, 200);
    const RenderedFrame frame = Renderer(scene, SmallCamera()).Render(0.0);
    EXPECT_LT(LargestMotion(scene, frame, 0.0), 120.0);
  }
}

// Everything that the camera sees is within 5 cm of one plane.
TEST(Scenes, InWallTheCameraSeesOnlyTheWall) {
  const Scene scene = BuildScene(SceneKind::kWall, 300, 1);
  const Renderer renderer(scene, SmallCamera());
  for (double time = 0.0; time < 10.0; time += 1.3) {
    const RenderedFrame frame = renderer.Render(time);
    const Rigid3 world_from_cam = scene.world_from_cam(time);
    EXPECT_LT(LargestMotion(scene, frame, time), 27.0);
    for (int y = 0; y < frame.depth.rows; y += 10) {
      for (int x = 0; x < frame.depth.cols; x += 10) {
        const Vector3d point =
            world_from_cam * SmallCamera().Unproject(Vector2d(x, y), frame.depth.at<float>(y, x));
        EXPECT_NEAR(point.y(), 2.6, 0.05) << time;
      }
    }
  }
}

TEST(VisitSeed, IsTheSeedOfTheSceneUnlessItIsRearranged) {
  EXPECT_EQ(VisitSeed(7, {}), 7U);
  EXPECT_NE(VisitSeed(7, 0), 7U);
  EXPECT_NE(VisitSeed(7, 0), VisitSeed(7, 1));
  EXPECT_NE(VisitSeed(7, 0), VisitSeed(8, 0));
}

TEST(Scenes, OnlyDeskRoomAndHouseCanBeRearranged) {
  for (const SceneKind kind :
       {SceneKind::kLowTexture, SceneKind::kDynamic, SceneKind::kTwins, SceneKind::kRoad}) {
    EXPECT_THROW(BuildScene(kind, 10, 1, 1), InputError) << SceneName(kind);
  }
}

TEST(Scenes, AnotherSeedChangesTexturesAndKeepsObjects) {
  const Scene a = BuildScene(SceneKind::kDesk, 300, 1);
  const Scene b = BuildScene(SceneKind::kDesk, 300, 2);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  const cv::Mat seen_a = Renderer(a, SmallCamera()).Render(0.0).colour;
  const cv::Mat seen_b = Renderer(b, SmallCamera()).Render(0.0).colour;
  EXPECT_GT(cv::norm(seen_a, seen_b, cv::NORM_L1) / static_cast<double>(seen_a.total()), 5.0);
}

TEST(Scenes, PushedIsTheDeskWithAThingThatRestsAtFivePlacesInView) {
  const Scene desk = BuildScene(SceneKind::kDesk, 300, 1);
  const Scene scene = BuildScene(SceneKind::kPushed, 300, 1);
  ASSERT_EQ(scene.objects.size(), desk.objects.size() + 1);
  for (size_t i = 0; i < desk.objects.size(); ++i) {
    EXPECT_EQ(scene.objects[i].world_from_object.translation,
              desk.objects[i].world_from_object.translation);
  }
  EXPECT_GT((scene.world_from_cam(0.0).translation - desk.world_from_cam(0.0).translation).norm(),
            1e-3);
  const SceneObject& board = scene.objects.back();
  EXPECT_FALSE(board.HasClass());
  const Renderer renderer(scene, SmallCamera());
  for (int place = 0; place < 5; ++place) {
    const double time = 2.1 * place + 0.7;
    EXPECT_EQ(board.WorldFromObject(time).translation,
              board.WorldFromObject(time + 0.5).translation);
    const cv::Mat mask = renderer.Render(time).instance == board.id;
    EXPECT_GT(cv::countNonZero(mask), 0.01 * static_cast<double>(mask.total())) << time;
  }
}

TEST(Scenes, InDynamicThePersonOftenCoversMuchOfTheView) {
  const Scene scene = BuildScene(SceneKind::kDynamic, 300, 0);
  const Renderer renderer(scene, SmallCamera());
  const int person = static_cast<int>(scene.objects.size()) - 1;
  ASSERT_EQ(scene.objects.back().class_name, "person");
  ASSERT_TRUE(scene.objects.back().IsDynamic());
  int covered = 0;
  int free_frames = 0;
  for (int i = 0; i < 300; i += 10) {
    const cv::Mat mask = renderer.Render(i / 30.0).instance == person;
    const double share = cv::countNonZero(mask) / static_cast<double>(mask.total());
    covered += share > 0.25 ? 1 : 0;
    free_frames += share < 0.02 ? 1 : 0;
  }
  EXPECT_GE(covered, 10);
  EXPECT_GE(free_frames, 3);
}

TEST(Scenes, InRoomTheStartIsSeenAgain) {
  const Scene scene = BuildScene(SceneKind::kRoom, 600, 0);
  const Rigid3 start = scene.world_from_cam(0.0);
  double nearest = 10.0;
  for (int i = 500; i < 600; ++i) {
    const Rigid3 motion = Inverse(start) * scene.world_from_cam(i / 30.0);
    nearest = std::min(nearest, motion.translation.norm() + LogSo3(motion.rotation).norm());
  }
  EXPECT_LT(nearest, 0.15);
}

}  // namespace
}  // namespace hullslam::synthetic
