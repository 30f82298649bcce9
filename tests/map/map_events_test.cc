// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/map/map_events.h"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "map/correction.h"
#include "map/made_correction.h"
#include "map/made_map.h"

namespace hullslam {
namespace {

class MapEvents : public testing::Test {
 protected:
  MapEvents() {
    for (int i = 0; i < 3; ++i) {
      AddKeyframe(map_, 4, 4);
    }
  }

  ObjectId AddMapped(double x) {
    const ObjectId id = map_.AddObject();
    ObjectLandmark& object = map_.MutableObject(id);
    object.state = ObjectState::kMapped;
    object.reference = KeyframeId(0);
    object.ellipsoid.half_axes.setConstant(0.1);
    object.ellipsoid.world_from_object.translation.x() = x;
    return id;
  }

  // The events since the last call.
  std::vector<MapEvent> Take() {
    Map now = map_.Snapshot();
    std::vector<MapEvent> events = EventsBetween(before_, now);
    before_ = std::move(now);
    return events;
  }

  MapEvent TakeOne() {
    const std::vector<MapEvent> events = Take();
    EXPECT_EQ(events.size(), 1);
    return events.empty() ? MapEvent() : events.front();
  }

  void Correct(const Sim3& new_from_old, std::optional<MapCorrection::LoopEdge> loop = {}) {
    MapCorrection correction = MakeCorrection(map_, new_from_old);
    correction.loop = loop;
    ASSERT_TRUE(ApplyCorrection(map_, correction, ScaleLevels()).is_applied);
  }

  Map map_;
  Map before_;
};

TEST_F(MapEvents, ANewMapHasNone) {
  EXPECT_TRUE(Take().empty());
  EXPECT_TRUE(Take().empty());
}

TEST_F(MapEvents, ALoopSaysHowFarKeyframesHaveMoved) {
  Take();
  Correct(Sim3(1.0, Eigen::Quaterniond::Identity(), {0.0, 0.3, 0.4}),
          MapCorrection::LoopEdge{KeyframeId(0), KeyframeId(2)});
  const MapEvent event = TakeOne();
  EXPECT_EQ(event.kind, MapEventKind::kLoopClosed);
  EXPECT_NEAR(event.mean_moved, 0.5, 1e-12);
  EXPECT_NEAR(event.most_moved, 0.5, 1e-12);
  EXPECT_NEAR(event.scale, 1.0, 1e-12);
}

TEST_F(MapEvents, ACorrectionWithoutALoopIsAnAdjustmentOrAnotherScale) {
  Take();
  Correct(Sim3(1.0, Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.0}));
  EXPECT_EQ(TakeOne().kind, MapEventKind::kAdjusted);
  Correct(Sim3(2.0, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()));
  const MapEvent event = TakeOne();
  EXPECT_EQ(event.kind, MapEventKind::kRescaled);
  EXPECT_NEAR(event.scale, 2.0, 1e-12);
}

TEST_F(MapEvents, AnIslandIsBegunAndJoined) {
  Take();
  const KeyframeId first = map_.AddKeyframe(MakeFrame(90, 4, 4), Rigid3(), map_.BeginIsland());
  EXPECT_EQ(TakeOne().kind, MapEventKind::kIslandBegun);
  Correct(Sim3(), MapCorrection::LoopEdge{KeyframeId(0), first});
  EXPECT_EQ(TakeOne().kind, MapEventKind::kIslandJoined);
}

TEST_F(MapEvents, AnObjectIsBornMovesIsFusedAndIsGone) {
  const ObjectId cup = AddMapped(0.0);
  const ObjectId double_of_cup = AddMapped(0.5);
  map_.AddObject();  // a candidate is nothing yet
  const std::vector<MapEvent> born = Take();
  ASSERT_EQ(born.size(), 2);
  EXPECT_EQ(born[0].kind, MapEventKind::kObjectBorn);
  EXPECT_EQ(born[0].object, cup);
  EXPECT_EQ(born[1].object, double_of_cup);

  map_.MutableObject(cup).ellipsoid.world_from_object.translation.x() = 0.05;
  EXPECT_TRUE(Take().empty()) << "it was measured better, and has not moved";
  map_.MutableObject(cup).ellipsoid.world_from_object.translation.x() = 0.25;
  const MapEvent moved = TakeOne();
  EXPECT_EQ(moved.kind, MapEventKind::kObjectMoved);
  EXPECT_NEAR(moved.most_moved, 0.2, 1e-12);

  map_.ReplaceObject(double_of_cup, cup);
  const MapEvent fused = TakeOne();
  EXPECT_EQ(fused.kind, MapEventKind::kObjectFused);
  EXPECT_EQ(fused.object, double_of_cup);
  EXPECT_EQ(fused.kept, cup);

  map_.EraseObject(cup);
  const MapEvent gone = TakeOne();
  EXPECT_EQ(gone.kind, MapEventKind::kObjectGone);
  EXPECT_EQ(gone.object, cup);
}

TEST_F(MapEvents, ACorrectionIsNoMotionOfObjects) {
  AddMapped(0.0);
  Take();
  Correct(Sim3(1.0, Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0}));
  EXPECT_EQ(TakeOne().kind, MapEventKind::kAdjusted);
}

TEST(MapEventKind, EachHasAName) {
  std::set<std::string_view> names;
  for (int kind = 0; kind <= static_cast<int>(MapEventKind::kObjectGone); ++kind) {
    names.insert(ToString(static_cast<MapEventKind>(kind)));
  }
  EXPECT_EQ(names.size(), static_cast<size_t>(MapEventKind::kObjectGone) + 1);
  EXPECT_EQ(ToString(MapEventKind::kLoopClosed), "loop_closed");
}

}  // namespace
}  // namespace hullslam
