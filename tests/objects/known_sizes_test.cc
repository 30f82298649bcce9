// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/known_sizes.h"

#include <gtest/gtest.h>

#include <string>

#include "objects/made_objects.h"

namespace hullslam {
namespace {

// Mapped ellipsoids, each seen in twelve keyframes.
class KnownSizes : public ::testing::Test {
 protected:
  ObjectLandmark& Map(const std::string& label, double longest) {
    const MadeObject made =
        MakeObject(label, {0.0, 0.0, 0.0}, {0.3 * longest, 0.5 * longest, 0.2 * longest});
    const ObjectId id = map_.AddObject();
    for (int i = 0; i < 12; ++i) {
      map_.AddObservation(id, AddObserver(map_, sensor_, CameraOnCircle(0.2 * i, 1.5, 0.6), {made}),
                          0);
    }
    ObjectLandmark& object = map_.MutableObject(id);
    object.state = ObjectState::kMapped;
    object.has_shape = true;
    object.ellipsoid = made.ellipsoid;
    return object;
  }
  Sensor sensor_ = MakeObjectSensor();
  hullslam::Map map_;
};

TEST_F(KnownSizes, GiveTheUnitOfTheMap) {
  Map("keyboard", 0.25);
  const KnownScale scale = MeasureScale(map_, sensor_, {{"keyboard", 0.5}, {"mouse", 0.1}});
  EXPECT_EQ(scale.objects, 1u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, TheMedianOfSeveralCounts) {
  Map("keyboard", 0.25);
  Map("keyboard", 0.40);  // wrong: a part of another thing was mapped
  Map("mouse", 0.05);
  const KnownScale scale = MeasureScale(map_, sensor_, {{"keyboard", 0.5}, {"mouse", 0.1}});
  EXPECT_EQ(scale.objects, 3u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, AnObjectCountsAsOftenAsItWasObserved) {
  Map("keyboard", 0.25);
  ObjectLandmark& wrong = Map("keyboard", 0.10);
  for (uint32_t i = 12; i < 20; ++i) {
    map_.RemoveObservation(ObjectId(1), KeyframeId(i));
  }
  ASSERT_EQ(wrong.observations.size(), 4u);
  const KnownScale scale = MeasureScale(map_, sensor_, {{"keyboard", 0.5}});
  EXPECT_EQ(scale.objects, 2u);
  EXPECT_NEAR(scale.metres_per_unit, 2.0, 1e-3);
}

TEST_F(KnownSizes, OtherClassesAndCandidatesDoNotCount) {
  Map("cup", 0.25);
  Map("keyboard", 0.25).state = ObjectState::kCandidate;
  for (const auto& sizes : {std::map<std::string, double>(), {{"keyboard", 0.5}}}) {
    const KnownScale scale = MeasureScale(map_, sensor_, sizes);
    EXPECT_EQ(scale.objects, 0u);
    EXPECT_EQ(scale.metres_per_unit, 1.0);
  }
}

}  // namespace
}  // namespace hullslam
