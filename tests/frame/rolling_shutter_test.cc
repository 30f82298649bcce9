// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame/rolling_shutter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "features/find_near.h"
#include "hullslam/util/check.h"
#include "support/fisheye_camera.h"
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

enum class Lens { kNone, kBarrel, kFisheye };

PinholeCamera CameraWith(Lens lens) {
  if (lens == Lens::kFisheye) {
    return FisheyeCamera();
  }
  PinholeCamera camera = SyntheticSensor().camera;
  camera.k1 = lens == Lens::kBarrel ? 0.2 : 0.0;
  return camera;
}

struct Shutter {
  Lens lens = Lens::kNone;
  double readout_time = 0.0;
  ReadoutDirection direction = ReadoutDirection::kRows;
};

// Distances are those of the raw image, since the undistorted one of a fisheye lens is stretched.
class GlobalShutter : public testing::TestWithParam<Shutter> {
 protected:
  GlobalShutter() {
    sensor_.camera = CameraWith(GetParam().lens);
    sensor_.bounds = sensor_.camera.UndistortedBounds();
    sensor_.readout_time = GetParam().readout_time;
    sensor_.readout_direction = GetParam().direction;
  }
  double RawDistance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    return (sensor_.camera.Distort(a) - sensor_.camera.Distort(b)).norm();
  }
  // The factor by which the field of view is wider than that of the camera without a fisheye lens.
  double Wide() const { return GetParam().lens == Lens::kFisheye ? 4.0 : 1.0; }

  Sensor sensor_ = SyntheticSensor();
};

TEST_P(GlobalShutter, SeesPointsWhereTheMiddleRowWouldSeeThem) {
  std::vector<Eigen::Vector2d> seen, middle;
  std::vector<double> inverse_depths;
  for (const double x : {-0.8, -0.3, 0.8}) {
    for (const double y : {-0.7, -0.2, 0.4, 0.7}) {
      const Eigen::Vector3d point(Wide() * x, Wide() * y, 2.0 + 0.5 * x);
      seen.push_back(SeenWhileMoving(sensor_, point));
      middle.push_back(sensor_.camera.Project(point));
      inverse_depths.push_back(1.0 / point.z());
    }
  }
  const auto corrected = WithGlobalShutter(FrameOf(seen), sensor_, Velocity(), inverse_depths);
  double before = 0.0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector2d pixel = corrected->features.keypoints[i].undistorted.cast<double>();
    EXPECT_LT(RawDistance(pixel, middle[i]), 0.03) << middle[i].transpose();
    before = std::max(before, RawDistance(seen[i], middle[i]));
  }
  EXPECT_GT(before, 1.5);
}

// The outline of a disc that faces the camera, all at one depth, as the shutter sees it.
TEST_P(GlobalShutter, SeesOutlinesWhereTheMiddleRowWouldSeeThem) {
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(0.0, 0.0), {0.5, 0.4}, {-0.6, -0.45}, {0.6, -0.4}}) {
    const Eigen::Vector3d center(Wide() * place.x(), Wide() * place.y(), 2.0);
    Detection detection;
    std::vector<Eigen::Vector2d> middle;
    for (int i = 0; i < 40; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 40;
      const Eigen::Vector3d point =
          center + 0.2 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      detection.hull.push_back(SeenWhileMoving(sensor_, point));
      detection.box.extend(detection.hull.back());
      middle.push_back(sensor_.camera.Project(point));
    }
    for (const double angle : {0.3, 1.7, 2.9, 4.4}) {
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
      double reach = normal.dot(detection.hull[0]);
      for (const Eigen::Vector2d& corner : detection.hull) {
        reach = std::max(reach, normal.dot(corner));
      }
      detection.lines.push_back({{normal, -reach}, false});
    }
    detection.contour = PackedPoints<2>(detection.hull);
    Frame frame = FrameOf({sensor_.camera.Project(center)});
    frame.detections = {detection};
    const std::vector<double> inverse_depths = {0.5};
    const auto corrected = WithGlobalShutter(frame, sensor_, Velocity(), inverse_depths);
    const Detection& after = corrected->detections[0];
    for (size_t i = 0; i < middle.size(); ++i) {
      EXPECT_LT(RawDistance(after.hull[i], middle[i]), 0.05) << place.transpose();
      EXPECT_LT(RawDistance(after.contour.Unpack()[i], middle[i]), 0.05);
    }
    for (const SilhouetteLine& line : after.lines) {  // they still touch the hull
      double nearest = -1e9;
      for (const Eigen::Vector2d& corner : after.hull) {
        nearest = std::max(nearest, line.line.SignedDistance(corner));
      }
      EXPECT_NEAR(nearest, 0.0, 0.02);
      EXPECT_NEAR(line.line.normal.norm(), 1.0, 1e-12);
    }
  }
}

// Masks may come after the frame was tracked.
TEST_P(GlobalShutter, DetectionsThatComeLaterAreCorrectedAsThoseInTime) {
  Frame frame =
      FrameOf({sensor_.camera.Undistort({250.0, 420.0}), sensor_.camera.Undistort({260.0, 430.0}),
               sensor_.camera.Undistort({100.0, 40.0})});
  Detection square;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(200.0, 370.0), {300.0, 370.0}, {300.0, 470.0}, {200.0, 470.0}}) {
    square.hull.push_back(sensor_.camera.Undistort(corner));
    square.box.extend(square.hull.back());
  }
  square.keypoints = {0, 1};
  const std::vector<double> inverse_depths = {0.5, 0.4, 1.5};
  const auto late = WithGlobalShutter(frame, sensor_, Velocity(), inverse_depths);
  std::vector<Detection> detections = {square};
  ASSERT_NE(late->shutter, nullptr);
  CorrectDetections(sensor_, *late->shutter, detections);
  frame.detections = {square};
  const auto in_time = WithGlobalShutter(frame, sensor_, Velocity(), inverse_depths);
  EXPECT_EQ(in_time->shutter, nullptr) << "its detections are corrected already";
  EXPECT_EQ(detections[0].hull, in_time->detections[0].hull);
  EXPECT_NE(detections[0].hull, square.hull);
}

INSTANTIATE_TEST_SUITE_P(
    Shutters, GlobalShutter,
    testing::Values(Shutter{Lens::kNone, kReadout}, Shutter{Lens::kBarrel, kReadout},
                    Shutter{Lens::kBarrel, -kReadout},
                    Shutter{Lens::kBarrel, kReadout, ReadoutDirection::kColumns},
                    Shutter{Lens::kBarrel, -kReadout, ReadoutDirection::kColumns},
                    Shutter{Lens::kFisheye, kReadout}, Shutter{Lens::kFisheye, -kReadout},
                    Shutter{Lens::kFisheye, kReadout, ReadoutDirection::kColumns}));

TEST(WithGlobalShutter, FindsKeypointsWhereTheyAreNow) {
  const Sensor sensor = RollingSensor();
  const std::vector<double> depths = {1.0};
  const auto corrected =
      WithGlobalShutter(FrameOf({{600.0, 470.0}}), sensor, {.linear = {2.0, -3.0, 0.0}}, depths);
  const FrameFeatures& features = corrected->features;
  std::vector<uint32_t> found;
  FindNear(features.grid, features.keypoints, features.keypoints[0].undistorted, 0.5F, 0, 7, found);
  EXPECT_EQ(found, std::vector<uint32_t>{0});
}

// A slanted wall, z = 2 + 0.5 x + 0.3 y at the exposure of the middle row. Its depth image is taken
// 20 ms later, whose stamp is right within 4 ms.
TEST(WithGlobalShutter, DepthsAreThoseOfTheMiddleRow) {
  Sensor sensor = RollingSensor();
  sensor.depth_time = -0.004;
  constexpr double kDelay = 0.024;
  const Eigen::Vector3d normal(-0.5, -0.3, 1.0);
  const auto depth_at = [&](const Eigen::Vector2d& pixel, double row) {
    const Rigid3 motion =
        MotionUntil((row / sensor.camera.height - 0.5) * kReadout + kDelay + sensor.depth_time);
    const Eigen::Vector3d turned = motion.rotation * normal;  // turned^T x = 2 + turned^T t
    return (2.0 + turned.dot(motion.translation)) / turned.dot(sensor.camera.Unproject(pixel, 1.0));
  };
  std::vector<Eigen::Vector2d> seen;
  std::vector<double> inverse_depths, expected;
  for (const double x : {-0.8, 0.1, 0.8}) {
    for (const double y : {-0.6, 0.0, 0.6}) {
      const Eigen::Vector3d point(x, y, 2.0 + 0.5 * x + 0.3 * y);
      seen.push_back(SeenWhileMoving(sensor, point));
      inverse_depths.push_back(1.0 / point.z());
      expected.push_back(point.z());
    }
  }
  Frame frame = FrameOf(seen);
  frame.depth_delay = kDelay;
  cv::Mat depth(sensor.camera.height, sensor.camera.width, CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      depth.at<float>(y, x) =
          static_cast<float>(depth_at(sensor.camera.Undistort(Eigen::Vector2d(x, y)), y));
    }
  }
  frame.depth = DepthGrid(depth, 1.0);
  double before = 0.0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const double z = depth_at(seen[i], sensor.camera.Distort(seen[i]).y());
    before = std::max(before, std::abs(z - expected[i]));
    frame.features.depth[i] = static_cast<float>(z);
  }
  EXPECT_GT(before, 0.02);
  const auto corrected = WithGlobalShutter(frame, sensor, Velocity(), inverse_depths);
  for (size_t i = 0; i < seen.size(); ++i) {
    EXPECT_NEAR(corrected->features.depth[i], expected[i], 1e-3) << i;
    EXPECT_EQ(corrected->shutter->depths[i], frame.features.depth[i]);
  }
}

TEST(WithGlobalShutter, KeepsDepthsThatDoNotChange) {
  const Sensor sensor = RollingSensor();
  Frame frame = FrameOf({{100.0, 450.0}, {100.0, 450.0}});
  frame.features.depth[0] = 2.0F;
  const std::vector<double> depths = {0.5, 0.5};
  const auto corrected = WithGlobalShutter(frame, sensor, {.linear = {1.0, 0.0, 0.0}}, depths);
  const FrameFeatures& features = corrected->features;
  EXPECT_NEAR(features.keypoints[0].undistorted.x(), 100.0 - 250.0 * kReadout * 210.0 / 480.0,
              1e-3);
  EXPECT_EQ(features.depth[0], 2.0F);
  EXPECT_EQ(features.depth[1], 0.0F);
}

TEST(BeforeCorrection, UndoesTheCorrection) {
  const Sensor sensor = RollingSensor();
  const Frame frame = FrameOf({{100.0, 450.0}, {500.0, 30.0}, {320.0, 100.0}});
  const std::vector<double> depths = {0.5, 1.0, 0.0};
  const PointVelocity velocity{.angular = {0.5, -0.4, 0.8}, .linear = {1.0, 0.3, -0.5}};
  const auto corrected = WithGlobalShutter(frame, sensor, velocity, depths);
  ASSERT_NE(corrected->shutter, nullptr);
  for (size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d moved = corrected->features.keypoints[i].undistorted.cast<double>();
    const Eigen::Vector2d read = frame.features.keypoints[i].undistorted.cast<double>();
    EXPECT_GT((moved - read).norm(), 1.0);
    EXPECT_LT((BeforeCorrection(sensor, *corrected->shutter, moved, i) - read).norm(), 1e-3);
  }
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

// A line of the right image is moved by the motion of its points in that image.
TEST(WithGlobalShutter, MovesTheLinesOfTheRightImage) {
  Sensor sensor = RollingSensor();
  sensor.kind = SensorKind::kStereo;
  sensor.camera.bf = 250.0;  // 0.5 m
  const PointVelocity velocity{{0.4, -0.6, 0.8}, {-0.4, 0.6, 0.3}};
  const auto motion_until = [&](double time) {
    return Rigid3(ExpSo3(time * velocity.angular), time * velocity.linear);
  };
  const auto seen_by_right = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d baseline(sensor.baseline(), 0.0, 0.0);
    Eigen::Vector2d pixel = sensor.camera.Project(point - baseline);
    for (int i = 0; i < 20; ++i) {
      const double time = (pixel.y() / sensor.camera.height - 0.5) * sensor.readout_time;
      pixel = sensor.camera.Project(motion_until(time) * point - baseline);
    }
    return pixel;
  };
  // The lower side of a square at 2 m, near the bottom of the image.
  const Eigen::Vector3d left(-0.1, 0.8, 2.0), right(0.0, 0.8, 2.0);
  const Eigen::Vector2d a = seen_by_right(left), b = seen_by_right(right);
  const Eigen::Vector2d normal = Eigen::Vector2d(a.y() - b.y(), b.x() - a.x()).normalized();
  Detection detection = SquareAtTheBottom();
  detection.hull = {sensor.camera.Project({-0.1, 0.7, 2.0}), sensor.camera.Project({0.0, 0.7, 2.0}),
                    sensor.camera.Project(right), sensor.camera.Project(left)};
  detection.keypoints = {0};
  detection.right_lines = {{{normal, -normal.dot(a)}, false}};
  Frame frame = FrameOf({sensor.camera.Project({-0.05, 0.75, 2.0})});
  frame.detections = {detection};
  const std::vector<double> inverse_depths = {0.5};
  const auto corrected = WithGlobalShutter(frame, sensor, velocity, inverse_depths);
  const Line2& line = corrected->detections[0].right_lines[0].line;
  const Eigen::Vector3d baseline(sensor.baseline(), 0.0, 0.0);
  for (const Eigen::Vector3d& point : {left, right}) {
    EXPECT_GT((seen_by_right(point) - sensor.camera.Project(point - baseline)).norm(), 2.0);
    EXPECT_NEAR(line.SignedDistance(sensor.camera.Project(point - baseline)), 0.0, 0.05);
  }
}

TEST(WithGlobalShutter, NeedsADepthPerKeypoint) {
  EXPECT_THROW(WithGlobalShutter(FrameOf({{100.0, 450.0}}), RollingSensor(), {}, {}), CheckError);
}

}  // namespace
}  // namespace hullslam
