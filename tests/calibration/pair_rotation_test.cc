// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/pair_rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace hullslam {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kBaseline = 0.12;  // m

PinholeCamera Camera() {
  return {.fx = 520.0, .fy = 518.0, .cx = 322.0, .cy = 238.0, .bf = kBaseline * 520.0};
}

struct MadePairOptions {
  double noise = 0.5;         // px, of each coordinate
  double wrong = 0.1;         // the share of matches that are wrong
  double border = 10.0;       // px about the image that show nothing
  double frames_late = 0.0;   // of the right images
  double moved_down = 4.0;    // px from image to image, at most
  bool is_near_only = false;  // all things are at one distance
};

// The pixels in which a pair with this deviation sees a point.
PairMatch MatchOf(const Eigen::Vector3d& point, const PairDeviation& deviation) {
  const PinholeCamera camera = Camera();
  const Eigen::Vector3d centre = kBaseline * Eigen::Vector3d(1.0, deviation.down, deviation.ahead);
  return {camera.Project(point), camera.Project(ExpSo3(deviation.turn) * (point - centre)) +
                                     Eigen::Vector2d(0.0, deviation.row_offset)};
}

std::vector<MatchedPair> MadePairs(const PairDeviation& deviation, uint32_t seed,
                                   const MadePairOptions& options = {}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, options.noise);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<MatchedPair> pairs(60);
  for (size_t t = 0; t < pairs.size(); ++t) {
    pairs[t].moved_down = options.moved_down * std::sin(0.7 * static_cast<double>(t));
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector2d pixel(uniform(options.border, 640.0 - options.border),
                                  uniform(options.border, 480.0 - options.border));
      const double depth = options.is_near_only ? 3.0 : 1.0 / uniform(0.03, 1.0);
      PairMatch match = MatchOf(Camera().Unproject(pixel, depth), deviation);
      match.left += Eigen::Vector2d(noise(random), noise(random));
      match.right += Eigen::Vector2d(noise(random), noise(random));
      match.right.y() += options.frames_late * *pairs[t].moved_down;
      if (uniform(0.0, 1.0) < options.wrong) {
        match.right.y() += uniform(-60.0, 60.0);
      }
      pairs[t].matches.push_back(match);
    }
  }
  return pairs;
}

double Sigmas(const PairRows& rows, PairNumber number, double truth) {
  return std::abs(rows.Of(number).value - truth) / rows.Of(number).sigma;
}

TEST(PairDeviation, TheRowErrorIsThatOfTheHand) {
  const PinholeCamera camera = Camera();
  const PairMatch match{{camera.cx + 104.0, camera.cy + 51.8},
                        {camera.cx + 52.0, camera.cy + 54.8}};
  EXPECT_NEAR(PairDeviation{}.RowError(camera, match), 3.0, 1e-12);
  EXPECT_NEAR(PairDeviation{.row_offset = 2.0}.RowError(camera, match), 1.0, 1e-9);
  // The disparity is 0.1 focal lengths.
  EXPECT_NEAR(PairDeviation{.down = 0.01}.RowError(camera, match), 3.0 + 0.518, 1e-9);
  EXPECT_NEAR(PairDeviation{.ahead = 0.01}.RowError(camera, match), 3.0 - 0.0518, 1e-9);
  // About x, which points to the right, things move up; undone, they are lower.
  const PairDeviation pitch{.turn = {0.01, 0.0, 0.0}};
  EXPECT_GT(pitch.RowError(camera, match), 3.0);
}

TEST(PairDeviation, ThePairThatHasItHasNoErrorOfRows) {
  const PairDeviation deviation{.turn = {0.02, -0.01, 0.03}, .row_offset = 5.0, .down = 0.003};
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.3, -0.2, 1.5), Eigen::Vector3d(-2.0, 1.5, 6.0)}) {
    EXPECT_NEAR(deviation.RowError(Camera(), MatchOf(point, deviation)), 0.0, 1e-9);
  }
}

// Images that were rectified with a wrong calibration: the deviation makes it the right one.
TEST(PairDeviation, ACalibrationOfCamerasAsReadIsCorrected) {
  StereoCalibration given;
  given.left = {.fx = 460.0, .fy = 458.0, .cx = 318.0, .cy = 243.0, .k1 = -0.28, .k2 = 0.07};
  given.right = {.fx = 455.0, .fy = 456.0, .cx = 325.0, .cy = 238.0, .k1 = -0.27, .k2 = 0.06};
  given.right_from_left = {ExpSo3({0.006, 0.016, 0.01}), {-0.12, 0.002, 0.003}};
  const StereoRectifier rectifier(given, "test");
  const PinholeCamera& camera = rectifier.camera();
  const PairDeviation deviation{.turn = {0.01, -0.004, 0.006}, .down = 0.005, .ahead = -0.004};
  const StereoCalibration truth = deviation.AppliedTo(given, rectifier, camera);
  EXPECT_NEAR(truth.right_from_left.translation.norm(), 0.12, 1e-4);
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.1, -0.2, 1.5), Eigen::Vector3d(-0.4, 0.3, 2.0)}) {
    const auto see = [&](const PinholeCamera& of, const Eigen::Vector3d& in_camera,
                         ImageSide side) {
      return rectifier.Rectify(of.Distort(of.Project(in_camera)), side);
    };
    const PairMatch match{see(truth.left, point, ImageSide::kLeft),
                          see(truth.right, truth.right_from_left * point, ImageSide::kRight)};
    EXPECT_GT(std::abs(PairDeviation{}.RowError(camera, match)), 2.0);
    EXPECT_NEAR(deviation.RowError(camera, match), 0.0, 1e-3);
  }
}

TEST(FitPairRows, ARightPairStays) {
  int near = 0;
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const PairRows rows = FitPairRows(MadePairs({}, seed), Camera());
    EXPECT_FALSE(rows.is_changed) << seed;
    EXPECT_FALSE(rows.is_late) << seed;
    for (const PairEvidence& one : rows.evidence) {
      near += std::abs(one.value) <= 2.0 * one.sigma ? 1 : 0;
    }
  }
  EXPECT_GE(near, 0.95 * 20 * kPairNumbers);
}

TEST(FitPairRows, ADeviationIsFoundWithinItsSigmas) {
  const std::vector<PairDeviation> deviations = {
      {.turn = {0.5 * kDegree, 0.0, 0.0}},
      {.turn = {0.0, 0.0, -0.3 * kDegree}},
      {.row_offset = 4.0},
      {.turn = {-0.5 * kDegree, 0.2 * kDegree, 0.3 * kDegree}, .row_offset = 3.0},
      {.turn = {0.3 * kDegree, 0.0, 0.0}, .down = 0.02, .ahead = -0.02}};
  int within = 0;
  int all = 0;
  for (uint32_t seed = 0; seed < 20; ++seed) {
    PairDeviation truth = deviations[seed % deviations.size()];
    const PairRows rows = FitPairRows(MadePairs(truth, seed), Camera(), truth.turn.y());
    EXPECT_TRUE(rows.is_changed) << seed;
    for (const auto& [number, value] :
         {std::pair(PairNumber::kPitch, truth.turn.x()),
          std::pair(PairNumber::kRoll, truth.turn.z()),
          std::pair(PairNumber::kRowOffset, truth.row_offset),
          std::pair(PairNumber::kDown, truth.down), std::pair(PairNumber::kAhead, truth.ahead)}) {
      EXPECT_TRUE(rows.Of(number).is_determined) << seed;
      EXPECT_LT(Sigmas(rows, number, value), 4.0) << seed << " " << static_cast<int>(number);
      within += Sigmas(rows, number, value) <= 2.0 ? 1 : 0;
      ++all;
    }
    EXPECT_LT(rows.Of(PairNumber::kRoll).sigma, 0.02 * kDegree);
    EXPECT_LT(rows.median, 0.6 * rows.median_before) << seed;
  }
  EXPECT_GE(within, 0.9 * all);
}

TEST(FitPairRows, LargeDeviationsAreFound) {
  for (const PairDeviation& truth :
       {PairDeviation{.turn = {3.0 * kDegree, 0.0, 0.0}},
        PairDeviation{.turn = {0.0, 0.0, -3.0 * kDegree}}, PairDeviation{.row_offset = 20.0}}) {
    const PairRows rows = FitPairRows(MadePairs(truth, 3, {.wrong = 0.3}), Camera());
    EXPECT_TRUE(rows.is_changed);
    EXPECT_LT(Sigmas(rows, PairNumber::kPitch, truth.turn.x()), 3.0);
    EXPECT_LT(Sigmas(rows, PairNumber::kRoll, truth.turn.z()), 3.0);
    EXPECT_LT(Sigmas(rows, PairNumber::kRowOffset, truth.row_offset), 3.0);
  }
}

// Without corners at the top and bottom, an offset and a pitch are the same.
TEST(FitPairRows, WhatIsNotDeterminedIsHeld) {
  const PairRows rows = FitPairRows(
      MadePairs({.turn = {0.5 * kDegree, 0.0, 0.0}}, 1, {.border = 190.0, .is_near_only = true}),
      Camera());
  EXPECT_TRUE(rows.is_changed);
  EXPECT_FALSE(rows.Of(PairNumber::kRowOffset).is_determined);
  EXPECT_EQ(rows.found.row_offset, 0.0);
  EXPECT_FALSE(rows.Of(PairNumber::kDown).is_determined);
  EXPECT_LT(Sigmas(rows, PairNumber::kPitch, 0.5 * kDegree), 3.0);
}

TEST(FitPairRows, FewMatchesSayNothing) {
  std::vector<MatchedPair> pairs = MadePairs({.row_offset = 5.0}, 1);
  pairs.resize(1);
  EXPECT_FALSE(FitPairRows(pairs, Camera()).is_changed);
  EXPECT_FALSE(FitPairRows({}, Camera()).is_changed);
}

TEST(FitPairRows, ImagesThatAreAFrameApartAreNoticed) {
  for (const double late : {1.0, -1.0, 0.5}) {
    for (const double pitch : {0.0, 0.5 * kDegree}) {
      const PairRows rows =
          FitPairRows(MadePairs({.turn = {pitch, 0.0, 0.0}}, 2, {.frames_late = late}), Camera());
      EXPECT_TRUE(rows.is_late);
      EXPECT_FALSE(rows.is_changed);
      EXPECT_NEAR(rows.frames_late, late, std::max(0.1, 2.0 * rows.frames_late_sigma));
    }
  }
  // A camera that stands still says nothing.
  EXPECT_FALSE(
      FitPairRows(MadePairs({}, 2, {.frames_late = 1.0, .moved_down = 0.0}), Camera()).is_late);
}

TEST(YawOf, IsTheTurnThatMakesDisparitiesLarger) {
  const double offset = 2.0;
  const PairDeviation turned{.turn = {0.0, YawOf(offset, Camera()), 0.0}};
  double sum = 0.0;
  int count = 0;
  for (double x = 0.0; x < 640.0; x += 10.0) {
    const Eigen::Vector3d point = Camera().Unproject({x, 238.0}, 4.0);
    sum += MatchOf(point, {}).right.x() - MatchOf(point, turned).right.x();
    ++count;
  }
  EXPECT_NEAR(sum / count, offset, 0.03 * offset);
}

}  // namespace
}  // namespace hullslam
