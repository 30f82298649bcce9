// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/epipolar_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/test_cameras.h"

namespace hullslam {
namespace {

// A camera whose pixels are not square.
PinholeCamera UnequalCamera() {
  PinholeCamera camera;
  camera.fx = 500.0;
  camera.fy = 540.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  return camera;
}

Rigid3 TrueMotion() {
  return {ExpSo3({0.02, -0.05, 0.03}), Eigen::Vector3d(-0.3, 0.1, 0.05).normalized()};
}

struct PixelNoise {
  double a = 0.0;  // px
  double b = 0.0;
  double outliers = 0.0;  // share of the pairs
};

std::vector<PixelPair> SeePairs(uint64_t seed, const PixelNoise& noise, const PixelPair& sigmas) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<PixelPair> pairs;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d a(640.0 * share(random), 480.0 * share(random));
    const Eigen::Vector3d point = UnequalCamera().Unproject(a, 4.0 + 8.0 * share(random));
    const Eigen::Vector2d b = UnequalCamera().Project(TrueMotion() * point);
    const bool is_wrong = share(random) < noise.outliers;
    const Eigen::Vector2d wrong(640.0 * share(random), 480.0 * share(random));
    const Eigen::Vector2d error_a = noise.a * Eigen::Vector2d(normal(random), normal(random));
    const Eigen::Vector2d error_b = noise.b * Eigen::Vector2d(normal(random), normal(random));
    PixelPair pair = sigmas;
    pair.a = a + error_a;
    pair.b = is_wrong ? wrong : Eigen::Vector2d(b + error_b);
    pairs.push_back(pair);
  }
  return pairs;
}

double SumOfCosts(const std::vector<PixelPair>& pairs, const Rigid3& motion, double noise) {
  double cost = 0.0;
  for (const PixelPair& pair : pairs) {
    cost += PairCost(UnequalCamera(), motion, pair, noise);
  }
  return cost;
}

TEST(SampsonError, IsZeroForExactPairs) {
  for (const PixelPair& pair : SeePairs(1, {}, {})) {
    EXPECT_LT(SampsonError(UnequalCamera(), TrueMotion(), pair), 1e-12);
  }
}

TEST(SampsonError, IsOneInTheMeanIfTheSigmasAreRight) {
  for (const PixelNoise& noise :
       {PixelNoise{0.5, 0.5}, PixelNoise{1.0, 0.2}, PixelNoise{0.1, 0.8}}) {
    double sum = 0.0;
    for (const PixelPair& pair :
         SeePairs(2, noise, {.a = {}, .b = {}, .sigma_a = noise.a, .sigma_b = noise.b})) {
      sum += SampsonError(UnequalCamera(), TrueMotion(), pair);
    }
    EXPECT_NEAR(sum / 400.0, 1.0, 0.2) << noise.a;
  }
}

TEST(SampsonError, DoesNotDependOnTheUnitOfLength) {
  const PixelPair pair = SeePairs(3, {1.0, 1.0}, {}).front();
  Rigid3 larger = TrueMotion();
  larger.translation *= 7.0;
  EXPECT_NEAR(SampsonError(UnequalCamera(), larger, pair),
              SampsonError(UnequalCamera(), TrueMotion(), pair), 1e-9);
}

// At the epipole there is no epipolar line.
TEST(SampsonError, IsZeroAtTheEpipoles) {
  const Rigid3 forward(Eigen::Quaterniond::Identity(), -Eigen::Vector3d::UnitZ());
  const PixelPair center = {.a = {320.0, 240.0}, .b = {320.0, 240.0}};
  EXPECT_EQ(SampsonError(UnequalCamera(), forward, center), 0.0);
  std::vector<PixelPair> pairs(20, center);
  const Rigid3 found = RefineMotion(UnequalCamera(), pairs, forward, 1.0);
  EXPECT_TRUE(found.ToMatrix().allFinite());
}

TEST(PairCost, GrowsLikeTheErrorAndIsBounded) {
  PixelPair pair = SeePairs(4, {}, {}).front();
  double last = 0.0;
  for (const double shift : {0.1, 1.0, 5.0, 50.0, 200.0}) {
    PixelPair moved = pair;
    moved.b.y() += shift;
    const double cost = PairCost(UnequalCamera(), TrueMotion(), moved, 0.5);
    EXPECT_GT(cost, last);
    EXPECT_LT(cost, kMaxPairCost);
    last = cost;
  }
  pair.b.y() += 0.05;
  const double error = SampsonError(UnequalCamera(), TrueMotion(), pair);
  EXPECT_NEAR(PairCost(UnequalCamera(), TrueMotion(), pair, 0.5), 4.0 * error, 0.02 * error);
}

TEST(RefineMotion, FindsTheTruthFromNearby) {
  const std::vector<PixelPair> pairs = SeePairs(5, {}, {});
  const Rigid3 start = {ExpSo3({0.01, 0.01, -0.01}) * TrueMotion().rotation,
                        TrueMotion().translation + Eigen::Vector3d(0.1, 0.1, -0.1)};
  const Rigid3 found = RefineMotion(UnequalCamera(), pairs, start, 1.0);
  EXPECT_LT(AngularDistance(found.rotation, TrueMotion().rotation), 1e-6);
  EXPECT_LT((found.translation - TrueMotion().translation).norm(), 1e-5);
}

TEST(RefineMotion, IsNotMovedByOutliers) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const std::vector<PixelPair> pairs = SeePairs(seed, {0.3, 0.3, 0.2}, {});
    const Rigid3 start = {ExpSo3({0.005, -0.005, 0.005}) * TrueMotion().rotation,
                          (TrueMotion().translation + Eigen::Vector3d(0.0, 0.1, 0.05))};
    const Rigid3 found = RefineMotion(UnequalCamera(), pairs, start, 0.5);
    EXPECT_LT(AngularDistance(found.rotation, TrueMotion().rotation), 0.003) << seed;
    EXPECT_LT(std::acos(std::min(1.0, found.translation.dot(TrueMotion().translation))), 0.06)
        << seed;
    EXPECT_NEAR(found.translation.norm(), 1.0, 1e-12);
  }
}

// The sum of squares at the result is not above that of motions nearby.
TEST(RefineMotion, EndsAtAMinimum) {
  const std::vector<PixelPair> pairs = SeePairs(6, {0.4, 0.4, 0.1}, {});
  const Rigid3 found = RefineMotion(UnequalCamera(), pairs, TrueMotion(), 0.4);
  const double least = SumOfCosts(pairs, found, 0.4);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    const auto draw = [&] {
      return Eigen::Vector3d(normal(random), normal(random), normal(random));
    };
    const Rigid3 other = {ExpSo3(1e-3 * draw()) * found.rotation,
                          (found.translation + 1e-2 * draw()).normalized()};
    EXPECT_GT(SumOfCosts(pairs, other, 0.4), least - 1e-3 * least) << i;
  }
}

// Raw pixels with an error of half a sigma, seen through a fisheye lens.
std::vector<PixelPair> SeeThroughFisheye(uint64_t seed) {
  const PinholeCamera camera = FisheyeCamera();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 0.5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<PixelPair> pairs;
  while (pairs.size() < 400) {
    const Eigen::Vector2d raw(640.0 * share(random), 480.0 * share(random));
    const Eigen::Vector3d ray = camera.Unproject(camera.Undistort(raw), 1.0).normalized();
    const Eigen::Vector3d in_b = TrueMotion() * Eigen::Vector3d((3.0 + 5.0 * share(random)) * ray);
    const Eigen::Vector2d raw_b = camera.Distort(camera.Project(in_b));
    if (camera.SeesRaw(raw) && in_b.z() > 0.2 * in_b.norm() && camera.SeesRaw(raw_b)) {
      pairs.push_back(
          {.a = camera.Undistort(raw + Eigen::Vector2d(normal(random), normal(random))),
           .b = camera.Undistort(raw_b + Eigen::Vector2d(normal(random), normal(random)))});
    }
  }
  return pairs;
}

class SampsonErrorOf : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(SampsonErrorOf);

// Sampson's error is the square of the epipolar error over its variance, to first order in the
// errors of all four coordinates. Those are errors of the pixels in which distances are measured.
TEST_P(SampsonErrorOf, APairIsItsEpipolarErrorInStandardDeviations) {
  const Sensor& sensor = GetParam().sensor;
  const auto ray = [&](const Eigen::Vector2d& pixel) {
    return sensor.camera.Unproject(sensor.camera.Undistort(pixel), 1.0);
  };
  const Rigid3 motion = TrueMotion();
  const auto epipolar = [&](const Eigen::Vector4d& pixels) {
    return ray(pixels.tail<2>())
        .dot(motion.translation.cross(motion.rotation * ray(pixels.head<2>())));
  };
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> u(60.0, 580.0);
  std::uniform_real_distribution<double> v(40.0, 440.0);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector4d pixels(u(random), v(random), u(random), v(random));
    const Eigen::Vector4d sigmas(0.4, 0.4, 1.1, 1.1);
    double variance = 0.0;
    for (int axis = 0; axis < 4; ++axis) {
      const Eigen::Vector4d step = 1e-3 * Eigen::Vector4d::Unit(axis);
      const double slope = (epipolar(pixels + step) - epipolar(pixels - step)) / 2e-3;
      variance += std::pow(sigmas[axis] * slope, 2);
    }
    const double error = SampsonError(sensor.camera, motion,
                                      {.a = sensor.camera.Undistort(pixels.head<2>()),
                                       .b = sensor.camera.Undistort(pixels.tail<2>()),
                                       .sigma_a = sigmas[0],
                                       .sigma_b = sigmas[2]});
    const double expected = std::pow(epipolar(pixels), 2) / variance;
    EXPECT_NEAR(error, expected, 1e-4 * expected) << pixels.transpose();
  }
}

// With the errors of the raw pixels, Sampson's error has one degree of freedom at every angle.
TEST(SampsonError, OfAFisheyeIsChiSquareAtAllAngles) {
  const PinholeCamera camera = FisheyeCamera();
  double inner = 0.0;
  double outer = 0.0;
  int inner_count = 0;
  int outer_count = 0;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    for (const PixelPair& pair : SeeThroughFisheye(seed)) {
      const double error = SampsonError(camera, TrueMotion(), pair) / 0.25;
      const bool is_inner = camera.Unproject(pair.a, 1.0).norm() < 1.7;
      (is_inner ? inner : outer) += error;
      ++(is_inner ? inner_count : outer_count);
    }
  }
  ASSERT_GT(outer_count, 200);
  EXPECT_NEAR(inner / inner_count, 1.0, 0.15);
  EXPECT_NEAR(outer / outer_count, 1.0, 0.15);
}

TEST(RefineMotion, FindsTheMotionThroughAFisheye) {
  const Rigid3 start{TrueMotion().rotation * ExpSo3({0.01, -0.01, 0.01}),
                     (TrueMotion().translation + Eigen::Vector3d(0.05, -0.1, 0.1)).normalized()};
  const Rigid3 found = RefineMotion(FisheyeCamera(), SeeThroughFisheye(7), start, 0.5);
  EXPECT_LT(found.rotation.angularDistance(TrueMotion().rotation), 0.002);
  EXPECT_LT((found.translation - TrueMotion().translation).norm(), 0.01);
}

}  // namespace
}  // namespace hullslam
