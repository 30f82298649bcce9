// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop/scale_information.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "map/made_map.h"

namespace hullslam {
namespace {

// Cameras side by side, 0.2 m apart, that look at landmarks 2 m in front of the first one.
class ScaleInformationTest : public testing::Test {
 protected:
  void Make(uint32_t cameras) {
    for (uint32_t i = 0; i < cameras; ++i) {
      keyframes_.push_back(
          AddKeyframe(map_, 50, 0, Rigid3(Eigen::Quaterniond::Identity(), {-kStep * i, 0.0, 0.0})));
    }
  }
  void ShareAt(std::initializer_list<uint32_t> cameras, int landmarks = 1) {
    std::vector<KeyframeId> observers;
    for (const uint32_t camera : cameras) {
      observers.push_back(keyframes_[camera]);
    }
    Share(map_, observers, landmarks);
  }
  double Between(size_t older, size_t newer) const {
    return ScaleInformation(map_, keyframes_).Between(older, newer);
  }

  // The sum of the squared deviations of the rays of these cameras.
  static double Spread(std::initializer_list<uint32_t> cameras) {
    double sin = 0.0;
    double cos = 0.0;
    for (const uint32_t camera : cameras) {
      const double angle = std::atan2(kStep * camera, 2.0);
      sin += std::sin(angle);
      cos += std::cos(angle);
    }
    const auto count = static_cast<double>(cameras.size());
    return count - (sin * sin + cos * cos) / count;
  }
  static double Information(double older, double newer) {
    return 1.0 / (1.0 / older + 1.0 / newer);
  }

  static constexpr double kStep = 0.2;  // m
  Map map_;
  std::vector<KeyframeId> keyframes_;
};

TEST_F(ScaleInformationTest, FollowsFromTheDepthsOnBothSidesOfTheKeyframesBetween) {
  Make(4);
  ShareAt({0, 1, 2, 3}, 5);
  const double at_1 = 5.0 * Information(Spread({0, 1}), Spread({1, 2, 3}));
  const double at_2 = 5.0 * Information(Spread({0, 1, 2}), Spread({2, 3}));
  EXPECT_NEAR(Between(1, 2), 1.0 / (0.5 / at_1 + 0.5 / at_2), 1e-9);
  EXPECT_NEAR(Between(0, 2), 1.0 / (1.0 / at_1 + 0.5 / at_2), 1e-9);
  EXPECT_NEAR(Between(0, 3), 1.0 / (1.0 / at_1 + 1.0 / at_2), 1e-9)
      << "the first and the last keyframe have neighbours on one side only";
}

TEST_F(ScaleInformationTest, IsNoneWhereNoLandmarkIsSeenByThreeKeyframes) {
  Make(6);
  ShareAt({0, 1, 2}, 10);
  ShareAt({2, 3}, 10);
  ShareAt({3, 4, 5}, 10);
  EXPECT_GT(Between(0, 1), 1e-3);
  EXPECT_GT(Between(4, 5), 1e-3);
  EXPECT_LT(Between(2, 3), 1e-5);
  EXPECT_LT(Between(0, 5), 1e-5);
}

TEST_F(ScaleInformationTest, IsThatOfCommonLandmarksIfThePathBetweenGivesLess) {
  Make(8);
  for (const uint32_t i : {0U, 1U, 2U, 3U, 4U, 5U}) {
    ShareAt({i, i + 1}, 3);
  }
  ShareAt({0, 1, 6, 7}, 4);
  EXPECT_NEAR(Between(1, 6), 4.0 * Information(Spread({0, 1}), Spread({6, 7})), 1e-9);
  EXPECT_LT(Between(2, 5), 1e-5);
}

}  // namespace
}  // namespace hullslam
