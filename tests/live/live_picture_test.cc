// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_picture.h"

#include <gtest/gtest.h>

#include <random>

#include "support/made_live.h"

namespace hullslam {
namespace {

class LivePictureTest : public ::testing::Test {
 protected:
  SyntheticWorld world_;
};

TEST_F(LivePictureTest, HasTheImageAndTheKeypointsInItsPixels) {
  LivePictures pictures(world_.sensor().camera, 1 << 20);
  const LiveFrame frame = MadeLiveFrame(world_, 3, nullptr);
  const LivePicture made = pictures.Make(frame);
  EXPECT_EQ(made.picture.width, 480);
  EXPECT_EQ(made.picture.jpeg.substr(0, 2), "\xff\xd8");
  const size_t count = frame.report.frame->features.size();
  EXPECT_EQ(made.matched.size() + made.unmatched.size(), 2 * count);
  EXPECT_EQ(made.matched.size(), 2 * ((count + 1) / 2));
  const double scale = 480.0 / world_.sensor().camera.width;
  const Eigen::Vector2d raw = world_.sensor().camera.Distort(
      frame.report.frame->features.keypoints[0].undistorted.cast<double>());
  EXPECT_NEAR(made.matched[0], scale * raw.x(), 1e-3);
  EXPECT_NEAR(made.matched[1], scale * raw.y(), 1e-3);
}

TEST_F(LivePictureTest, LargeFilesMakeTheNextPicturesSmaller) {
  LivePictures pictures(world_.sensor().camera, 8000);
  LiveFrame frame = MadeLiveFrame(world_, 3, nullptr);
  std::mt19937 random(1);
  for (int y = 0; y < frame.grey.rows; ++y) {
    for (int x = 0; x < frame.grey.cols; ++x) {
      frame.grey.at<uint8_t>(y, x) = static_cast<uint8_t>(random());
    }
  }
  const size_t first = pictures.Make(frame).picture.jpeg.size();
  size_t last = first;
  for (int i = 0; i < 40; ++i) {
    last = pictures.Make(frame).picture.jpeg.size();
  }
  EXPECT_GT(first, 40000u);
  EXPECT_LT(last, 16000u);
}

TEST_F(LivePictureTest, MasksWithoutAnImageGiveAnEmptyPicture) {
  LivePictures pictures(world_.sensor().camera, 8000);
  LiveFrame frame = MadeLiveFrame(world_, 3, nullptr);
  frame.grey = cv::Mat();
  EXPECT_EQ(pictures.Make(frame).picture.width, 0);
}

TEST_F(LivePictureTest, ShowsDetectionsWithTheirObjects) {
  Map map;
  const ObjectId id = map.AddObject();
  ObjectLandmark& object = map.MutableObject(id);
  object.state = ObjectState::kMapped;
  object.has_shape = true;
  object.votes = {{"cup", 1.0}};
  object.ellipsoid = {Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 4.0}), {0.2, 0.2, 0.2}};
  LiveFrame frame = MadeLiveFrame(world_, 0, std::make_shared<const Map>(map.Snapshot()));
  auto with_mask = std::make_shared<Frame>(*frame.report.frame);
  Detection& seen = with_mask->detections.emplace_back();
  seen.label = "mug";
  seen.hull = {{10.0, 10.0}, {20.0, 10.0}, {20.0, 20.0}};
  frame.report.frame = with_mask;
  frame.report.objects = {id};
  LivePictures pictures(world_.sensor().camera, 1 << 20);
  const ViewPicture picture = pictures.Make(frame).picture;
  ASSERT_EQ(picture.outlines.size(), 1u);
  EXPECT_EQ(picture.outlines[0].label, "mug");
  EXPECT_EQ(picture.outlines[0].object, id);
  EXPECT_EQ(picture.outlines[0].points.size(), 3u);
  ASSERT_EQ(picture.ellipses.size(), 1u);
  EXPECT_EQ(picture.ellipses[0].label, "cup");
}

// In a run in real time, a network's masks come when the frame has been shown.
TEST_F(LivePictureTest, WithoutDetectionsAllMappedObjectsInTheImageAreDrawn) {
  Map map;
  const auto add = [&map](const Eigen::Vector3d& position, ObjectState state) {
    const ObjectId id = map.AddObject();
    ObjectLandmark& object = map.MutableObject(id);
    object.state = state;
    object.has_shape = true;
    object.votes = {{"cup", 1.0}};
    object.ellipsoid = {Rigid3(Eigen::Quaterniond::Identity(), position), {0.2, 0.2, 0.2}};
    return id;
  };
  const Rigid3 world_from_cam = Inverse(SyntheticWorld::CamFromWorld(0));
  const ObjectId seen = add(world_from_cam * Eigen::Vector3d(0.0, 0.0, 4.0), ObjectState::kMapped);
  add(world_from_cam * Eigen::Vector3d(0.5, 0.0, 4.0), ObjectState::kCandidate);
  add(world_from_cam * Eigen::Vector3d(0.0, 0.0, -4.0), ObjectState::kMapped);
  add(world_from_cam * Eigen::Vector3d(40.0, 0.0, 4.0), ObjectState::kMapped);
  LiveFrame frame = MadeLiveFrame(world_, 0, std::make_shared<const Map>(map.Snapshot()));
  auto without_masks = std::make_shared<Frame>(*frame.report.frame);
  without_masks->detections.clear();
  frame.report.frame = without_masks;
  frame.report.objects.clear();
  LivePictures pictures(world_.sensor().camera, 1 << 20);
  const ViewPicture picture = pictures.Make(frame).picture;
  EXPECT_TRUE(picture.outlines.empty());
  ASSERT_EQ(picture.ellipses.size(), 1u);
  EXPECT_EQ(picture.ellipses[0].object, seen);
  frame.report.tracked.state = TrackingState::kLost;
  EXPECT_TRUE(pictures.Make(frame).picture.ellipses.empty());
}

}  // namespace
}  // namespace hullslam
