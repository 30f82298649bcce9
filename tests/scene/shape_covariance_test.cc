// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/shape_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "scene/made_scene.h"

namespace hullslam {
namespace {

// Observations of an object from a part of a circle, whose lines have noise of `noise_px`.
class NoisyViews {
 public:
  // Each line is there `copies` times.
  NoisyViews(const MadeObject& object, double arc, double noise_px, size_t copies = 1) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0.0, noise_px);
    detections_.reserve(kCount);
    for (uint32_t i = 0; i < kCount; ++i) {
      const Rigid3 camera = CameraOnCircle(arc * i / kCount, 2.0, 0.8);
      Detection& detection = detections_.emplace_back(Detect(object, sensor_, camera));
      for (SilhouetteLine& line : detection.lines) {
        line.line.offset += noise(random);
      }
      const std::vector<SilhouetteLine> lines = detection.lines;
      for (size_t k = 1; k < copies; ++k) {
        detection.lines.insert(detection.lines.end(), lines.begin(), lines.end());
      }
      observations_.push_back({KeyframeId(i), camera, &detection});
    }
  }
  std::optional<ShapeCovariance> Covariance(const MadeObject& object) const {
    return CovarianceOf(sensor_.camera, object.ellipsoid, object.ellipsoid, observations_);
  }

 private:
  static constexpr uint32_t kCount = 30;
  Sensor sensor_ = MakeObjectSensor();
  std::vector<Detection> detections_;
  std::vector<ResolvedObservation> observations_;
};

const MadeObject kCup = Standing("cup", {0.1, 0.0, 0.0}, {0.1, 0.12, 0.15});

double LargestSigma(const ShapeCovariance& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.center);
  EXPECT_GT(solver.eigenvalues()[0], 0.0);
  return std::sqrt(solver.eigenvalues()[2]);
}

TEST(ShapeCovariance, GrowsWithTheNoiseOfTheLines) {
  const auto precise = NoisyViews(kCup, 6.0, 0.2).Covariance(kCup);
  const auto noisy = NoisyViews(kCup, 6.0, 2.0).Covariance(kCup);
  ASSERT_TRUE(precise && noisy);
  EXPECT_LT(LargestSigma(*precise), 0.005);
  EXPECT_GT(LargestSigma(*noisy), 3.0 * LargestSigma(*precise));
}

TEST(ShapeCovariance, IsLargeAlongTheViewsIfTheyAreFromOneSide) {
  const auto around = NoisyViews(kCup, 6.0, 1.0).Covariance(kCup);
  const auto one_side = NoisyViews(kCup, 0.2, 1.0).Covariance(kCup);
  ASSERT_TRUE(around && one_side);
  EXPECT_GT(LargestSigma(*one_side), 2.0 * LargestSigma(*around));
}

// Turning a bottle about its upright axis changes no mask, and all of its half axes are known.
TEST(ShapeCovariance, ARoundThingIsFreeToTurnAboutItsAxis) {
  const MadeObject bottle = Standing("bottle", {0.1, 0.0, 0.0}, {0.04, 0.04, 0.12});
  const auto covariance = NoisyViews(bottle, 6.0, 0.5).Covariance(bottle);
  ASSERT_TRUE(covariance);
  EXPECT_TRUE(covariance->axes[2].is_round);
  EXPECT_FALSE(covariance->axes[0].is_round || covariance->axes[1].is_round);
  for (const FreeAxis& axis : covariance->axes) {
    EXPECT_FALSE(axis.is_undetermined);
  }
}

// One view from +x tells the width and the height, but not the depth.
TEST(ShapeCovariance, OneSideDoesNotTellTheLengthAlongTheViews) {
  const MadeObject thing = Standing("thing", {0.0, 0.0, 0.0}, {0.1, 0.15, 0.3});
  const auto one_side = NoisyViews(thing, 0.02, 0.5).Covariance(thing);
  const auto around = NoisyViews(thing, 6.0, 0.5).Covariance(thing);
  ASSERT_TRUE(one_side && around);
  EXPECT_TRUE(one_side->axes[0].is_undetermined);
  EXPECT_FALSE(one_side->axes[1].is_undetermined || one_side->axes[2].is_undetermined);
  for (const FreeAxis& axis : around->axes) {
    EXPECT_FALSE(axis.is_round || axis.is_undetermined);
  }
}

TEST(ShapeCovariance, IsSymmetric) {
  const auto covariance = NoisyViews(kCup, 6.0, 1.0).Covariance(kCup);
  ASSERT_TRUE(covariance);
  EXPECT_LT((covariance->center - covariance->center.transpose()).norm(),
            1e-9 * covariance->center.norm());
  EXPECT_GT(covariance->half_axes.diagonal().minCoeff(), 0.0);
}

TEST(ShapeCovariance, IsNotKnownWithoutLines) {
  EXPECT_FALSE(CovarianceOf(MakeObjectSensor().camera, kCup.ellipsoid, kCup.ellipsoid, {}));
}

// Neighbouring lines of a mask have the same errors, so the lines of a mask together count as a
// limited number.
TEST(ShapeCovariance, MoreLinesOfTheSameMaskTellNothingNew) {
  const auto once = NoisyViews(kCup, 6.0, 1.0, 2).Covariance(kCup);
  const auto twice = NoisyViews(kCup, 6.0, 1.0, 4).Covariance(kCup);
  ASSERT_TRUE(once && twice);
  EXPECT_LT((once->center - twice->center).norm(), 1e-6 * once->center.norm());
  EXPECT_LT((once->half_axes - twice->half_axes).norm(), 1e-6 * once->half_axes.norm());
}

}  // namespace
}  // namespace hullslam
