// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/fusion.h"

#include <gtest/gtest.h>

#include <vector>

#include "objects/made_objects.h"

namespace hullslam {
namespace {

Ellipsoid Ball(double x, double radius) {
  return MakeObject("ball", {x, 0.0, 0.0}, Eigen::Vector3d::Constant(radius)).ellipsoid;
}

TEST(VolumeOverlap, IsSymmetricAndAsComputedByHand) {
  EXPECT_NEAR(VolumeOverlap(Ball(0.0, 0.1), Ball(0.0, 0.1)), 1.0, 1e-12);
  EXPECT_NEAR(VolumeOverlap(Ball(0.0, 0.1), Ball(0.0, 0.2)), 0.125, 1e-12);  // inside
  EXPECT_EQ(VolumeOverlap(Ball(0.0, 0.1), Ball(0.3, 0.1)), 0.0);
  // Two unit balls one apart share 5/16 of each: 5 / (32 - 5).
  EXPECT_NEAR(VolumeOverlap(Ball(0.0, 1.0), Ball(1.0, 1.0)), 5.0 / 27.0, 0.01);
  EXPECT_NEAR(VolumeOverlap(Ball(0.0, 0.1), Ball(0.05, 0.12)),
              VolumeOverlap(Ball(0.05, 0.12), Ball(0.0, 0.1)), 1e-12);
}

class Duplicates : public ::testing::Test {
 protected:
  // An object that these keyframes see, as their detection `slot`.
  ObjectId Add(const MadeObject& made, const std::vector<int>& keyframes, uint32_t slot) {
    const ObjectId id = map_.AddObject();
    for (const int keyframe : keyframes) {
      EXPECT_TRUE(map_.AddObservation(id, KeyframeId(static_cast<uint32_t>(keyframe)), slot));
    }
    map_.MutableObject(id).has_shape = true;
    map_.MutableObject(id).ellipsoid = made.ellipsoid;
    return id;
  }
  void Look(const std::vector<MadeObject>& objects, int count) {
    for (int i = 0; i < count; ++i) {
      AddObserver(map_, sensor_, CameraOnCircle(0.1 * i, 1.5, 0.5), objects);
    }
  }
  Sensor sensor_ = MakeObjectSensor();
  Map map_;
  MadeObject cup_ = MakeObject("cup", Eigen::Vector3d::Zero(), {0.05, 0.05, 0.08});
  MadeObject near_ = MakeObject("cup", {0.01, 0.01, 0.0}, {0.06, 0.05, 0.07});
  MadeObject far_ = MakeObject("cup", {0.2, 0.0, 0.0}, {0.05, 0.05, 0.08});
};

TEST_F(Duplicates, AtOnePlaceAndNeverSeenTogetherAreFusedAndTheOneWithMoreViewsStays) {
  Look({cup_, near_}, 7);
  const ObjectId a = Add(cup_, {0, 1, 2}, 0);
  const ObjectId b = Add(near_, {3, 4, 5, 6}, 1);
  const auto pairs = FindDuplicates(map_);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, b);
  EXPECT_EQ(pairs[0].second, a);
}

TEST_F(Duplicates, AreOfOneIsland) {
  Look({cup_, near_}, 7);
  Add(cup_, {0, 1, 2}, 0);
  Add(near_, {3, 4, 5, 6}, 1);
  EXPECT_EQ(FindDuplicates(map_).size(), 1u);
  const IslandId island = map_.BeginIsland();
  for (uint32_t i = 3; i < 7; ++i) {
    map_.MoveToIsland(KeyframeId(i), island);
  }
  EXPECT_TRUE(FindDuplicates(map_).empty());
}

TEST_F(Duplicates, AreSoughtForChangedObjectsOnly) {
  Look({cup_, near_, far_}, 9);
  const ObjectId a = Add(cup_, {0, 1, 2}, 0);
  const ObjectId b = Add(near_, {3, 4, 5, 6}, 1);
  const ObjectId c = Add(far_, {7, 8}, 2);
  const auto all = FindDuplicates(map_);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(FindDuplicates(map_, std::vector{a}), all);
  EXPECT_EQ(FindDuplicates(map_, std::vector{b}), all);
  EXPECT_EQ(FindDuplicates(map_, std::vector{a, b, c}), all);
  EXPECT_TRUE(FindDuplicates(map_, std::vector{c}).empty());
  EXPECT_TRUE(FindDuplicates(map_, std::vector<ObjectId>()).empty());
}

TEST_F(Duplicates, NeedTheLeastOverlap) {
  Look({cup_, near_}, 6);
  Add(cup_, {0, 1, 2}, 0);
  Add(near_, {3, 4, 5}, 1);
  const double overlap = VolumeOverlap(cup_.ellipsoid, near_.ellipsoid);
  // The t-test of the centroids must not decide instead.
  EXPECT_EQ(FindDuplicates(map_, {.min_overlap = overlap - 0.01, .alpha = 1.0}).size(), 1u);
  EXPECT_TRUE(FindDuplicates(map_, {.min_overlap = overlap + 0.01, .alpha = 1.0}).empty());
}

TEST_F(Duplicates, SeenTogetherInFewKeyframesMayBeOne) {
  Look({cup_, cup_}, 9);
  Add(cup_, {0, 1, 2, 3, 4}, 0);
  Add(cup_, {4, 5, 6, 7, 8}, 1);
  EXPECT_EQ(FindDuplicates(map_, {.max_shared_keyframes = 0.2}).size(), 1u);
  EXPECT_TRUE(FindDuplicates(map_, {.max_shared_keyframes = 0.19}).empty());
}

TEST_F(Duplicates, SeenTogetherNeedALargerOverlap) {
  Look({cup_, near_}, 9);
  Add(cup_, {0, 1, 2, 3, 4}, 0);
  Add(near_, {4, 5, 6, 7, 8}, 1);
  const double overlap = VolumeOverlap(cup_.ellipsoid, near_.ellipsoid);
  FusionOptions options{.min_overlap = 0.0, .max_shared_keyframes = 0.2};
  options.min_overlap_together = overlap - 0.01;
  EXPECT_EQ(FindDuplicates(map_, options).size(), 1u);
  options.min_overlap_together = overlap + 0.01;
  EXPECT_TRUE(FindDuplicates(map_, options).empty());
}

TEST_F(Duplicates, AreNotThoseSeenTogether) {
  Look({cup_, near_}, 4);
  Add(cup_, {0, 1, 2, 3}, 0);
  Add(near_, {0, 1, 2, 3}, 1);
  EXPECT_TRUE(FindDuplicates(map_).empty());
}

TEST_F(Duplicates, AreNotThoseBesideOneAnother) {
  Look({cup_, far_}, 6);
  Add(cup_, {0, 1, 2}, 0);
  Add(far_, {3, 4, 5}, 1);
  EXPECT_TRUE(FindDuplicates(map_).empty());
}

TEST_F(Duplicates, AnObjectIsInOnePairAtMost) {
  Look({cup_, near_, cup_}, 9);
  Add(cup_, {0, 1, 2}, 0);
  Add(near_, {3, 4, 5}, 1);
  Add(cup_, {6, 7, 8}, 2);
  EXPECT_EQ(FindDuplicates(map_).size(), 1u);
}

// Later changes are reported of the objects of earlier sessions.
TEST_F(Duplicates, TheOneOfAnEarlierSessionStays) {
  Look({cup_, near_}, 3);
  const ObjectId earlier = Add(cup_, {0, 1}, 0);
  map_.BeginSession({"second", map_.NextFrame()});
  Look({cup_, near_}, 4);
  const ObjectId later = Add(near_, {3, 4, 5, 6}, 1);
  EXPECT_EQ(KeptFirst(map_, later, earlier), std::pair(earlier, later));
  const auto pairs = FindDuplicates(map_);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0], std::pair(earlier, later));
}

TEST_F(Duplicates, ALockedObjectStaysAndTwoOfThemAreNone) {
  Look({cup_, near_}, 7);
  const ObjectId locked = Add(cup_, {0, 1, 2}, 0);
  const ObjectId other = Add(near_, {3, 4, 5, 6}, 1);
  map_.MutableObject(locked).state = map_.MutableObject(other).state = ObjectState::kMapped;
  map_.MutableObject(locked).is_locked = true;
  const auto pairs = FindDuplicates(map_);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0], std::pair(locked, other));
  map_.MutableObject(other).is_locked = true;
  EXPECT_TRUE(FindDuplicates(map_).empty());
}

// The candidate has another class than the mapped cup, and a shape that is far too thin.
class Doubled : public Duplicates {
 protected:
  Doubled() {
    copy_.label = "vase";
    copy_.ellipsoid.half_axes = {0.002, 0.05, 0.08};
    Look({cup_, cup_, far_}, 8);
    original_ = Add(cup_, {0, 1, 2, 3}, 0);
    map_.MutableObject(original_).state = ObjectState::kMapped;
  }
  MadeObject copy_ = cup_;
  ObjectId original_;
};

TEST_F(Doubled, MasksTellWhatAWrongShapeHides) {
  const ObjectId copy = Add(copy_, {4, 5, 6, 7}, 1);
  EXPECT_TRUE(FindDuplicates(map_, {.alpha = 1.0}).empty());
  EXPECT_EQ(FindDoubled(map_, sensor_, copy), original_);
  map_.MutableObject(original_).state = ObjectState::kCandidate;
  EXPECT_FALSE(FindDoubled(map_, sensor_, copy));
}

TEST_F(Doubled, ThoseSeenTogetherAreTwo) {
  EXPECT_FALSE(FindDoubled(map_, sensor_, Add(copy_, {2, 3, 4, 5}, 1)));
}

TEST_F(Doubled, MasksBesideItAreOfAnotherThing) {
  EXPECT_FALSE(FindDoubled(map_, sensor_, Add(copy_, {4, 5, 6, 7}, 2)));
}

TEST_F(Doubled, MasksInFrontOfItAreOfAnotherThing) {
  map_.MutableObject(original_).ellipsoid.half_axes *= 0.5;
  EXPECT_FALSE(FindDoubled(map_, sensor_, Add(copy_, {4, 5, 6, 7}, 1)));
}

// A book under another one: first its left end is seen, then its right end.
class Parts : public Duplicates {
 protected:
  Parts() { Look({left_, right_}, 8); }
  ObjectId AddMapped(const MadeObject& made, const std::vector<int>& keyframes, uint32_t slot) {
    const ObjectId id = Add(made, keyframes, slot);
    map_.MutableObject(id).state = ObjectState::kMapped;
    return id;
  }
  MadeObject left_ = MakeObject("book", {-0.06, 0.0, 0.0}, {0.02, 0.10, 0.02});
  MadeObject right_ = MakeObject("book", {0.06, 0.0, 0.0}, {0.02, 0.10, 0.02});
};

TEST_F(Parts, OfAClassInOneViewButNeverSeenTogetherAreOfOneObject) {
  const ObjectId left = AddMapped(left_, {0, 1, 2, 3, 4}, 0);
  const ObjectId right = Add(right_, {5, 6, 7}, 1);
  EXPECT_TRUE(FindDuplicates(map_).empty());
  EXPECT_EQ(FindWhole(map_, sensor_, right), left);
  EXPECT_FALSE(FindWhole(map_, sensor_, left).has_value());  // the other one is not mapped
}

TEST_F(Parts, AreNotThoseSeenTogether) {
  AddMapped(left_, {0, 1, 2, 3, 4, 5}, 0);
  EXPECT_FALSE(FindWhole(map_, sensor_, Add(right_, {5, 6, 7}, 1)).has_value());
}

TEST_F(Parts, AreNotThingsOfTwoClasses) {
  const ObjectId left = AddMapped(left_, {0, 1, 2, 3, 4}, 0);
  map_.MutableObject(left).votes = {{"keyboard", 4.0}, {"book", 1.0}};
  EXPECT_FALSE(FindWhole(map_, sensor_, Add(right_, {5, 6, 7}, 1)).has_value());
}

TEST_F(Parts, AreNotFarFromOneAnother) {
  const ObjectId left = AddMapped(left_, {0, 1, 2, 3, 4}, 0);
  map_.MutableObject(left).ellipsoid.world_from_object.translation.x() = -0.3;
  EXPECT_FALSE(FindWhole(map_, sensor_, Add(right_, {5, 6, 7}, 1)).has_value());
}

TEST_F(Parts, AreNotThoseThatNoImageCouldShowTogether) {
  sensor_.bounds.max_x = 10.0;
  AddMapped(left_, {0, 1, 2, 3, 4}, 0);
  EXPECT_FALSE(FindWhole(map_, sensor_, Add(right_, {5, 6, 7}, 1)).has_value());
}

// Half of the keyframes that show the part is not enough.
TEST_F(Parts, AreOfAWholeThatMostOfTheirImagesCouldShow) {
  const ObjectId left = AddMapped(left_, {0, 1, 2, 3, 4}, 0);
  const ObjectId right = Add(right_, {5, 6, 7}, 1);
  const auto column = [&](uint32_t keyframe) {
    return sensor_.camera
        .Project(map_.keyframes().At(KeyframeId(keyframe)).cam_from_world *
                 left_.ellipsoid.world_from_object.translation)
        .x();
  };
  ASSERT_LT(column(5), column(6));
  ASSERT_LT(column(6), column(7));
  sensor_.bounds.max_x = 0.5 * (column(5) + column(6));
  EXPECT_FALSE(FindWhole(map_, sensor_, right).has_value());
  sensor_.bounds.max_x = 0.5 * (column(6) + column(7));
  EXPECT_EQ(FindWhole(map_, sensor_, right), left);
}

// Their centroids agree within the noise. With little overlap, each centre must be in the other
// one.
TEST_F(Duplicates, OfOneCentroidMustContainEachOthersCentre) {
  const MadeObject ball = MakeObject("ball", Eigen::Vector3d::Zero(), {0.1, 0.1, 0.1});
  const MadeObject equal = MakeObject("ball", {0.09, 0.0, 0.0}, {0.1, 0.1, 0.1});
  const MadeObject smaller = MakeObject("ball", {0.09, 0.0, 0.0}, {0.05, 0.05, 0.05});
  const FusionOptions options{.min_overlap = 0.25, .centroid_noise = 1.0};
  for (const MadeObject& other : {equal, smaller}) {
    map_ = Map();
    ASSERT_LT(VolumeOverlap(ball.ellipsoid, other.ellipsoid), options.min_overlap);
    Look({ball, other}, 6);
    Add(ball, {0, 1, 2}, 0);
    Add(other, {3, 4, 5}, 1);
    EXPECT_EQ(FindDuplicates(map_, options).size(), other.ellipsoid.half_axes.x() > 0.09 ? 1u : 0u);
  }
}

}  // namespace
}  // namespace hullslam
