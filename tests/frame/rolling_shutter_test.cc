// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/rolling_shutter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "hullslam/util/check.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

constexpr double kReadout = 0.03;

PointVelocity Velocity() { return {{0.2, -0.3, 0.5}, {-0.4, 0.6, 0.3}}; }

// The pose of the camera `time` seconds after the middle row, at a constant velocity.
Rigid3 MotionUntil(double time) {
  return {ExpSo3(time * Velocity().angular), time * Velocity().linear};
}

Sensor RollingSensor() {
  Sensor sensor = SyntheticSensor();
  sensor.readout_time = kReadout;
  return sensor;
}

// The pixel at which a rolling shutter sees a point. The row or column of the pixel determines the
// time of its exposure.
Eigen::Vector2d SeenWhileMoving(const Sensor& sensor, const Eigen::Vector3d& point) {
  Eigen::Vector2d pixel = sensor.camera.Project(point);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d as_read = sensor.camera.Distort(pixel);
    const double place = sensor.readout_direction == ReadoutDirection::kRows
                             ? as_read.y() / sensor.camera.height
                             : as_read.x() / sensor.camera.width;
    pixel = sensor.camera.Project(MotionUntil((place - 0.5) * sensor.readout_time) * point);
  }
  return pixel;
}

Frame FrameOf(const std::vector<Eigen::Vector2d>& pixels) {
  Frame frame;
  for (const Eigen::Vector2d& pixel : pixels) {
    frame.features.keypoints.push_back({.undistorted = pixel.cast<float>()});
    frame.features.descriptors.emplace_back();
    frame.features.depth.push_back(0.0F);
    frame.features.right_u.push_back(-1.0F);
  }
  return frame;
}

TEST(ImageVelocity, IsTheDerivativeOfTheProjection) {
  const Sensor sensor = SyntheticSensor();
  const Eigen::Vector3d point(0.7, -0.4, 2.5);
  constexpr double kStep = 1e-6;
  const Eigen::Vector2d expected = (sensor.camera.Project(MotionUntil(kStep) * point) -
                                    sensor.camera.Project(MotionUntil(-kStep) * point)) /
                                   (2.0 * kStep);
  const Eigen::Vector2d velocity =
      ImageVelocity(sensor.camera, Velocity(), sensor.camera.Project(point), 1.0 / point.z());
  EXPECT_LT((velocity - expected).norm(), 1e-4) << velocity.transpose();
}

TEST(ImageVelocity, OfAPointAtInfinityIsThatOfTheRotation) {
  const PinholeCamera camera = SyntheticSensor().camera;
  const Eigen::Vector2d center(camera.cx, camera.cy);
  const PointVelocity velocity{{0.0, 0.1, 0.0}, {1.0, 2.0, 3.0}};
  const Eigen::Vector2d moved = ImageVelocity(camera, velocity, center, 0.0);
  EXPECT_NEAR(moved.x(), 50.0, 1e-9);
  EXPECT_NEAR(moved.y(), 0.0, 1e-9);
}

TEST(MeanVelocity, IsThatOfTheMotion) {
  const PointVelocity velocity = MeanVelocity(MotionUntil(0.01), 0.01);
  EXPECT_LT((velocity.angular - Velocity().angular).norm(), 1e-9);
  EXPECT_LT((velocity.linear - Velocity().linear).norm(), 1e-2);
}

struct Shutter {
  double k1 = 0.0;  // of the lens
  double readout_time = 0.0;
  ReadoutDirection direction = ReadoutDirection::kRows;
};

class GlobalShutter : public testing::TestWithParam<Shutter> {};

TEST_P(GlobalShutter, SeesPointsWhereTheMiddleRowWouldSeeThem) {
  Sensor sensor = RollingSensor();
  sensor.camera.k1 = GetParam().k1;
  sensor.readout_time = GetParam().readout_time;
  sensor.readout_direction = GetParam().direction;
  std::vector<Eigen::Vector2d> seen, middle;
  std::vector<double> inverse_depths;
  for (const double x : {-0.8, -0.3, 0.8}) {
    for (const double y : {-0.7, -0.2, 0.4, 0.7}) {
      const Eigen::Vector3d point(x, y, 2.0 + 0.5 * x);
      seen.push_back(SeenWhileMoving(sensor, point));
      middle.push_back(sensor.camera.Project(point));
      inverse_depths.push_back(1.0 / point.z());
    }
  }
  const auto corrected = WithGlobalShutter(FrameOf(seen), sensor, Velocity(), inverse_depths);
  double before = 0.0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector2d pixel = corrected->features.keypoints[i].undistorted.cast<double>();
    EXPECT_LT((pixel - middle[i]).norm(), 0.06) << middle[i].transpose();
    before = std::max(before, (seen[i] - middle[i]).norm());
  }
  EXPECT_GT(before, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Shutters, GlobalShutter,
                         testing::Values(Shutter{0.0, kReadout}, Shutter{0.2, kReadout},
                                         Shutter{0.2, -kReadout},
                                         Shutter{0.2, kReadout, ReadoutDirection::kColumns},
                                         Shutter{0.2, -kReadout, ReadoutDirection::kColumns}));

TEST(WithGlobalShutter, FindsKeypointsWhereTheyAreNow) {
  const Sensor sensor = RollingSensor();
  const std::vector<double> depths = {1.0};
  const auto corrected =
      WithGlobalShutter(FrameOf({{600.0, 470.0}}), sensor, {.linear = {2.0, -3.0, 0.0}}, depths);
  const FrameFeatures& features = corrected->features;
  std::vector<uint32_t> found;
  features.grid.FindNear(features.keypoints, features.keypoints[0].undistorted, 0.5F, 0, 7, found);
  EXPECT_EQ(found, std::vector<uint32_t>{0});
}

// The disparity belongs to the depth, which does not change.
TEST(WithGlobalShutter, KeepsDisparities) {
  const Sensor sensor = RollingSensor();
  Frame frame = FrameOf({{100.0, 450.0}, {100.0, 450.0}});
  frame.features.depth[0] = 2.0F;
  frame.features.right_u[0] = 80.0F;
  const std::vector<double> depths = {0.5, 0.5};
  const auto corrected = WithGlobalShutter(frame, sensor, {.linear = {1.0, 0.0, 0.0}}, depths);
  const FrameFeatures& features = corrected->features;
  EXPECT_NEAR(features.keypoints[0].undistorted.x(), 100.0 - 250.0 * kReadout * 210.0 / 480.0,
              1e-3);
  EXPECT_FLOAT_EQ(features.keypoints[0].undistorted.x() - features.right_u[0], 20.0F);
  EXPECT_EQ(features.depth[0], 2.0F);
  EXPECT_EQ(features.right_u[1], -1.0F);
}

TEST(WithGlobalShutter, LeavesTheFrameOfAStillCameraAsItIs) {
  Frame frame = FrameOf({{100.0, 450.0}});
  frame.id = FrameId(7);
  frame.timestamp = 3.5;
  const std::vector<double> depths = {0.5};
  const auto corrected = WithGlobalShutter(frame, RollingSensor(), {}, depths);
  EXPECT_EQ(corrected->features.keypoints[0].undistorted, frame.features.keypoints[0].undistorted);
  EXPECT_EQ(corrected->id, frame.id);
  EXPECT_EQ(corrected->timestamp, frame.timestamp);
}

// A detection of a square of 100 px at the bottom of the image with all that it may have.
Detection SquareAtTheBottom() {
  Detection detection;
  detection.hull = {{200.0, 370.0}, {300.0, 370.0}, {300.0, 470.0}, {200.0, 470.0}};
  detection.contour = PackedPoints<2>(detection.hull);
  for (const Eigen::Vector2d& corner : detection.hull) {
    detection.box.extend(corner);
  }
  const Eigen::Vector2d outwards = Eigen::Vector2d(1.0, 1.0).normalized();
  detection.lines = {{{Eigen::Vector2d::UnitX(), -300.0}, false},
                     {{outwards, -outwards.dot(detection.hull[2])}, true}};
  detection.ellipse = Ellipse{{250.0, 420.0}, Eigen::Vector2d(2500.0, 900.0).asDiagonal()};
  detection.keypoints = {0, 1, 2};
  return detection;
}

TEST(WithGlobalShutter, MovesDetectionsWithTheirKeypoints) {
  const Sensor sensor = RollingSensor();
  const Detection before = SquareAtTheBottom();
  Frame frame = FrameOf({{250.0, 420.0}, {260.0, 430.0}, {240.0, 425.0}, {10.0, 10.0}});
  frame.detections = {before};
  // One keypoint of unknown depth does not make the object infinitely far.
  const std::vector<double> depths = {0.5, 0.5, 0.0, 2.0};
  const auto corrected = WithGlobalShutter(frame, sensor, {.linear = {1.0, 0.4, 0.0}}, depths);
  const Detection& after = corrected->detections[0];
  const auto expected = [](const Eigen::Vector2d& point) -> Eigen::Vector2d {
    return point - kReadout * (point.y() / 480.0 - 0.5) * Eigen::Vector2d(250.0, 100.0);
  };
  for (size_t i = 0; i < before.hull.size(); ++i) {
    EXPECT_LT((after.hull[i] - expected(before.hull[i])).norm(), 1e-9);
    EXPECT_LT((after.contour.Unpack()[i] - after.hull[i]).norm(), 0.01);
  }
  EXPECT_NEAR(after.box.max().y(), expected(before.hull[2]).y(), 1e-9);
  // Lines still touch the corners, and the ellipse still touches what it touched.
  EXPECT_NEAR(after.lines[0].line.SignedDistance(after.hull[1]), 0.0, 1e-9);
  EXPECT_NEAR(after.lines[0].line.SignedDistance(after.hull[2]), 0.0, 1e-9);
  EXPECT_NEAR(after.lines[1].line.SignedDistance(after.hull[2]), 0.0, 1e-9);
  EXPECT_LT(after.lines[1].line.SignedDistance(after.hull[0]), -100.0);
  EXPECT_NEAR(after.lines[1].line.normal.norm(), 1.0, 1e-12);
  EXPECT_TRUE(after.lines[1].is_one_sided);
  EXPECT_LT((after.ellipse->center - expected(before.ellipse->center)).norm(), 1e-9);
  EXPECT_NEAR(after.lines[0].line.SignedDistance(after.ellipse->center) +
                  after.ellipse->HalfExtent(after.lines[0].line.normal),
              0.0, 1e-9);
}

TEST(WithGlobalShutter, MovesDetectionsByTheColumnsOfAShutterThatReadsColumns) {
  Sensor sensor = RollingSensor();
  sensor.readout_time = -kReadout;
  sensor.readout_direction = ReadoutDirection::kColumns;
  const Detection before = SquareAtTheBottom();
  Frame frame = FrameOf({{250.0, 420.0}, {260.0, 430.0}, {240.0, 425.0}});
  frame.detections = {before};
  const std::vector<double> depths = {0.5, 0.5, 0.5};
  const auto corrected = WithGlobalShutter(frame, sensor, {.linear = {1.0, 0.4, 0.0}}, depths);
  for (size_t i = 0; i < before.hull.size(); ++i) {
    const Eigen::Vector2d& point = before.hull[i];
    const Eigen::Vector2d expected =
        point + kReadout * (point.x() / 640.0 - 0.5) * Eigen::Vector2d(250.0, 100.0);
    EXPECT_LT((corrected->detections[0].hull[i] - expected).norm(), 1e-9);
  }
}

// A detection without keypoints must not count as infinitely far away.
TEST(WithGlobalShutter, ADetectionWithoutKeypointsIsAsFarAwayAsTheRest) {
  Frame frame = FrameOf({{250.0, 20.0}, {260.0, 30.0}, {240.0, 25.0}, {10.0, 10.0}});
  frame.detections = {SquareAtTheBottom()};
  frame.detections[0].keypoints = {3};
  const std::vector<double> depths = {0.5, 0.5, 0.25, 0.0};
  const auto corrected =
      WithGlobalShutter(frame, RollingSensor(), {.linear = {1.0, 0.0, 0.0}}, depths);
  EXPECT_NEAR(corrected->detections[0].hull[0].x(),
              200.0 - 250.0 * kReadout * (370.0 / 480.0 - 0.5), 1e-9);
}

TEST(WithGlobalShutter, NeedsADepthPerKeypoint) {
  EXPECT_THROW(WithGlobalShutter(FrameOf({{100.0, 450.0}}), RollingSensor(), {}, {}), CheckError);
}

}  // namespace
}  // namespace hullslam
