// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/constraint/misfit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "costs/quadric_tangent.h"
#include "geometry/polygon.h"
#include "objects/made_objects.h"
#include "support/fisheye_camera.h"
#include "support/random_geometry.h"
#include "support/test_cameras.h"

namespace hullslam {
namespace {

// The hull of a square of raw pixels, and its right side as a line.
Detection SquareAt(const PinholeCamera& camera, const Eigen::Vector2d& center) {
  Detection detection;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(-9.0, -9.0), {9.0, -9.0}, {9.0, 9.0}, {-9.0, 9.0}}) {
    detection.hull.push_back(camera.Undistort(center + corner));
  }
  const Eigen::Vector2d along = (detection.hull[2] - detection.hull[1]).normalized();
  const Eigen::Vector2d normal(along.y(), -along.x());
  detection.lines.push_back({.line = {.normal = normal, .offset = -normal.dot(detection.hull[1])}});
  return detection;
}

TEST(RawLines, DistancesAreThoseOfTheRawImage) {
  const PinholeCamera camera = FisheyeCamera();
  for (const Eigen::Vector2d& center :
       {Eigen::Vector2d(320.0, 240.0), {560.0, 240.0}, {580.0, 330.0}, {40.0, 120.0}}) {
    const Detection detection = SquareAt(camera, center);
    const auto lines = ScaleToRaw(camera, detection, detection.lines);
    ASSERT_EQ(lines.size(), 1u);
    // A point a fifth of a raw px to the right of an end of the side.
    const Eigen::Vector2d beyond = camera.Undistort(center + Eigen::Vector2d(9.2, -9.0));
    EXPECT_NEAR(lines[0].line.SignedDistance(beyond), 0.2, 0.02) << center.transpose();
    EXPECT_NEAR(lines[0].line.SignedDistance(detection.hull[1]), 0.0, 1e-9);
  }
}

TEST(RawLines, WithoutDistortionAreTheSame) {
  PinholeCamera camera = FisheyeCamera();
  camera.lens = LensModel::kBrown;
  camera.k1 = camera.k2 = camera.k3 = camera.k4 = 0.0;
  const Detection detection = SquareAt(camera, {500.0, 200.0});
  const auto lines = ScaleToRaw(camera, detection, detection.lines);
  EXPECT_EQ(lines[0].line.normal, detection.lines[0].line.normal);
  EXPECT_EQ(lines[0].line.offset, detection.lines[0].line.offset);
}

TEST(PlaneOfLine, OfATangentHasNoExcess) {
  const Sensor sensor = MakeObjectSensor();
  RandomGeometry random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const MadeObject object = MakeObject("cup", random.Vector(0.2), {0.05, 0.1, 0.2}, 0.1 * trial);
    const Rigid3 camera = CameraOnCircle(0.2 * trial, 1.5, 0.4);
    for (const SilhouetteLine& line : Detect(object, sensor, camera).lines) {
      const auto plane = PlaneOfLine(sensor.camera, camera, object.ellipsoid, line.line);
      ASSERT_TRUE(plane);
      EXPECT_NEAR(plane->excess, 0.0, 1e-9);
      EXPECT_NEAR(plane->normal.norm(), 1.0, 1e-12);
    }
  }
}

TEST(PlaneOfLine, ExcessIsPixelsOverPixelsPerMetre) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject object = MakeObject("cup", {0.1, 0.0, 0.0}, {0.05, 0.1, 0.2}, 0.5);
  const Rigid3 camera = CameraOnCircle(0.7, 1.5, 0.4);
  for (const SilhouetteLine& line : Detect(object, sensor, camera).lines) {
    Line2 moved = line.line;
    moved.offset -= 0.5;  // px outwards
    const auto plane = PlaneOfLine(sensor.camera, camera, object.ellipsoid, moved);
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->excess * plane->pixels_per_metre, 0.5, 0.01);
  }
}

TEST(PlaneOfLine, IsNoneBehindTheCamera) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject object = MakeObject("cup", {0.0, 0.0, -2.0}, {0.05, 0.1, 0.2});
  EXPECT_FALSE(PlaneOfLine(sensor.camera, Rigid3(), object.ellipsoid, Line2()));
}

TEST(PredictExcess, IsLinearNearby) {
  const Eigen::Vector3d slope(0.01, -0.02, 0.015);
  std::vector<MisfitSample> samples;
  RandomGeometry random(4);
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d normal = random.Vector(1.0).normalized();
    samples.push_back({normal.cast<float>(), static_cast<float>(slope.dot(normal)), KeyframeId(0)});
  }
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d normal = random.Vector(1.0).normalized();
    const auto excess = PredictExcess(samples, normal, KeyframeId());
    ASSERT_TRUE(excess);
    EXPECT_NEAR(*excess, slope.dot(normal), 5e-4);
  }
}

TEST(PredictExcess, LeavesAKeyframeOutAndGivesNothingWithoutSamplesNearby) {
  const std::vector<MisfitSample> samples(3, {Eigen::Vector3f::UnitX(), 0.01f, KeyframeId(5)});
  EXPECT_NEAR(PredictExcess(samples, Eigen::Vector3d::UnitX(), KeyframeId()).value(), 0.01, 1e-9);
  EXPECT_FALSE(PredictExcess(samples, Eigen::Vector3d::UnitX(), KeyframeId(5)));
  EXPECT_FALSE(PredictExcess(samples, Eigen::Vector3d::UnitY(), KeyframeId()));
}

// Samples at one and at two widths, all to one side. Without a prior of the slope their line would
// be extrapolated to 0. By hand: weights 1.213 and 0.271, slope prior 0.3, so 0.68.
TEST(PredictExcess, DoesNotExtrapolateTheSlopeOfSamplesOnOneSide) {
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d across = normal.unitOrthogonal();
  for (const Eigen::Vector3d& side : {across, normal.cross(across).eval()}) {
    std::vector<MisfitSample> samples;
    for (const double widths : {1.0, 1.0, 2.0, 2.0}) {
      const double angle = widths * 4.0 * std::numbers::pi / 180.0;
      const Eigen::Vector3d sampled = std::cos(angle) * normal + std::sin(angle) * side;
      samples.push_back({sampled.cast<float>(), static_cast<float>(widths), KeyframeId(0)});
    }
    const auto excess = PredictExcess(samples, normal, KeyframeId());
    ASSERT_TRUE(excess);
    EXPECT_NEAR(*excess, 0.68, 0.03);
  }
}

// It is not known how far an object reaches beyond a one-sided line.
TEST(MeasureMisfit, LeavesOutOneSidedLines) {
  const Sensor sensor = MakeObjectSensor();
  const MadeObject object = MakeObject("cup", Eigen::Vector3d::Zero(), {0.05, 0.1, 0.2});
  const Rigid3 camera = CameraOnCircle(0.2, 1.5, 0.4);
  Detection detection = Detect(object, sensor, camera);
  const std::vector<ResolvedObservation> observations = {{KeyframeId(0), camera, &detection}};
  EXPECT_EQ(MeasureMisfit(sensor.camera, object.ellipsoid, observations).size(), 16u);
  for (size_t i = 0; i < 5; ++i) {
    detection.lines[i].is_one_sided = true;
    detection.lines[i].line.offset += 30.0;
  }
  const auto samples = MeasureMisfit(sensor.camera, object.ellipsoid, observations);
  EXPECT_EQ(samples.size(), 11u);
  ObjectLandmark landmark;
  landmark.ellipsoid = object.ellipsoid;
  EXPECT_NEAR(MeasureSpread(sensor.camera, landmark, observations, {}).plain_px, 0.0, 1e-6);
}

class SpreadWith : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(SpreadWith);

// The distance of a line from the object is that in the image as read.
TEST_P(SpreadWith, ALineThatIsMovedInTheImageAsReadHasThisSpread) {
  constexpr double kMove = 0.2;  // px
  const Sensor& sensor = GetParam().sensor;
  const PinholeCamera& camera = sensor.camera;
  const MadeObject object = MakeObject("cup", {0.9, 0.4, 1.0}, {0.05, 0.06, 0.07}, 0.5);
  Detection detection = Detect(object, sensor, Rigid3());
  const Ellipse ellipse = ProjectEllipsoid(camera.Matrix(), Rigid3(), object.ellipsoid).value();
  for (SilhouetteLine& line : detection.lines) {
    line.line = MovedInImage(sensor, ellipse, line.line, kMove);
  }
  ObjectLandmark landmark;
  landmark.ellipsoid = object.ellipsoid;
  const std::vector<ResolvedObservation> observations = {{KeyframeId(0), Rigid3(), &detection}};
  EXPECT_NEAR(MeasureSpread(camera, landmark, observations).plain_px, kMove, 0.02 * kMove);
}

// Compensation relies on this law: the excess of a box over an ellipsoid that some observations
// measured is also that of a new observation between them, for every camera and distance.
class BoxForAnEllipsoid : public ::testing::Test {
 protected:
  BoxForAnEllipsoid() {
    box_.ellipsoid = MakeObject("box", Eigen::Vector3d::Zero(), {0.10, 0.14, 0.12}, 0.4).ellipsoid;
    id_ = map_.AddObject();
    for (int i = 0; i < 30; ++i) {
      Map& map = map_;
      const KeyframeId keyframe = AddBoxObserver(map, 0.05 * i, 1.5 + 0.005 * (i % 7));
      map.AddObservation(id_, keyframe, 0);
    }
    ObjectLandmark& object = map_.MutableObject(id_);
    object.has_shape = true;
    object.ellipsoid = box_.ellipsoid;
    object.misfit_samples =
        MeasureMisfit(sensor_.camera, object.ellipsoid, ResolveObservations(map_, object));
  }

  // Lines of the box's silhouette in 16 directions.
  Detection DetectBox(const Rigid3& cam_from_world) const {
    const Eigen::Vector3d half(0.09, 0.12, 0.10);
    std::vector<Eigen::Vector2d> corners;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner = Eigen::Vector3d(
          i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
      corners.push_back(
          sensor_.camera.Project(cam_from_world * (box_.ellipsoid.world_from_object * corner)));
    }
    Detection detection = Detect(box_, sensor_, cam_from_world);
    detection.hull = ConvexHull(corners);
    for (SilhouetteLine& line : detection.lines) {
      double reach = -1e9;
      for (const Eigen::Vector2d& corner : corners) {
        reach = std::max(reach, line.line.normal.dot(corner));
      }
      line.line.offset = -reach;
    }
    return detection;
  }

  KeyframeId AddBoxObserver(Map& map, double angle, double distance) const {
    const Rigid3 cam_from_world = CameraOnCircle(angle, distance, 0.4);
    auto frame = std::make_shared<Frame>();
    frame->id = FrameId(map.keyframes().NextId().value);
    frame->detections.push_back(DetectBox(cam_from_world));
    return map.AddKeyframe(std::move(frame), cam_from_world);
  }

  Sensor sensor_ = MakeObjectSensor();
  MadeObject box_;
  Map map_;
  ObjectId id_;
};

TEST_F(BoxForAnEllipsoid, TheExcessOfSomeViewsIsThatOfOthers) {
  const ObjectLandmark& object = map_.objects().At(id_);
  double plain = 0.0;
  double compensated = 0.0;
  int count = 0;
  for (double angle = 0.225; angle < 1.2; angle += 0.1) {
    const Rigid3 camera = CameraOnCircle(angle, 1.4, 0.42);
    const Detection detection = DetectBox(camera);
    std::vector<uint8_t> known;
    const auto lines =
        CompensateLines(sensor_.camera, camera, object, detection.lines, KeyframeId(), known);
    const Ellipse ellipse =
        ProjectEllipsoid(sensor_.camera.Matrix(), camera, object.ellipsoid).value();
    for (size_t i = 0; i < lines.size(); ++i) {
      if (known[i] == 0) {
        continue;
      }
      const Eigen::Vector2d& normal = lines[i].line.normal;
      const double reach = normal.dot(ellipse.center) + ellipse.HalfExtent(normal);
      plain += std::pow(reach + detection.lines[i].line.offset, 2);
      compensated += std::pow(reach + lines[i].line.offset, 2);
      ++count;
    }
  }
  ASSERT_GT(count, 80);
  EXPECT_GT(std::sqrt(plain / count), 4.0);        // px
  EXPECT_LT(std::sqrt(compensated / count), 1.0);  // px
}

TEST_F(BoxForAnEllipsoid, TheSpreadIsMeasuredOnViewsThatWereLeftOut) {
  const ObjectLandmark& object = map_.objects().At(id_);
  const MisfitSpread spread =
      MeasureSpread(sensor_.camera, object, ResolveObservations(map_, object));
  EXPECT_GT(spread.plain_px, 4.0);
  EXPECT_LT(spread.compensated_px, 0.3 * spread.plain_px);
  EXPECT_GT(spread.compensated_px, 0.0);
}

}  // namespace

}  // namespace hullslam
