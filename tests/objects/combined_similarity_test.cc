// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/combined_similarity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hullslam {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

// A detection without depth whose hull is a square of 40 px, and an object of its class that is
// predicted there.
class CombinedSimilarityTest : public ::testing::Test {
 protected:
  CombinedSimilarityTest() {
    detection_.label = "cup";
    detection_.hull = Square(0.0);
    object_.votes["cup"] = 3;
    seen_.detection = &detection_;
    predicted_.object = &object_;
    predicted_.ellipse = Square(0.0);
  }
  static Polygon Square(double x) {
    return {{x, 0.0}, {x + 40.0, 0.0}, {x + 40.0, 40.0}, {x, 40.0}};
  }
  double Similarity() const { return CombinedSimilarity(seen_, predicted_, options_); }

  Detection detection_;
  ObjectLandmark object_;
  SeenObject seen_;
  PredictedObject predicted_;
  AssociationOptions options_;
};

TEST_F(CombinedSimilarityTest, IsTheWeightedSumOfWhatAgrees) {
  EXPECT_NEAR(Similarity(), options_.iou_weight + options_.class_weight, 1e-12);
  object_.votes["bowl"] = 1;
  EXPECT_NEAR(Similarity(), options_.iou_weight + 0.75 * options_.class_weight, 1e-12);
  seen_.landmarks = {LandmarkId(0, 0), LandmarkId(1, 0), LandmarkId(2, 0), LandmarkId(3, 0)};
  predicted_.landmarks = seen_.landmarks;
  predicted_.landmarks.erase(predicted_.landmarks.begin());
  EXPECT_EQ(CountShared(seen_, predicted_), 3u);
  EXPECT_NEAR(Similarity(),
              options_.iou_weight + options_.landmark_weight + 0.75 * options_.class_weight, 1e-12);
}

TEST_F(CombinedSimilarityTest, NothingThatAgreesIsNoMatch) {
  predicted_.ellipse = Square(35.0);
  EXPECT_EQ(Similarity(), 0.0);
  predicted_.carried = {Square(0.0)};
  EXPECT_NEAR(Similarity(), options_.iou_weight + options_.class_weight, 1e-12);
  predicted_.carried = {Square(0.0), Square(100.0)};
  EXPECT_GT(Similarity(), 0.0);
  detection_.label = "bowl";
  EXPECT_EQ(Similarity(), 0.0) << "one of many positions must have the same class";
}

TEST_F(CombinedSimilarityTest, CloudsThatAreApartExcludeAPair) {
  seen_.cloud = {{0.0, 0.0, 1.0}, {0.1, 0.0, 1.0}};
  seen_.centroid = {0.05, 0.0, 1.0};
  predicted_.cloud = seen_.cloud;
  predicted_.size = SizeOf(predicted_.cloud);
  EXPECT_DOUBLE_EQ(predicted_.size, 0.1);
  EXPECT_FALSE(AreApart(seen_, predicted_, options_));
  EXPECT_GT(Similarity(), 0.0);
  for (Eigen::Vector3d& point : predicted_.cloud) {
    point.z() += 1.01 * options_.max_offset * predicted_.size;
  }
  EXPECT_TRUE(AreApart(seen_, predicted_, options_));
  EXPECT_EQ(Similarity(), 0.0);
  seen_.noise = 1.0;
  EXPECT_FALSE(AreApart(seen_, predicted_, options_)) << "within the noise of the depth";
}

}  // namespace
}  // namespace hullslam
