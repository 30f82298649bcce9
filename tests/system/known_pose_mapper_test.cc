// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/system/known_pose_mapper.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "objects/made_objects.h"
#include "support/square_mask.h"

namespace hullslam {
namespace {

class KnownPoseMapperTest : public ::testing::Test {
 protected:
  KnownPoseMapperTest() { options_.camera = sensor_.camera; }

  // The masks of the things on the table, as a camera without distortion sees them.
  std::vector<InstanceMask> MasksFrom(const Rigid3& cam_from_world) const {
    std::vector<InstanceMask> masks;
    for (const MadeObject& object : MakeTable()) {
      InstanceMask& mask = masks.emplace_back();
      mask.label = object.label;
      mask.outlines = {Detect(object, sensor_, cam_from_world).hull};
    }
    return masks;
  }

  // A depth image (m) in which only the things on the table have a depth.
  cv::Mat DepthFrom(const Rigid3& cam_from_world) const {
    cv::Mat depth = cv::Mat::zeros(sensor_.camera.height, sensor_.camera.width, CV_32FC1);
    for (const MadeObject& object : MakeTable()) {
      for (const Eigen::Vector3d& point : VisibleSurface(object.ellipsoid, cam_from_world)) {
        const Eigen::Vector2d pixel = sensor_.camera.Project(point);
        const cv::Rect square(static_cast<int>(pixel.x()) - 2, static_cast<int>(pixel.y()) - 2, 5,
                              5);
        depth(square & cv::Rect(0, 0, depth.cols, depth.rows)) = point.z();
      }
    }
    return depth;
  }

  // `step` is the angle between two views, rad.
  void AddCircle(KnownPoseMapper& mapper, double step, bool with_depth) const {
    for (int i = 0; i < 12; ++i) {
      const Rigid3 cam_from_world = CameraOnCircle(step * i, 1.2, 0.7);
      mapper.AddView(0.5 * i, Inverse(cam_from_world), MasksFrom(cam_from_world),
                     with_depth ? DepthFrom(cam_from_world) : cv::Mat());
    }
  }

  // Expects that each thing on the table is mapped once, near its true position.
  static void ExpectTable(const Map& map, double most_offset) {
    for (const MadeObject& truth : MakeTable()) {
      int found = 0;
      for (const auto& [id, object] : map.objects()) {
        if (object.state == ObjectState::kMapped && object.Label() == truth.label) {
          ++found;
          EXPECT_LT((object.ellipsoid.world_from_object.translation -
                     truth.ellipsoid.world_from_object.translation)
                        .norm(),
                    most_offset)
              << truth.label;
        }
      }
      EXPECT_EQ(found, 1) << truth.label;
    }
  }

  const Sensor sensor_ = MakeObjectSensor();
  SystemOptions options_;
};

TEST_F(KnownPoseMapperTest, MapsFromMasksAlone) {
  KnownPoseMapper mapper(options_);
  AddCircle(mapper, 0.05, false);
  ExpectTable(mapper.map(), 0.02);
  EXPECT_EQ(mapper.map().keyframes().size(), 12U);
  EXPECT_EQ(mapper.counts().detections, 36U);
  EXPECT_EQ(mapper.counts().frames_with_masks, 12U);
}

TEST_F(KnownPoseMapperTest, DepthIsUsedWhereItIsGiven) {
  KnownPoseMapper mapper(options_);
  AddCircle(mapper, 0.2, true);
  ExpectTable(mapper.map(), 0.02);
  for (const auto& [id, keyframe] : mapper.map().keyframes()) {
    EXPECT_FALSE(keyframe.frame->detections.at(0).points.empty());
  }
}

// As the depth images of a phone are.
TEST_F(KnownPoseMapperTest, DepthOfAnotherSizeIsFitted) {
  KnownPoseMapper mapper(options_);
  for (int i = 0; i < 12; ++i) {
    const Rigid3 cam_from_world = CameraOnCircle(0.2 * i, 1.2, 0.7);
    cv::Mat small;
    cv::resize(DepthFrom(cam_from_world), small, {320, 240}, 0.0, 0.0, cv::INTER_NEAREST);
    mapper.AddView(0.5 * i, Inverse(cam_from_world), MasksFrom(cam_from_world), small);
  }
  ExpectTable(mapper.map(), 0.02);
  for (const auto& [id, keyframe] : mapper.map().keyframes()) {
    EXPECT_FALSE(keyframe.frame->detections.at(0).points.empty());
  }
}

TEST_F(KnownPoseMapperTest, DynamicClassesAreLeftOut) {
  options_.tracking.dynamic_classes = "cup";
  KnownPoseMapper mapper(options_);
  AddCircle(mapper, 0.05, false);
  for (const auto& [id, object] : mapper.map().objects()) {
    EXPECT_NE(object.Label(), "cup");
  }
  EXPECT_EQ(mapper.counts().detections, 24U);
}

TEST_F(KnownPoseMapperTest, MasksWithoutADetectionAreCountedWithTheirReason) {
  KnownPoseMapper mapper(options_);
  mapper.AddView(0.0, Rigid3(), {Square("cup", 100.0, 100.0, 2.0)});
  EXPECT_EQ(mapper.counts().rejections.at("mask_too_small"), 1U);
}

TEST_F(KnownPoseMapperTest, LaterViewsDoNotChangeASnapshot) {
  KnownPoseMapper mapper(options_);
  AddCircle(mapper, 0.05, false);
  const Map snapshot = mapper.Snapshot();
  EXPECT_EQ(snapshot.objects().size(), mapper.map().objects().size());
  mapper.AddView(10.0, Rigid3(), {});
  EXPECT_EQ(snapshot.keyframes().size(), 12U);
  EXPECT_EQ(mapper.map().keyframes().size(), 13U);
}

TEST_F(KnownPoseMapperTest, BadInputIsRefusedAndChangesNothing) {
  KnownPoseMapper mapper(options_);
  const std::vector<InstanceMask> masks = {Square("cup", 100.0, 100.0, 50.0)};
  EXPECT_THROW(mapper.AddView(std::numeric_limits<double>::quiet_NaN(), Rigid3(), masks),
               CheckError);
  Rigid3 nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(mapper.AddView(0.0, nowhere, masks), CheckError);
  EXPECT_THROW(mapper.AddView(0.0, Rigid3(), masks, cv::Mat::ones(10, 10, CV_32FC1)), InputError);
  EXPECT_THROW(mapper.AddView(0.0, Rigid3(), masks, cv::Mat::ones(480, 640, CV_8UC1)), InputError);
  EXPECT_THROW(mapper.AddView(0.0, Rigid3(), {InstanceMask{}}), InputError);
  EXPECT_TRUE(mapper.map().keyframes().empty());
  options_.camera.fx = 0.0;
  EXPECT_THROW(KnownPoseMapper{options_}, InputError);
}

}  // namespace
}  // namespace hullslam
