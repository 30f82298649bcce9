// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimators/two_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "support/test_cameras.h"

namespace hullslam {
namespace {

PinholeCamera Camera() {
  PinholeCamera camera;
  camera.fx = camera.fy = 520.0;
  camera.cx = 320.0;
  camera.cy = 240.0;
  return camera;
}

struct World {
  double noise = 0.7;     // px
  double outliers = 0.2;  // share of the pairs
  int pairs = 300;
};

// The pairs of pixels that a camera at the origin and one at `b_from_a` see. `depth` gives the
// depth of the point at a pixel of a.
std::vector<PixelPair> See(const Rigid3& b_from_a, uint64_t seed, const World& world,
                           const std::function<double(const Eigen::Vector3d&, double)>& depth) {
  const PinholeCamera camera = Camera();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, world.noise);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<PixelPair> pairs;
  while (pairs.size() < static_cast<size_t>(world.pairs)) {
    const double u = 640.0 * share(random);
    const double v = 480.0 * share(random);
    const Eigen::Vector3d ray = camera.Unproject({u, v}, 1.0);
    const Eigen::Vector3d in_b = b_from_a * (depth(ray, share(random)) * ray);
    const Eigen::Vector2d pixel = camera.Project(in_b);
    if (in_b.z() <= 0.0 || pixel.x() < 0.0 || pixel.x() > 640.0 || pixel.y() < 0.0 ||
        pixel.y() > 480.0) {
      continue;
    }
    const bool is_wrong = share(random) < world.outliers;
    const double wrong_u = 640.0 * share(random);
    const double wrong_v = 480.0 * share(random);
    const double du = noise(random);
    const double dv = noise(random);
    pairs.push_back({{u, v},
                     is_wrong ? Eigen::Vector2d(wrong_u, wrong_v)
                              : Eigen::Vector2d(pixel.x() + du, pixel.y() + dv)});
  }
  return pairs;
}

double GeneralDepth(const Eigen::Vector3d&, double share) { return 1.0 + 3.0 * share; }

// A plane through (0, 0, 2) with this normal.
std::function<double(const Eigen::Vector3d&, double)> Plane(const Eigen::Vector3d& normal) {
  return
      [normal](const Eigen::Vector3d& ray, double) { return 2.0 * normal.z() / normal.dot(ray); };
}

Rigid3 Motion(const Eigen::Vector3d& turn, const Eigen::Vector3d& step) {
  return {ExpSo3(turn), step};
}

double DirectionError(const TwoViews& found, const Rigid3& truth) {
  return std::acos(std::clamp(found.b_from_a.translation.dot(truth.translation.normalized()), -1.0,
                              1.0)) *
         180.0 / std::numbers::pi;
}

TEST(TwoViews, FindTheMotionInAGeneralScene) {
  const std::vector<Rigid3> motions = {
      Motion({0, 0, 0}, {0.2, 0, 0}), Motion({0.05, -0.1, 0.02}, {-0.15, 0.1, 0.05}),
      Motion({0, 0.1, 0}, {-0.3, 0.0, 0.0}), Motion({0, 0, 0}, {0.0, 0.05, -0.4})};
  for (size_t i = 0; i < motions.size(); ++i) {
    for (uint64_t seed = 0; seed < 5; ++seed) {
      const std::vector<PixelPair> pairs = See(motions[i], seed, {}, GeneralDepth);
      const TwoViews found = EstimateTwoViews(Camera(), pairs, {.seed = seed});
      ASSERT_TRUE(found.ok()) << i << ": " << ToString(found.failure);
      EXPECT_LT(AngularDistance(found.b_from_a.rotation, motions[i].rotation), 0.01) << i;
      EXPECT_LT(DirectionError(found, motions[i]), 5.0) << i;
      EXPECT_NEAR(found.b_from_a.translation.norm(), 1.0, 1e-9);
      EXPECT_GT(found.points.size(), 150U);
    }
  }
}

TEST(TwoViews, PointsAreInTheFirstCameraAndInOrder) {
  const Rigid3 motion = Motion({0.02, 0.05, 0.0}, {-0.25, 0.02, 0.0});
  const std::vector<PixelPair> pairs =
      See(motion, 3, {.noise = 0.0, .outliers = 0.0}, GeneralDepth);
  const TwoViews found = EstimateTwoViews(Camera(), pairs, {});
  ASSERT_TRUE(found.ok());
  EXPECT_TRUE(std::is_sorted(found.points.begin(), found.points.end(),
                             [](const auto& a, const auto& b) { return a.pair < b.pair; }));
  for (const TwoViews::Point& point : found.points) {
    EXPECT_LT((Camera().Project(point.point_in_a) - pairs[point.pair].a).norm(), 0.1);
    EXPECT_LT((Camera().Project(found.b_from_a * point.point_in_a) - pairs[point.pair].b).norm(),
              0.1);
  }
}

// A tilted plane is explained by a homography. The motion is found, or it is called ambiguous.
TEST(TwoViews, OnAPlaneTheMotionIsRightOrAmbiguous) {
  int found_count = 0;
  const Rigid3 motion = Motion({0.0, 0.12, 0.03}, {-0.35, 0.1, 0.1});
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<PixelPair> pairs = See(motion, seed, {.noise = 0.5}, Plane({0.3, -0.4, 1.0}));
    const TwoViews found = EstimateTwoViews(Camera(), pairs, {.seed = seed});
    if (found.ok()) {
      ++found_count;
      EXPECT_LT(AngularDistance(found.b_from_a.rotation, motion.rotation), 0.03) << seed;
      EXPECT_LT(DirectionError(found, motion), 10.0) << seed;
    } else {
      EXPECT_EQ(found.failure, TwoViewFailure::kAmbiguous) << seed;
    }
  }
  RecordProperty("found", found_count);
}

// A wall seen head on is the worst plane: two motions explain it about equally well.
TEST(TwoViews, InFrontOfAWallTheMotionIsRightOrThereIsNone) {
  const std::vector<Rigid3> motions = {
      Motion({0, 0, 0}, {0.25, 0, 0}), Motion({0, 0, 0}, {0, 0, 0.4}),
      Motion({0, 0.08, 0}, {-0.3, 0.05, 0.1}), Motion({0.1, 0, 0.05}, {0.05, 0.3, -0.1})};
  int wrong = 0;
  int found_count = 0;
  for (uint64_t seed = 0; seed < 25; ++seed) {
    for (const Rigid3& motion : motions) {
      const TwoViews found =
          EstimateTwoViews(Camera(), See(motion, seed, {}, Plane({0.0, 0.0, 1.0})), {.seed = seed});
      found_count += found.ok() ? 1 : 0;
      wrong += found.ok() && (AngularDistance(found.b_from_a.rotation, motion.rotation) > 0.05 ||
                              DirectionError(found, motion) > 15.0)
                   ? 1
                   : 0;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << found_count << " found";
}

// The keypoints are more precise than their sigma. In front of a wall that is nearly plane, even
// wrong motions then agree with all pairs, and only the size of the errors shows which motion is
// right.
TEST(TwoViews, InFrontOfAnUnevenWallTheMotionIsRightOrThereIsNone) {
  const std::vector<Rigid3> motions = {
      Motion({0, 0, 0}, {0.06, 0, 0}), Motion({0.01, 0.02, 0.01}, {-0.05, 0.02, -0.02}),
      Motion({-0.02, 0, 0.02}, {0.02, 0.05, -0.03}), Motion({0, 0.03, 0}, {-0.07, 0.0, 0.03})};
  const auto depth = [](const Eigen::Vector3d& ray, double share) {
    return (1.9 + 0.2 * share) / (1.0 + 0.4 * ray.x());
  };
  int wrong = 0;
  int found_count = 0;
  for (uint64_t seed = 0; seed < 25; ++seed) {
    for (const Rigid3& motion : motions) {
      const TwoViews found = EstimateTwoViews(
          Camera(), See(motion, seed, {.noise = 0.35, .outliers = 0.02}, depth), {.seed = seed});
      found_count += found.ok() ? 1 : 0;
      wrong += found.ok() && (AngularDistance(found.b_from_a.rotation, motion.rotation) > 0.02 ||
                              DirectionError(found, motion) > 20.0)
                   ? 1
                   : 0;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << found_count << " found";
  EXPECT_GT(found_count, 5);
}

// The homography of a plane with normal n and a motion along t is also that of another plane and
// motion, with n and t exchanged (Longuet-Higgins 1986). If the camera approaches the plane, both
// explain every pair with points in front of both cameras.
TEST(TwoViews, APlaneThatIsApproachedIsAmbiguous) {
  const std::vector<Rigid3> motions = {Motion({0, 0, 0}, {-0.3, 0.0, -0.4}),
                                       Motion({0.02, 0.05, 0.01}, {0.2, 0.1, -0.4})};
  for (const Rigid3& motion : motions) {
    for (uint64_t seed = 0; seed < 5; ++seed) {
      const std::vector<PixelPair> pairs =
          See(motion, seed, {.noise = 0.3, .outliers = 0.1}, Plane({0.0, 0.0, 1.0}));
      EXPECT_EQ(EstimateTwoViews(Camera(), pairs, {.seed = seed}).failure,
                TwoViewFailure::kAmbiguous)
          << seed;
    }
  }
}

TEST(TwoViews, ARotationHasNoParallax) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const double turn = 0.02 + 0.004 * static_cast<double>(seed);
    const Rigid3 motion = Motion({0.3 * turn, turn, 0.2 * turn}, {0, 0, 0});
    const TwoViews found =
        EstimateTwoViews(Camera(), See(motion, seed, {}, GeneralDepth), {.seed = seed});
    EXPECT_FALSE(found.ok()) << seed;
  }
}

// In a band across the middle of the image, a turn moves the pixels almost like a step to the side.
// So a step to the side and points with much parallax explain the pairs too.
TEST(TwoViews, ATurnIsNoStepToTheSide) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const double turn = 0.05 + 0.01 * static_cast<double>(seed % 20);
    const Rigid3 motion = Motion({0.0, turn, 0.0}, {0, 0, 0});
    std::vector<PixelPair> pairs = See(motion, seed, {.pairs = 6000}, GeneralDepth);
    std::erase_if(pairs, [](const PixelPair& pair) { return std::abs(pair.a.y() - 240.0) > 10.0; });
    const TwoViews found = EstimateTwoViews(Camera(), pairs, {.seed = seed});
    EXPECT_EQ(found.failure, TwoViewFailure::kTooLittleParallax) << seed;
  }
}

TEST(TwoViews, ACameraThatStandsStillHasNoParallax) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViews found =
        EstimateTwoViews(Camera(), See(Rigid3(), seed, {}, GeneralDepth), {.seed = seed});
    EXPECT_EQ(found.failure, TwoViewFailure::kTooLittleParallax);
  }
}

// No rotation explains this small step, but the depths that follow from it would be inaccurate.
TEST(TwoViews, ASmallStepHasTooLittleParallax) {
  const Rigid3 motion = Motion({0.0, 0.02, 0.0}, {-0.04, 0.0, 0.0});
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const std::vector<PixelPair> pairs =
        See(motion, seed, {.noise = 0.3, .outliers = 0.1}, GeneralDepth);
    const TwoViews refused = EstimateTwoViews(Camera(), pairs, {.seed = seed});
    EXPECT_EQ(refused.failure, TwoViewFailure::kTooLittleParallax) << seed;
    const TwoViews found = EstimateTwoViews(Camera(), pairs, {.seed = seed, .min_parallax = 0.6});
    EXPECT_NE(found.failure, TwoViewFailure::kTooLittleParallax) << seed;
    EXPECT_NEAR(found.parallax, 0.9, 0.2) << seed;
  }
}

// A street between houses, as a car sees it (m).
double StreetDepth(const Eigen::Vector3d& ray, double share) {
  const double to_house = (6.0 + 4.0 * share) / std::max(std::abs(ray.x()), 1e-3);
  const double to_ground = 1.65 / std::max(ray.y(), 1e-3);
  return std::min({to_house, to_ground, 80.0});
}

// Straight ahead there is no parallax, and what has much leaves the image. So half of the points of
// a car may have little parallax however far it drives.
TEST(TwoViews, AheadOfACarAFewPointsWithParallaxAreEnough) {
  const Rigid3 motion = Motion({0.002, 0.005, 0.0}, {0.0, 0.0, -1.2});
  for (uint64_t seed = 0; seed < 10; ++seed) {
    std::vector<PixelPair> pairs =
        See(motion, seed, {.noise = 0.3, .outliers = 0.1, .pairs = 900}, StreetDepth);
    std::erase_if(pairs, [i = 0](const PixelPair& pair) mutable {
      return (pair.a - Eigen::Vector2d(320.0, 240.0)).norm() > 160.0 && ++i % 3 != 0;
    });
    const TwoViews found = EstimateTwoViews(Camera(), pairs, {.seed = seed});
    ASSERT_TRUE(found.ok()) << seed << ": " << ToString(found.failure);
    EXPECT_TRUE(found.is_forward);
    EXPECT_LT(AngularDistance(found.b_from_a.rotation, motion.rotation), 0.005) << seed;
    EXPECT_LT(DirectionError(found, motion), 5.0) << seed;
    EXPECT_EQ(EstimateTwoViews(Camera(), pairs, {.seed = seed, .forward_factor = 1.0}).failure,
              TwoViewFailure::kTooLittleParallax)
        << seed;
  }
}

// The images of the two directions are the same, so backward counts as forward.
TEST(TwoViews, AreForwardIfTheImageShowsTheDirectionOfTheMotion) {
  const auto is_forward = [](const Eigen::Vector3d& step) {
    const std::vector<PixelPair> pairs =
        See(Motion({0, 0, 0}, step), 1, {.noise = 0.3, .outliers = 0.1}, GeneralDepth);
    return EstimateTwoViews(Camera(), pairs, {}).is_forward;
  };
  EXPECT_TRUE(is_forward({0.0, 0.0, -0.3}));
  EXPECT_TRUE(is_forward({0.0, 0.0, 0.3}));
  EXPECT_TRUE(is_forward({-0.13, 0.0, -0.3}));   // at 545 px
  EXPECT_FALSE(is_forward({-0.24, 0.0, -0.3}));  // at 736 px
  EXPECT_FALSE(is_forward({-0.3, 0.0, 0.0}));
}

TEST(TwoViews, WrongPairsGiveNoMotion) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViews found = EstimateTwoViews(
        Camera(), See(Rigid3(), seed, {.outliers = 1.0}, GeneralDepth), {.seed = seed});
    EXPECT_FALSE(found.ok()) << seed;
  }
}

TEST(TwoViews, NeedEnoughPairs) {
  const Rigid3 motion = Motion({0, 0, 0}, {0.2, 0, 0});
  const std::vector<PixelPair> pairs = See(motion, 1, {.pairs = 49}, GeneralDepth);
  EXPECT_EQ(EstimateTwoViews(Camera(), pairs, {}).failure, TwoViewFailure::kTooFewPairs);
  EXPECT_EQ(EstimateTwoViews(Camera(), {}, {}).failure, TwoViewFailure::kTooFewPairs);
}

TEST(TwoViews, TheSameSeedGivesTheSameBits) {
  const Rigid3 motion = Motion({0.05, -0.1, 0.02}, {-0.15, 0.1, 0.05});
  const std::vector<PixelPair> pairs = See(motion, 5, {}, GeneralDepth);
  const TwoViews one = EstimateTwoViews(Camera(), pairs, {.seed = 7});
  const TwoViews two = EstimateTwoViews(Camera(), pairs, {.seed = 7});
  EXPECT_EQ(one.b_from_a.ToMatrix(), two.b_from_a.ToMatrix());
  ASSERT_EQ(one.points.size(), two.points.size());
  for (size_t i = 0; i < one.points.size(); ++i) {
    EXPECT_EQ(one.points[i].point_in_a, two.points[i].point_in_a);
  }
}

TEST(TwoViews, NamesOfFailuresAreDifferent) {
  EXPECT_EQ(ToString(TwoViewFailure::kTooLittleParallax), "too little parallax");
  EXPECT_NE(ToString(TwoViewFailure::kAmbiguous), ToString(TwoViewFailure::kTooFewPoints));
}

// With a long focal length, rays that are nearly parallel differ by several pixels. Then such a
// pair agrees with the motion only if the rotation explains it.
TEST(TwoViews, APairWithoutParallaxMustFitTheRotation) {
  PinholeCamera camera = Camera();
  camera.fx = camera.fy = 2000.0;
  const Rigid3 motion = Motion({0.0, 0.0, 0.0}, {-0.25, 0.0, 0.0});
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto found_with = [&](double error) {
    std::vector<PixelPair> pairs;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d pixel(640.0 * share(random), 480.0 * share(random));
      const bool is_far = i % 2 == 0;
      const Eigen::Vector3d point =
          camera.Unproject(pixel, is_far ? 1e6 : 1.0 + 3.0 * share(random));
      const double angle = 2.0 * std::numbers::pi * share(random);
      const Eigen::Vector2d wrong = error * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      pairs.push_back({pixel, camera.Project(motion * point) +
                                  (is_far ? wrong : Eigen::Vector2d::Zero().eval())});
    }
    return EstimateTwoViews(camera, pairs, {.min_share = 0.7, .min_parallax = 0.0});
  };
  // The far pairs agree, so the points are too small a share of the pairs that do. The bound is
  // that of the noise of both pixels, 2.45 px * sqrt(2).
  EXPECT_EQ(found_with(3.0).failure, TwoViewFailure::kTooFewPoints);
  const TwoViews found = found_with(4.0);
  EXPECT_TRUE(found.ok()) << ToString(found.failure);
  EXPECT_LT(DirectionError(found, motion), 5.0);
}

class TwoViewsOf : public testing::TestWithParam<TestCamera> {};

HULLSLAM_WITH_ALL_CAMERAS(TwoViewsOf);

// The sigmas are those of the image as read, so a pair near the rim of a fisheye agrees as often as
// one in the middle. Noise of 0.8 sigmas is within the bound of 95 % for 99 % of the pixels.
TEST_P(TwoViewsOf, AgreeWithPairsOfTheWholeImageWithinTheirNoise) {
  const Sensor& sensor = GetParam().sensor;
  const Rigid3 motion = Motion({0.02, -0.05, 0.03}, {-0.25, 0.08, 0.05});
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.8);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto disturb = [&](const Eigen::Vector2d& pixel) {
    const double du = noise(random);
    const double dv = noise(random);
    return sensor.camera.Undistort(sensor.camera.Distort(pixel) + Eigen::Vector2d(du, dv));
  };
  std::vector<PixelPair> pairs;
  std::vector<bool> is_outer;
  while (pairs.size() < 600) {
    const double u = 20.0 + 600.0 * share(random);
    const double v = 20.0 + 440.0 * share(random);
    const Eigen::Vector3d ray = sensor.camera.Unproject(sensor.camera.Undistort({u, v}), 1.0);
    const Eigen::Vector3d in_b = motion * ((1.0 + 3.0 * share(random)) * ray.normalized());
    if (in_b.z() > 0.2 && sensor.Sees(sensor.camera.Project(in_b))) {
      pairs.push_back(
          {.a = disturb(sensor.camera.Project(ray)), .b = disturb(sensor.camera.Project(in_b))});
      is_outer.push_back(std::hypot(u - 320.0, v - 240.0) > 220.0);
    }
  }
  const TwoViews found = EstimateTwoViews(sensor.camera, pairs, {});
  ASSERT_TRUE(found.ok()) << ToString(found.failure);
  EXPECT_LT(AngularDistance(found.b_from_a.rotation, motion.rotation), 0.01);
  EXPECT_LT(DirectionError(found, motion), 3.0);
  const auto outer = static_cast<double>(std::ranges::count(is_outer, true));
  const auto agreeing = static_cast<double>(std::ranges::count_if(
      found.points, [&](const TwoViews::Point& point) { return is_outer[point.pair]; }));
  ASSERT_GT(outer, 100.0);
  EXPECT_GT(agreeing, 0.9 * outer);
}

}  // namespace
}  // namespace hullslam
