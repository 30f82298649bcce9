// SPDX-License-Identifier: GPL-3.0-or-later
#include "optim/joint_pose_optimization.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "hullslam/geometry/rigid3.h"
#include "objects/made_objects.h"
#include "support/fisheye_camera.h"
#include "support/pose_distance.h"
#include "support/random_geometry.h"
#include "support/synthetic_world.h"

namespace hullslam {
namespace {

Eigen::Vector3d Center(const Rigid3& cam_from_world) { return Inverse(cam_from_world).translation; }

// Moves the outline by (dx, dy) px.
void Shift(Detection& detection, double dx, double dy) {
  for (SilhouetteLine& line : detection.lines) {
    line.line.offset -= line.line.normal.dot(Eigen::Vector2d(dx, dy));
  }
}

// A camera with points and objects in front of it, and its measurements of them from its true pose.
class JointPose : public ::testing::Test {
 protected:
  void MakeScene(uint32_t seed) {
    random_ = RandomGeometry(seed);
    generator_.seed(seed);
    true_pose_ = random_.Pose(1.0, 2.0);
    ellipsoids_.clear();
    detections_.clear();
    observations_.clear();
  }
  // Objects at the left, in the middle and at the right of the image, 2 to 4 m away.
  void AddObjects(int count, double line_noise = 0.0) {
    for (int i = 0; i < count; ++i) {
      MadeObject object;
      const Rigid3 cam_from_object(ExpSo3(random_.Vector(1.0)),
                                   {0.9 * (i % 3 - 1) + random_.Number(-0.2, 0.2),
                                    random_.Number(-0.7, 0.7), random_.Number(2.0, 4.0)});
      object.ellipsoid.world_from_object = Inverse(true_pose_) * cam_from_object;
      object.ellipsoid.half_axes = {random_.Number(0.1, 0.3), random_.Number(0.1, 0.3),
                                    random_.Number(0.1, 0.3)};
      Detection detection = Detect(object, sensor_, true_pose_);
      for (SilhouetteLine& line : detection.lines) {
        line.line.offset += line_noise * normal_(generator_);
      }
      ellipsoids_.push_back(object.ellipsoid);
      detections_.push_back(std::move(detection));
    }
  }
  // Points within `reach` (m) of a position in the camera frame, measured with noise of `noise` px.
  void AddPoints(int count, const Eigen::Vector3d& position, const Eigen::Vector3d& reach,
                 double noise) {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d in_cam = position + random_.Vector(1.0).cwiseProduct(reach);
      PoseObservation& observation = observations_.emplace_back();
      observation.point = Inverse(true_pose_) * in_cam;
      Eigen::Vector3d measured = ProjectRgbd(sensor_.camera, in_cam);
      for (int k = 0; k < 3; ++k) {
        measured[k] += noise * normal_(generator_);
      }
      observation.measurement =
          PointMeasurement::Create(measured.head<2>(), 1.0, measured.z(), {.pixel_sigma = 1.0});
    }
  }
  void AddSpreadPoints(int count, double noise) {
    AddPoints(count, {0.0, 0.0, 4.0}, {1.2, 0.9, 2.0}, noise);
  }
  // The sigma of the lines comes from the misfit alone: Optimize sets their own sigma to 0.
  std::vector<PoseObject> Objects(double sigma_px) const {
    std::vector<PoseObject> objects;
    for (size_t i = 0; i < detections_.size(); ++i) {
      objects.push_back({ellipsoids_[i], &detections_[i], detections_[i].lines, sigma_px});
    }
    return objects;
  }
  JointPoseResult Optimize(const Rigid3& start, double sigma_px,
                           ObjectPoseOptions options = {}) const {
    options.constraint.sigma_px = 0.0;
    return OptimizeJointPose(sensor_.camera, start, observations_, Objects(sigma_px),
                             {.objects = options});
  }
  Rigid3 Start(double angle = 0.01, double distance = 0.02) {
    return random_.Pose(angle, distance) * true_pose_;
  }

  const Sensor sensor_ = SyntheticSensor();
  RandomGeometry random_{1};
  std::mt19937 generator_;
  mutable std::normal_distribution<double> normal_;
  Rigid3 true_pose_;
  std::vector<Ellipsoid> ellipsoids_;
  std::vector<Detection> detections_;
  std::vector<PoseObservation> observations_;
};

TEST_F(JointPose, ExactTangentsRecoverThePose) {
  for (uint32_t seed = 1; seed <= 10; ++seed) {
    MakeScene(seed);
    AddObjects(3);
    AddSpreadPoints(20, 0.0);
    const JointPoseResult result = Optimize(Start(), 1.5);
    // The remaining error comes from the prior.
    EXPECT_LT(Distance(result.points.cam_from_world, true_pose_), 2e-4);
    EXPECT_EQ(result.points.inlier_count, 20);
    EXPECT_EQ(result.used_objects, 3);
    EXPECT_EQ(result.object_used, std::vector<uint8_t>(3, 1));
  }
}

// The remaining error comes from the prior, in the directions that four outlines constrain least.
TEST_F(JointPose, ObjectsAloneRecoverThePose) {
  double sum = 0.0;
  double start_sum = 0.0;
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    MakeScene(seed);
    AddObjects(4);
    const Rigid3 start = Start();
    const JointPoseResult result = Optimize(start, 1.5);
    EXPECT_EQ(result.used_objects, 4);
    sum += Distance(result.points.cam_from_world, true_pose_);
    start_sum += Distance(start, true_pose_);
    EXPECT_LT(Distance(result.points.cam_from_world, true_pose_), Distance(start, true_pose_));
  }
  EXPECT_LT(sum, 0.2 * start_sum);
}

TEST_F(JointPose, OtherResidualsRecoverThePoseToo) {
  for (const auto& [residual, primitive] :
       {std::pair(ObjectResidual::kAlgebraicPlane, ObjectPrimitive::kHull),
        {ObjectResidual::kRelativePlane, ObjectPrimitive::kHull},
        {ObjectResidual::kAlgebraicPoint, ObjectPrimitive::kContour},
        {ObjectResidual::kOverlap, ObjectPrimitive::kBox}}) {
    ObjectPoseOptions options;
    options.constraint.residual = residual;
    double sum = 0.0;
    double start_sum = 0.0;
    for (uint32_t seed = 1; seed <= 10; ++seed) {
      MakeScene(seed);
      AddObjects(4);
      for (Detection& detection : detections_) {
        detection.primitive = primitive;
      }
      const Rigid3 start = Start();
      sum += Distance(Optimize(start, 1.5, options).points.cam_from_world, true_pose_);
      start_sum += Distance(start, true_pose_);
    }
    EXPECT_LT(sum, 0.5 * start_sum) << NameOf(residual);
  }
}

TEST_F(JointPose, WithoutObjectsItEqualsOptimizePoseToTheLastBit) {
  MakeScene(1);
  AddSpreadPoints(60, 1.0);
  const Rigid3 start = Start();
  const PoseOptimizationResult expected = OptimizePose(sensor_.camera, start, observations_);
  const JointPoseResult result = Optimize(start, 1.5);
  EXPECT_EQ(result.points.cam_from_world.rotation.coeffs(),
            expected.cam_from_world.rotation.coeffs());
  EXPECT_EQ(result.points.cam_from_world.translation, expected.cam_from_world.translation);
  EXPECT_EQ(result.points.is_inlier, expected.is_inlier);
  EXPECT_EQ(result.used_objects, 0);
}

// The outline of each object is shifted by 40 px in a random direction.
// The squared error of the pose in units of its covariance is 6 in the mean. Leaving out the
// largest errors as outliers makes it a little larger.
TEST_F(JointPose, TheInformationTellsHowFarNoiseMovesThePose) {
  constexpr uint32_t kRuns = 200;
  double sum = 0.0;
  for (uint32_t seed = 1; seed <= kRuns; ++seed) {
    MakeScene(seed);
    AddSpreadPoints(60, 1.0);
    const JointPoseResult result = Optimize(Start(), 1.5);
    const Rigid3 step = result.points.cam_from_world * Inverse(true_pose_);
    Eigen::Matrix<double, 6, 1> error;
    error << LogSo3(step.rotation), step.translation;
    sum += error.dot(result.information * error);
  }
  EXPECT_GT(sum / kRuns, 5.0);
  EXPECT_LT(sum / kRuns, 8.0);
}

TEST_F(JointPose, ObjectsAddInformation) {
  MakeScene(1);
  AddSpreadPoints(20, 0.0);
  const JointPoseResult points = Optimize(Start(), 1.5);
  AddObjects(3);
  const JointPoseResult joint = Optimize(Start(), 1.5);
  ASSERT_EQ(joint.used_objects, 3);
  EXPECT_LT(CornerSigma(sensor_.camera, joint.information, 3.0),
            CornerSigma(sensor_.camera, points.information, 3.0));
}

TEST_F(JointPose, WrongDetectionsDoNotHarmAHundredPoints) {
  double with = 0.0;
  double without = 0.0;
  int dropped = 0;
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    MakeScene(seed);
    AddSpreadPoints(100, 1.0);
    const Rigid3 start = Start();
    without += Distance(Optimize(start, 3.0).points.cam_from_world, true_pose_);
    AddObjects(4);
    for (Detection& detection : detections_) {
      const double angle = random_.Number(0.0, 6.28);
      Shift(detection, 40.0 * std::cos(angle), 40.0 * std::sin(angle));
    }
    const JointPoseResult result = Optimize(start, 3.0);
    with += Distance(result.points.cam_from_world, true_pose_);
    dropped += result.dropped_objects;
  }
  EXPECT_LT(with, 1.03 * without);
  EXPECT_EQ(dropped, 4 * 20);
}

// The points lie within 30 cm of each other, so a rotation and a translation of the camera have
// similar effects. The improvement must not come from the prior alone: for comparison, objects with
// a sigma of 1e5 px add hardly anything but the prior.
TEST_F(JointPose, ObjectsHelpWhenTheFewPointsAreCloseTogether) {
  double with = 0.0;
  double without = 0.0;
  double with_prior = 0.0;
  const auto error = [this](const Rigid3& start, double sigma_px) {
    return (Center(Optimize(start, sigma_px).points.cam_from_world) - Center(true_pose_)).norm();
  };
  for (uint32_t seed = 1; seed <= 50; ++seed) {
    MakeScene(seed);
    AddPoints(9, {0.8, 0.5, 3.0}, {0.15, 0.15, 0.15}, 1.0);
    const Rigid3 start = Start();
    without += error(start, 3.0);
    AddObjects(3, 3.0);
    with += error(start, 3.0);
    with_prior += error(start, 1e5);
  }
  EXPECT_LT(with, 0.6 * without);
  EXPECT_LT(with, 0.8 * with_prior);
}

TEST_F(JointPose, ReportsWhichObjectWasDropped) {
  MakeScene(3);
  AddSpreadPoints(50, 1.0);
  AddObjects(3);
  Shift(detections_[1], 60.0, 0.0);
  const JointPoseResult result = Optimize(Start(), 2.0);
  EXPECT_EQ(result.object_used, (std::vector<uint8_t>{1, 0, 1}));
  EXPECT_EQ(result.used_objects, 2);
  EXPECT_EQ(result.dropped_objects, 1);
}

TEST_F(JointPose, ObjectsWithoutOutlineAreNeitherUsedNorDropped) {
  MakeScene(4);
  AddSpreadPoints(50, 1.0);
  AddObjects(3);
  ellipsoids_[0].world_from_object.translation =
      Inverse(true_pose_) * Eigen::Vector3d(0.0, 0.0, -2.0);
  detections_[1].lines.clear();
  const JointPoseResult result = Optimize(Start(), 2.0);
  EXPECT_EQ(result.object_used, (std::vector<uint8_t>{0, 0, 1}));
  EXPECT_EQ(result.dropped_objects, 0);
  EXPECT_LT(Distance(result.points.cam_from_world, true_pose_), 0.02);
}

TEST_F(JointPose, OneObjectAloneIsTooFewForAPose) {
  MakeScene(5);
  AddObjects(1);
  const Rigid3 start = Start();
  EXPECT_EQ(Distance(Optimize(start, 1.5).points.cam_from_world, start), 0.0);
  EXPECT_GT(Distance(Optimize(start, 1.5, {.min_objects = 1}).points.cam_from_world, start), 0.0);
}

TEST_F(JointPose, OneObjectAndTwoPointsAreTooFewForAPose) {
  for (const int points : {2, 3}) {
    MakeScene(5);
    AddObjects(1);
    AddSpreadPoints(points, 0.0);
    const Rigid3 start = Start();
    const double motion = Distance(Optimize(start, 1.5).points.cam_from_world, start);
    EXPECT_EQ(motion > 0.0, points == 3) << points;
  }
}

// The prior of the translation is a share of the distance, so in a world that is ten times as large
// the motion is ten times as large.
TEST_F(JointPose, ThePriorDoesNotDependOnTheScaleOfTheWorld) {
  MakeScene(9);
  AddObjects(2);
  const Rigid3 start = Start();
  const ObjectPoseOptions options{.prior_rotation = 0.1, .prior_translation = 0.01};
  const Rigid3 small = Optimize(start, 1.5, options).points.cam_from_world;
  for (Ellipsoid& ellipsoid : ellipsoids_) {
    ellipsoid.world_from_object.translation *= 10.0;
    ellipsoid.half_axes *= 10.0;
  }
  Rigid3 far_start = start;
  far_start.translation *= 10.0;
  const Rigid3 large = Optimize(far_start, 1.5, options).points.cam_from_world;
  const double motion = Distance(small, start);
  ASSERT_GT(motion, 1e-3);
  EXPECT_LT(Distance({large.rotation, 0.1 * large.translation}, small), 0.01 * motion);
}

// The outlines are random and fit no object. The pose must stay near its start nevertheless.
TEST_F(JointPose, StaysNearTheStartWithoutPoints) {
  for (uint32_t seed = 1; seed <= 50; ++seed) {
    MakeScene(seed);
    AddObjects(2 + static_cast<int>(seed % 3));
    for (Detection& detection : detections_) {
      Shift(detection, random_.Number(-100.0, 100.0), random_.Number(-100.0, 100.0));
      for (SilhouetteLine& line : detection.lines) {
        line.line.offset += random_.Number(-30.0, 30.0);
      }
    }
    const Rigid3 start = Start();
    const JointPoseResult result = Optimize(start, 1.5);
    ASSERT_TRUE(result.points.cam_from_world.ToMatrix().allFinite());
    EXPECT_LT((Center(result.points.cam_from_world) - Center(start)).norm(), 0.2) << seed;
  }
}

// Two objects, one behind the other, hardly constrain the rotation around the line of sight.
TEST_F(JointPose, AnUnconstrainedRotationStaysAtTheStart) {
  MakeScene(6);
  AddObjects(2);
  for (size_t i = 0; i < 2; ++i) {  // spheres: rotating them does not change their outlines
    MadeObject sphere;
    sphere.ellipsoid.world_from_object =
        Inverse(true_pose_) * Rigid3(Eigen::Quaterniond::Identity(), {0.0, 0.0, 2.0 + 1.0 * i});
    sphere.ellipsoid.half_axes.setConstant(0.2);
    ellipsoids_[i] = sphere.ellipsoid;
    detections_[i] = Detect(sphere, sensor_, true_pose_);
  }
  const Rigid3 start = Rigid3(ExpSo3({0.0, 0.0, 0.05}), {0.0, 0.01, 0.0}) * true_pose_;
  const JointPoseResult result = Optimize(start, 1.5);
  EXPECT_EQ(result.used_objects, 2);
  const Eigen::Vector3d turn =
      LogSo3(result.points.cam_from_world.rotation * true_pose_.rotation.conjugate());
  EXPECT_NEAR(turn.z(), 0.05, 0.005);
  const Eigen::Vector3d seen =
      result.points.cam_from_world * ellipsoids_[0].world_from_object.translation;
  EXPECT_LT(std::hypot(seen.x(), seen.y()), 0.005);
}

TEST_F(JointPose, ADetectionCountsAsALimitedNumberOfLines) {
  MakeScene(7);
  AddSpreadPoints(10, 1.0);
  AddObjects(2, 3.0);
  const Rigid3 start = Start();
  const Rigid3 few = Optimize(start, 3.0).points.cam_from_world;
  // If every line is given twice, there is no more information.
  for (Detection& detection : detections_) {
    const std::vector<SilhouetteLine> lines = detection.lines;
    detection.lines.insert(detection.lines.end(), lines.begin(), lines.end());
  }
  EXPECT_LT(Distance(Optimize(start, 3.0).points.cam_from_world, few), 1e-6);
  ObjectPoseOptions one_line;
  one_line.constraint.max_effective_lines = 1.0;
  EXPECT_GT(Distance(Optimize(start, 3.0, one_line).points.cam_from_world, few), 1e-5);
}

TEST_F(JointPose, DoesNotDependOnTheWorldFrame) {
  MakeScene(8);
  AddSpreadPoints(12, 1.0);
  AddObjects(3, 2.0);
  const Rigid3 start = Start();
  const Rigid3 expected = Optimize(start, 2.0).points.cam_from_world;
  const Rigid3 new_from_old = random_.Pose(2.0, 5.0);
  for (PoseObservation& observation : observations_) {
    observation.point = new_from_old * observation.point;
  }
  for (Ellipsoid& ellipsoid : ellipsoids_) {
    ellipsoid = new_from_old * ellipsoid;
  }
  const Rigid3 found =
      Optimize(start * Inverse(new_from_old), 2.0).points.cam_from_world * new_from_old;
  EXPECT_LT(Distance(found, expected), 1e-8);
}

TEST_F(JointPose, SameInputGivesTheSameBits) {
  MakeScene(9);
  AddSpreadPoints(12, 1.0);
  AddObjects(3, 2.0);
  const Rigid3 start = Start();
  const Rigid3 first = Optimize(start, 2.0).points.cam_from_world;
  const Rigid3 second = Optimize(start, 2.0).points.cam_from_world;
  EXPECT_EQ(first.rotation.coeffs(), second.rotation.coeffs());
  EXPECT_EQ(first.translation, second.translation);
}

using Matrix6d = Eigen::Matrix<double, 6, 6>;

const PinholeCamera kMadeCamera = SyntheticSensor().camera;  // f 500, centre 320, 240

Matrix6d Information(double rotation_sigma, double translation_sigma) {
  Eigen::Matrix<double, 6, 1> sigmas;
  sigmas << Eigen::Vector3d::Constant(rotation_sigma), Eigen::Vector3d::Constant(translation_sigma);
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// The image is 640 x 480, so all corners are at the slope n = (0.64, 0.48), |n| = 0.8. A
// translation (a, b, c) at the depth z moves a corner by f / z ((a, b) - c n). So the covariance is
// (s f / z)^2 (I + n n^T), whose largest eigenvalue is (s f / z)^2 (1 + |n|^2).
TEST(CornerSigma, OfATranslationIsAsComputedByHand) {
  const double expected = 0.01 * 500.0 / 2.0 * std::sqrt(1.0 + 0.64);
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(1e-9, 0.01), 2.0), expected, 1e-6);
}

// A rotation about an axis across n moves the corner along n by f (1 + |n|^2) per radian.
TEST(CornerSigma, OfARotationDoesNotDependOnTheDepth) {
  const double expected = 0.01 * 500.0 * 1.64;
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(0.01, 1e-9), 2.0), expected, 1e-6);
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(0.01, 1e-9), 20.0), expected, 1e-6);
}

TEST(CornerSigma, DoesNotDependOnTheUnitOfLength) {
  EXPECT_NEAR(CornerSigma(kMadeCamera, Information(0.003, 0.02), 2.0),
              CornerSigma(kMadeCamera, Information(0.003, 0.06), 6.0), 1e-9);
}

// A pose that turns about one side of the image is uncertain at the other side, whichever it is.
// The translation that belongs to the turn keeps points at the depth 2 and the slope `side` in
// place.
TEST(CornerSigma, IsThatOfTheWorstCornerOnEverySide) {
  const auto sigma_about = [](const Eigen::Vector2d& side) {
    Matrix6d covariance = 1e-8 * Matrix6d::Identity();
    Eigen::Matrix<double, 6, 1> turn;  // about the axis across the side
    turn.head<3>() << side.y(), -side.x(), 0.0;
    turn.head<3>().normalize();
    const Eigen::Vector3d fixed(2.0 * side.x(), 2.0 * side.y(), 2.0);
    turn.tail<3>() = -turn.head<3>().cross(fixed);
    covariance += 1e-4 * turn * turn.transpose();
    return CornerSigma(kMadeCamera, covariance.inverse(), 2.0);
  };
  const double left = sigma_about({-0.64, 0.0});
  EXPECT_GT(left, 5.0);
  EXPECT_NEAR(sigma_about({0.64, 0.0}), left, 1e-6);
  const double top = sigma_about({0.0, -0.48});
  EXPECT_GT(top, 3.0);
  EXPECT_NEAR(sigma_about({0.0, 0.48}), top, 1e-6);
}

// A turn about the axis of the lens moves the corner of the raw image along a circle of its radius.
TEST(CornerSigma, IsMeasuredInTheRawImageOfAFisheyeLens) {
  PinholeCamera camera = FisheyeCamera();
  camera.cx = 320.0;
  camera.cy = 240.0;
  camera.fy = camera.fx;
  Matrix6d information = Information(1e-9, 1e-9);
  information(2, 2) = 1.0 / (0.01 * 0.01);
  // The lens has 150 degrees across: the corners, beyond 80 degrees, are not seen.
  const double radius =
      (camera.Distort(camera.Undistort({0.0, 0.0})) - Eigen::Vector2d(camera.cx, camera.cy)).norm();
  EXPECT_LT(radius, 399.0);
  EXPECT_NEAR(CornerSigma(camera, information, 2.0), 0.01 * radius, 1e-3);
}

// The same lens in the model of a pinhole and in that of a fisheye.
TEST(CornerSigma, DoesNotDependOnTheModelOfTheLens) {
  PinholeCamera pinhole = PinholeAsFisheye();
  pinhole.lens = LensModel::kBrown;
  pinhole.k1 = pinhole.k2 = pinhole.k3 = pinhole.k4 = 0.0;
  const Matrix6d information = Information(0.003, 0.02);
  const double expected = CornerSigma(pinhole, information, 2.0);
  EXPECT_NEAR(CornerSigma(PinholeAsFisheye(), information, 2.0), expected, 0.01 * expected);
}

// The corners are those of the raw image, whose undistorted ones are farther out with this lens.
TEST(CornerSigma, TakesTheCornersOfTheRawImage) {
  PinholeCamera barrel = kMadeCamera;
  barrel.k1 = -0.2;
  const Eigen::Vector3d ray = barrel.Unproject(barrel.Undistort({0.0, 0.0}), 1.0);
  ASSERT_GT(ray.head<2>().norm(), 0.85);
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, 2, 3> raw_by_turn;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d turn = kStep * Eigen::Vector3d::Unit(i);
    raw_by_turn.col(i) = (barrel.Distort(barrel.Project(ExpSo3(turn) * ray)) -
                          barrel.Distort(barrel.Project(ExpSo3(-turn) * ray))) /
                         (2.0 * kStep);
  }
  const double largest = std::sqrt(
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(raw_by_turn * raw_by_turn.transpose())
          .eigenvalues()[1]);
  EXPECT_NEAR(CornerSigma(barrel, Information(0.01, 1e-9), 2.0), 0.01 * largest, 1e-4);
}

TEST(CornerSigma, IsInfiniteForAPoseThatIsNotDetermined) {
  Matrix6d information = Information(0.01, 0.01);
  information.row(4).setZero();
  information.col(4).setZero();
  EXPECT_EQ(CornerSigma(kMadeCamera, information, 2.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hullslam
