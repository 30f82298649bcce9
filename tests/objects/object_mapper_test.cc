// SPDX-License-Identifier: GPL-3.0-or-later
#include "objects/object_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "map/keyframe_graph.h"
#include "map_files/invariants.h"
#include "objects/constraint/point_statistics.h"
#include "objects/fusion.h"
#include "objects/initialisation.h"
#include "objects/made_objects.h"
#include "objects/refinement.h"

namespace hullslam {
namespace {

class Mapping : public ::testing::Test {
 protected:
  void See(const std::vector<MadeObject>& objects, double angle) { See(mapper_, objects, angle); }
  void See(ObjectMapper& mapper, const std::vector<MadeObject>& objects, double angle) {
    mapper.Process(map_, AddObserver(map_, sensor_, CameraOnCircle(angle, 1.5, 0.6), objects));
    ASSERT_EQ(FindViolations(map_), std::vector<std::string>());
  }
  std::vector<ObjectLandmark> Mapped() const {
    std::vector<ObjectLandmark> mapped;
    map_.objects().ForEach([&](ObjectId, const ObjectLandmark& object) {
      if (object.state == ObjectState::kMapped) {
        mapped.push_back(object);
      }
    });
    return mapped;
  }
  Sensor sensor_ = MakeObjectSensor();
  ObjectMapper mapper_{sensor_, ObjectOptions()};
  Map map_;
};

TEST_F(Mapping, MapsATableOnceAndExactly) {
  const auto table = MakeTable();
  for (int i = 0; i < 12; ++i) {
    See(table, 0.1 * i);
  }
  const auto mapped = Mapped();
  ASSERT_EQ(mapped.size(), table.size());
  for (const MadeObject& made : table) {
    const auto best = std::max_element(mapped.begin(), mapped.end(), [&](auto& a, auto& b) {
      return VolumeOverlap(a.ellipsoid, made.ellipsoid) <
             VolumeOverlap(b.ellipsoid, made.ellipsoid);
    });
    EXPECT_GT(VolumeOverlap(best->ellipsoid, made.ellipsoid), 0.8) << made.label;
    EXPECT_EQ(best->Label(), made.label);
    EXPECT_EQ(best->observations.size(), 12u);
  }
}

TEST_F(Mapping, AnObjectIsACandidateUntilItIsSeenFromEnoughSides) {
  const auto table = MakeTable();
  See(table, 0.0);
  See(table, 0.001);
  EXPECT_EQ(map_.objects().size(), 3u);
  EXPECT_EQ(mapper_.rejections().at(ObjectRejection::kFewKeyframes), 6u);
  See(table, 0.002);
  See(table, 0.003);
  EXPECT_TRUE(Mapped().empty());
  EXPECT_EQ(mapper_.rejections().at(ObjectRejection::kLittleParallax), 6u);
  See(table, 0.2);
  EXPECT_EQ(Mapped().size(), 3u);
}

// A camera that only turns has hardly any parallax, but its depth images show where things are.
TEST_F(Mapping, DepthTellsWhereAnObjectIsThatIsSeenFromOneSide) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.01 * i);  // 2.3 degrees in all
  }
  const auto mapped = Mapped();
  ASSERT_EQ(mapped.size(), table.size());
  for (const MadeObject& made : table) {
    EXPECT_TRUE(std::ranges::any_of(mapped, [&](const ObjectLandmark& object) {
      return VolumeOverlap(object.ellipsoid, made.ellipsoid) > 0.5;
    })) << made.label;
  }
}

// Six observations within 6 degrees, without depth.
TEST_F(Mapping, LandmarksTellWhereAnObjectIsWithoutDepth) {
  const MadeObject cup = MakeObject("cup", {0.1, 0.05, 0.0}, {0.10, 0.12, 0.11});
  for (const size_t landmarks : {0, 40}) {
    map_ = Map();
    ObjectMapper mapper(sensor_, ObjectOptions());
    TexturedObject textured(cup, CameraOnCircle(0.0, 1.5, 0.6), landmarks);
    for (int i = 0; i < 6; ++i) {
      const Rigid3 pose = CameraOnCircle(0.02 * i, 1.5, 0.6);
      mapper.Process(map_, textured.AddObserver(map_, sensor_, pose));
    }
    if (landmarks == 0) {
      EXPECT_TRUE(Mapped().empty());
      EXPECT_GT(mapper.rejections().at(ObjectRejection::kLittleParallax), 0u);
    } else {
      ASSERT_EQ(Mapped().size(), 1u);
      EXPECT_GT(VolumeOverlap(Mapped()[0].ellipsoid, cup.ellipsoid), 0.7);
    }
  }
}

TEST_F(Mapping, ACandidateThatIsNotSeenAgainIsCulled) {
  const auto table = MakeTable();
  See(table, 0.0);
  for (int i = 0; i < 25; ++i) {
    See({table[0]}, 0.02 * i);
  }
  EXPECT_EQ(map_.objects().size(), 1u);
  EXPECT_EQ(mapper_.rejections().at(ObjectRejection::kSeldomSeen), 2u);
}

TEST_F(Mapping, AMappedObjectThatIsNeverFoundAgainIsCulled) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.1 * i);
  }
  ASSERT_EQ(Mapped().size(), 3u);
  for (int i = 0; i < 30; ++i) {
    See({table[0]}, 0.02 * i);
  }
  EXPECT_EQ(Mapped().size(), 1u);
}

// It may be hidden for a whole session, or have fewer masks there.
TEST_F(Mapping, AnObjectOfAnEarlierSessionIsKeptUntilItsEnd) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.1 * i);
  }
  mapper_.Keep({ObjectId(1)});
  for (int i = 0; i < 30; ++i) {
    See({table[0]}, 0.02 * i);
  }
  EXPECT_TRUE(map_.objects().Contains(ObjectId(1)));
  EXPECT_FALSE(map_.objects().Contains(ObjectId(2)));
}

// A new object of another class, whose shape is not valid, has taken the observations of the cup.
TEST_F(Mapping, ADoubledObjectIsFusedIntoTheMappedOne) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.1 * i);
  }
  ASSERT_EQ(Mapped().size(), 3u);
  const size_t observations = map_.objects().At(ObjectId(0)).observations.size();
  const ObjectId copy = map_.AddObject();
  MadeObject vase = table[0];
  vase.label = "vase";
  for (int i = 5; i < 9; ++i) {
    map_.AddObservation(copy, AddObserver(map_, sensor_, CameraOnCircle(0.1 * i, 1.5, 0.8), {vase}),
                        0);
  }
  mapper_.RefineMerged(map_, std::vector{copy});
  EXPECT_FALSE(map_.objects().Contains(copy));
  EXPECT_EQ(map_.Resolve(copy), ObjectId(0));
  EXPECT_EQ(map_.objects().At(ObjectId(0)).observations.size(), observations + 4);
}

TEST_F(Mapping, AnObjectThatIsNoLongerValidIsACandidateAgain) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.1 * i);
  }
  ASSERT_EQ(Mapped().size(), 3u);
  map_.MutableObject(ObjectId(1)).ellipsoid.half_axes *= 4.0;
  const std::vector<ObjectId> all = {ObjectId(0), ObjectId(1), ObjectId(2), ObjectId(7)};
  mapper_.Recheck(map_, all);
  EXPECT_EQ(Mapped().size(), 2u);
  EXPECT_EQ(map_.objects().At(ObjectId(1)).state, ObjectState::kCandidate);
  See(table, 0.5);  // and is found anew
  EXPECT_EQ(Mapped().size(), 3u);
}

// Keyframes are culled after the objects of the window were checked.
TEST_F(Mapping, AnObjectWhoseKeyframesWereAllCulledIsNoLongerMapped) {
  const auto table = MakeTable();
  for (int i = 0; i < 4; ++i) {
    See({table[0]}, 0.1 * i);
  }
  ASSERT_EQ(Mapped().size(), 1u);
  See({}, 0.4);
  for (uint32_t i = 1; i < 5; ++i) {
    SetParent(map_, KeyframeId(i), KeyframeId(i - 1));
  }
  for (uint32_t i = 1; i < 4; ++i) {
    map_.CullKeyframe(KeyframeId(i));
  }
  map_.RemoveObservation(ObjectId(0), KeyframeId(0));
  EXPECT_TRUE(Mapped().empty());
  // Other objects of its class can be mapped beside it.
  MadeObject other = table[0];
  other.ellipsoid.world_from_object.translation.x() += 0.05;
  for (int i = 5; i < 9; ++i) {
    See({other}, 0.1 * i);
  }
  EXPECT_EQ(Mapped().size(), 1u);
}

TEST_F(Mapping, TwoRunsGiveTheSameBits) {
  const auto table = MakeTable();
  for (int i = 0; i < 8; ++i) {
    See(table, 0.1 * i);
  }
  Map map;
  ObjectMapper mapper(sensor_, ObjectOptions());
  for (int i = 0; i < 8; ++i) {
    mapper.Process(map, AddObserver(map, sensor_, CameraOnCircle(0.1 * i, 1.5, 0.6), table));
  }
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    EXPECT_EQ(object.ellipsoid.half_axes, map_.objects().At(id).ellipsoid.half_axes);
  });
}

// Tests the number of keyframes after which a candidate is removed, and one less.
TEST_F(Mapping, ACandidateIsRemovedWhenItHasNotBeenSeenForLong) {
  ObjectOptions options;
  options.culling.candidate_keyframes = 4;
  ObjectMapper mapper(sensor_, options);
  See(mapper, {MakeTable()[0]}, 0.0);
  for (int i = 1; i <= 4; ++i) {
    See(mapper, {}, 0.01 * i);
  }
  EXPECT_EQ(map_.objects().size(), 1u);
  See(mapper, {}, 0.05);
  EXPECT_TRUE(map_.objects().empty());
}

// Found in 2 of 14 keyframes that should show it, but 20 are needed for a judgement.
TEST_F(Mapping, AnObjectIsJudgedOnlyAfterEnoughKeyframesThatShouldShowIt) {
  ObjectOptions options;
  options.culling.min_visible = 20;
  ObjectMapper mapper(sensor_, options);
  for (int i = 0; i < 5; ++i) {
    See(mapper, {MakeTable()[0]}, 0.1 * i);
  }
  ASSERT_EQ(Mapped().size(), 1u);
  for (int i = 0; i < 12; ++i) {
    See(mapper, {}, 0.02 * i);
  }
  EXPECT_EQ(Mapped().size(), 1u);
  for (int i = 0; i < 12; ++i) {
    See(mapper, {}, 0.02 * i);
  }
  EXPECT_TRUE(Mapped().empty());
}

// The shape is computed again when the number of observations has grown by an eighth; from 10
// observations on, that is with every second observation.
TEST_F(Mapping, TheShapeIsComputedAgainAsTheViewsGrow) {
  const auto table = MakeTable();
  for (int i = 0; i < 12; ++i) {
    See({table[0]}, 0.05 * i);
  }
  ASSERT_EQ(Mapped().size(), 1u);
  EXPECT_EQ(Mapped()[0].observations.size(), 12u);
  EXPECT_GE(Mapped()[0].shaped_views, 11u);
}

// A shape of 16 observations is computed again with the 19th observation, but a rejected one with
// the next observation.
TEST_F(Mapping, ARejectedShapeIsComputedAgainWithTheNextView) {
  const auto table = MakeTable();
  for (int i = 0; i < 16; ++i) {
    See({table[0]}, 0.05 * i);
  }
  ASSERT_EQ(Mapped().size(), 1u);
  ASSERT_EQ(Mapped()[0].shaped_views, 16u);
  map_.MutableObject(ObjectId(0)).ellipsoid.half_axes *= 4.0;
  const std::vector<ObjectId> all = {ObjectId(0)};
  mapper_.Recheck(map_, all);
  ASSERT_TRUE(Mapped().empty());
  See({table[0]}, 0.8);
  EXPECT_EQ(Mapped().size(), 1u);
}

// Each start is refined; the one with the smallest cost is kept.
TEST_F(Mapping, TheBestOfSeveralStartsIsKept) {
  size_t best_is_first = 0;
  size_t best_is_last = 0;
  const ObjectOptions options;
  for (int trial = 0; trial < 12; ++trial) {
    const MadeObject made = MakeObject("thing", {0.02 * trial, 0.0, 0.0},
                                       {0.05 + 0.01 * trial, 0.08, 0.06}, 0.3 * trial);
    map_ = Map();
    for (int i = 0; i < 3; ++i) {
      See({made}, 0.1 * i);
    }
    ASSERT_EQ(Mapped().size(), 1u);
    const auto observations = ResolveObservations(map_, map_.objects().At(ObjectId(0)));
    const double distance = MeanDistance(observations, MeanOf(CollectPoints(observations, 20)));
    const auto starts = StartsFromPoints(
        CollectPoints(observations, static_cast<size_t>(options.start.max_points)), distance, {});
    std::vector<double> costs;
    for (const Ellipsoid& start : starts) {
      costs.push_back(RefineEllipsoid(start, start, sensor_, observations,
                                      options.refinement.max_misfit_px, options.refinement)
                          .cost);
    }
    const auto best =
        static_cast<size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    EXPECT_EQ(Mapped()[0].start.half_axes, starts[best].half_axes) << trial;
    best_is_first += best == 0 ? 1 : 0;
    best_is_last += best + 1 == starts.size() ? 1 : 0;
  }
  EXPECT_GT(best_is_first, 0u);
  EXPECT_GT(best_is_last, 0u);
}

void ExpectSameShape(const ObjectLandmark& a, const ObjectLandmark& b) {
  EXPECT_EQ(a.ellipsoid.half_axes, b.ellipsoid.half_axes);
  EXPECT_EQ(a.ellipsoid.world_from_object.translation, b.ellipsoid.world_from_object.translation);
  EXPECT_EQ(a.misfit_px, b.misfit_px);
  EXPECT_EQ(b.state, ObjectState::kMapped);
}

// Its shape is that of the user, which contradicts what is seen.
TEST_F(Mapping, ALockedObjectIsNeitherRefinedNorRejectedNorCulled) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.1 * i);
  }
  ASSERT_EQ(Mapped().size(), 3u);
  map_.MutableObject(ObjectId(1)).is_locked = true;
  map_.MutableObject(ObjectId(1)).ellipsoid.half_axes *= 4.0;
  const ObjectLandmark before = map_.objects().At(ObjectId(1));
  mapper_.Recheck(map_, std::vector{ObjectId(1)});
  ExpectSameShape(before, map_.objects().At(ObjectId(1)));
  for (int i = 5; i < 9; ++i) {
    See(table, 0.1 * i);
  }
  ExpectSameShape(before, map_.objects().At(ObjectId(1)));
  EXPECT_EQ(map_.objects().At(ObjectId(1)).observations.size(), 9u) << "it is seen as before";
  for (int i = 0; i < 60; ++i) {
    See({table[0]}, 0.02 * i);
  }
  ASSERT_TRUE(map_.objects().Contains(ObjectId(1)));
  ExpectSameShape(before, map_.objects().At(ObjectId(1)));
  EXPECT_EQ(Mapped().size(), 2u) << "the bottle is gone";
}

TEST_F(Mapping, ACopyWithMoreViewsDoesNotChangeALockedObject) {
  const auto table = MakeTable();
  for (int i = 0; i < 5; ++i) {
    See(table, 0.1 * i);
  }
  map_.MutableObject(ObjectId(0)).is_locked = true;
  const ObjectLandmark before = map_.objects().At(ObjectId(0));
  const ObjectId copy = map_.AddObject();
  MadeObject vase = table[0];
  vase.label = "vase";
  for (int i = 5; i < 13; ++i) {
    map_.AddObservation(copy, AddObserver(map_, sensor_, CameraOnCircle(0.1 * i, 1.5, 0.8), {vase}),
                        0);
  }
  mapper_.RefineMerged(map_, std::vector{copy});
  EXPECT_EQ(map_.Resolve(copy), ObjectId(0));
  ExpectSameShape(before, map_.objects().At(ObjectId(0)));
  EXPECT_EQ(map_.objects().At(ObjectId(0)).observations.size(), 13u);
}

}  // namespace
}  // namespace hullslam
