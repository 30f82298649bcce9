// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/comparison/association_measure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hullslam {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

// A detection of 40 x 40 px about the pixel (100, 100), and an object of the same class.
class AssociationMeasureTest : public ::testing::Test {
 protected:
  AssociationMeasureTest() {
    detection_.label = "cup";
    detection_.box = {Eigen::Vector2d(80.0, 80.0), Eigen::Vector2d(120.0, 120.0)};
    object_.votes["cup"] = 3;
  }
  MatchEvidence Evidence(size_t shared_landmarks = 0) const {
    return {.detection = detection_,
            .object = object_,
            .projected = projected_,
            .carried = carried_,
            .shared_landmarks = shared_landmarks};
  }
  // A circle of 20 px radius that is moved to the right.
  void ProjectAt(double offset) {
    projected_ =
        Ellipse{.center = {100.0 + offset, 100.0}, .shape = 400.0 * Eigen::Matrix2d::Identity()};
  }
  // The last hull is a square of 40 px that is moved to the right.
  void CarryTo(double offset) {
    carried_ = {Polygon{{80.0 + offset, 80.0},
                        {120.0 + offset, 80.0},
                        {120.0 + offset, 120.0},
                        {80.0 + offset, 120.0}}};
  }

  Detection detection_;
  ObjectLandmark object_;
  std::optional<Ellipse> projected_;
  std::vector<Polygon> carried_;
};

TEST_F(AssociationMeasureTest, NamesAreInTheOrderOfTheEnumerators) {
  const std::vector<std::string> names = {"combined", "class_overlap", "wasserstein"};
  EXPECT_EQ(AssociationMeasureNames(), names);
  EXPECT_EQ(FunctionOf(AssociationMeasure::kCombined), nullptr);
  EXPECT_EQ(FunctionOf(AssociationMeasure::kClassOverlap), &ClassOverlap);
  EXPECT_EQ(FunctionOf(AssociationMeasure::kWasserstein), &WassersteinSimilarity);
}

TEST_F(AssociationMeasureTest, ClassOverlapIsTheIouOfTheBoxes) {
  ProjectAt(0.0);
  EXPECT_NEAR(ClassOverlap(Evidence()), 1.0, 1e-9);
  ProjectAt(20.0);  // 20 of 60 px are common
  EXPECT_NEAR(ClassOverlap(Evidence()), 1.0 / 3.0, 1e-9);
  ProjectAt(24.0);  // less than 0.3
  EXPECT_EQ(ClassOverlap(Evidence()), 0.0);
  CarryTo(24.0);  // for the last hull 0.2 are enough
  EXPECT_NEAR(ClassOverlap(Evidence()), 16.0 / 64.0, 1e-9);
}

TEST_F(AssociationMeasureTest, ClassOverlapNeedsTheSameClass) {
  ProjectAt(0.0);
  object_.votes = {{"cup", 2}, {"bowl", 3}};
  EXPECT_EQ(ClassOverlap(Evidence(100)), 0.0);
}

TEST_F(AssociationMeasureTest, ManyCommonLandmarksAreCertain) {
  ProjectAt(0.0);
  const double best_overlap = ClassOverlap(Evidence(10));
  EXPECT_GT(ClassOverlap(Evidence(11)), best_overlap);
  projected_.reset();
  EXPECT_GT(ClassOverlap(Evidence(11)), best_overlap);
}

TEST_F(AssociationMeasureTest, WassersteinFallsWithTheDistanceOfTheEllipses) {
  ProjectAt(0.0);
  EXPECT_NEAR(WassersteinSimilarity(Evidence()), 1.0, 1e-3);
  ProjectAt(20.0);
  EXPECT_NEAR(WassersteinSimilarity(Evidence()), std::exp(-2.0), 1e-6);
  detection_.label = "bowl";  // the class does not count
  EXPECT_NEAR(WassersteinSimilarity(Evidence()), std::exp(-2.0), 1e-6);
  detection_.ellipse = Ellipse{.center = {100.0, 100.0},  // twice as large
                               .shape = 1600.0 * Eigen::Matrix2d::Identity()};
  EXPECT_NEAR(WassersteinSimilarity(Evidence()), std::exp(-std::sqrt(400.0 + 800.0) / 10.0), 1e-6);
}

TEST_F(AssociationMeasureTest, WassersteinNeedsBoxesThatMeet) {
  ProjectAt(41.0);
  EXPECT_EQ(WassersteinSimilarity(Evidence()), 0.0);
}

TEST_F(AssociationMeasureTest, WithoutAQuadricWassersteinComparesTheLastHull) {
  EXPECT_EQ(WassersteinSimilarity(Evidence()), 0.0);
  CarryTo(20.0);
  EXPECT_NEAR(WassersteinSimilarity(Evidence()), 1.0 / 3.0, 1e-9);
  CarryTo(24.0);
  EXPECT_EQ(WassersteinSimilarity(Evidence()), 0.0);
}

}  // namespace
}  // namespace hullslam
