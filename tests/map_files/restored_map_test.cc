// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/restored_map.h"

#include <gtest/gtest.h>

#include <ctime>
#include <functional>
#include <sstream>
#include <string>
#include <utility>

#include "map/islands.h"
#include "map/keyframe_graph.h"
#include "map/made_map.h"
#include "map/random_edits.h"
#include "map_files/invariants.h"
#include "support/expect_error.h"

namespace hullslam {
namespace {

// The tables of a map without the values that can be derived.
MapTables TablesOf(const Map& map) {
  MapTables tables;
  map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
    tables.keyframes.Put(id, keyframe);
    tables.keyframes.Mutable(id).children.clear();
  });
  map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
    tables.landmarks.Put(id, landmark);
    tables.landmarks.Mutable(id).observations.clear();
    tables.landmarks.Mutable(id).observation_weight = 0;
  });
  map.objects().ForEach([&](ObjectId id, const ObjectLandmark& object) {
    tables.objects.Put(id, object);
    tables.objects.Mutable(id).observations.clear();
  });
  map.culled().ForEach(
      [&](KeyframeId id, const CulledKeyframe& culled) { tables.culled.Put(id, culled); });
  tables.sessions = map.sessions();
  return tables;
}

TEST(RestoreMap, DerivesTheMissingValues) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    Map map;
    RandomEdits edits(seed);
    for (int i = 0; i < 400; ++i) {
      edits.Edit(map);
    }
    map.ForgetReplaced(UINT32_MAX);
    ASSERT_FALSE(map.culled().empty());
    const Map restored = RestoreMap(TablesOf(map));
    // These tables have no free slots, so Dump would give other results for ids that are absent.
    EXPECT_EQ(FindViolations(restored), std::vector<std::string>());
    map.keyframes().ForEach([&](KeyframeId id, const Keyframe& keyframe) {
      EXPECT_EQ(restored.keyframes().At(id).children, keyframe.children);
    });
    map.landmarks().ForEach([&](LandmarkId id, const Landmark& landmark) {
      std::ostringstream expected;
      std::ostringstream found;
      Dump(landmark, expected);
      Dump(restored.landmarks().At(id), found);
      EXPECT_EQ(found.str(), expected.str());
    });
    EXPECT_EQ(restored.NextFrame(), map.NextFrame());
  }
}

// A chain of five keyframes that share landmarks, of which the third is culled, and an object.
Map MadeMap() {
  Map map;
  map.BeginSession({"first", FrameId(0)});
  std::vector<KeyframeId> ids;
  for (int i = 0; i < 5; ++i) {
    ids.push_back(AddKeyframe(map, 60, 20));
  }
  Share(map, ids, 20);
  for (const KeyframeId id : ids) {
    UpdateCovisibility(map, id);
  }
  const ObjectId object = map.AddObject();
  map.AddObservation(object, ids[0], 0);
  map.AddObservation(object, ids[1], 2);
  map.CullKeyframe(ids[2]);
  return map;
}

CulledKeyframe Culled(uint32_t frame, uint32_t reference) {
  CulledKeyframe culled;
  culled.frame = FrameId(frame);
  culled.pose.reference = KeyframeId(reference);
  return culled;
}

// Expects that the tables of MadeMap() are refused after a change.
void ExpectRefusal(const std::function<void(MapTables&)>& change,
                   const std::vector<std::string>& parts) {
  MapTables tables = TablesOf(MadeMap());
  change(tables);
  ExpectInputError([&] { RestoreMap(std::move(tables)); }, parts);
}

TEST(RestoreMap, AcceptsTheTablesOfAMap) {
  EXPECT_EQ(Dump(RestoreMap(TablesOf(MadeMap()))), Dump(MadeMap()));
}

TEST(RestoreMap, RefusesKeyframesThatAreMissingOrShareAFrame) {
  ExpectRefusal([](MapTables& t) { t.culled.Erase(KeyframeId(2)); }, {"keyframe 2", "missing"});
  ExpectRefusal([](MapTables& t) { t.culled.Put(KeyframeId(3), Culled(9, 0)); },
                {"keyframe 3", "twice"});
  ExpectRefusal(
      [](MapTables& t) {
        t.culled.Mutable(KeyframeId(2)).frame = t.keyframes.At(KeyframeId(0)).frame->id;
      },
      {"keyframe 2", "frame", "another keyframe"});
  ExpectRefusal([](MapTables& t) { t.culled.Mutable(KeyframeId(2)).frame = FrameId(); },
                {"keyframe 2", "frame"});
  ExpectRefusal(
      [](MapTables& t) {
        t.sessions.push_back({"b", FrameId(0)});
      },
      {"sessions", "order"});
  ExpectRefusal(
      [](MapTables& t) {
        t.sessions.push_back({"b", FrameId(13)});
      },
      {"session", "no keyframe"});
}

TEST(RestoreMap, RefusesCulledKeyframesWithoutAPose) {
  const auto refer = [](uint32_t to) {
    return [to](MapTables& t) { t.culled.Mutable(KeyframeId(2)).pose.reference = KeyframeId(to); };
  };
  ExpectRefusal(refer(2), {"keyframe 2", "itself"});
  ExpectRefusal(refer(7), {"keyframe 7", "does not exist"});
  ExpectRefusal(refer(UINT32_MAX - 1), {"does not exist"});
  ExpectRefusal(
      [](MapTables& t) {
        t.culled.Put(KeyframeId(5), Culled(30, 2));
        t.culled.Mutable(KeyframeId(2)).pose.reference = KeyframeId(5);
      },
      {"itself"});
}

TEST(RestoreMap, RefusesReferencesToMissingEntities) {
  const auto first = [](MapTables& t) -> LandmarkId { return (*t.landmarks.begin()).first; };
  ExpectRefusal([&](MapTables& t) { t.landmarks.Mutable(first(t)).reference = KeyframeId(8); },
                {"landmark", "keyframe that does not exist"});
  ExpectRefusal([&](MapTables& t) { t.landmarks.Mutable(first(t)).created_by = KeyframeId(8); },
                {"landmark", "keyframe that does not exist"});
  ExpectRefusal([](MapTables& t) { t.objects.Mutable(ObjectId(0)).reference = KeyframeId(8); },
                {"object 0", "keyframe that does not exist"});
  ExpectRefusal(
      [](MapTables& t) {
        t.objects.Mutable(ObjectId(0)).misfit_samples.emplace_back().keyframe = KeyframeId(8);
      },
      {"object 0", "keyframe that does not exist"});
  ExpectRefusal([](MapTables& t) { t.keyframes.Mutable(KeyframeId(1)).parent = KeyframeId(2); },
                {"keyframe 1", "parent that does not exist"});
  ExpectRefusal(
      [](MapTables& t) { t.keyframes.Mutable(KeyframeId(1)).landmarks[59] = LandmarkId(99); },
      {"keyframe 1", "landmark that does not exist"});
  ExpectRefusal([&](MapTables& t) { t.keyframes.Mutable(KeyframeId(1)).landmarks[59] = first(t); },
                {"keyframe 1", "twice"});
  ExpectRefusal([](MapTables& t) { t.keyframes.Mutable(KeyframeId(1)).objects[0] = ObjectId(5); },
                {"keyframe 1", "object that does not exist"});
}

TEST(RestoreMap, RefusesTablesThatViolateTheInvariants) {
  ExpectRefusal([](MapTables& t) { t.keyframes.Mutable(KeyframeId(1)).covisible[0].shared = 3; },
                {"keyframe", "edge"});
  ExpectRefusal(
      [](MapTables& t) {
        std::vector<Covisible>& edges = t.keyframes.Mutable(KeyframeId(1)).covisible;
        std::swap(edges[0], edges[1]);
      },
      {"keyframe", "edge"});
  ExpectRefusal([](MapTables& t) { t.keyframes.Mutable(KeyframeId(0)).parent = KeyframeId(4); },
                {"ancestor"});
  ExpectRefusal([](MapTables& t) { t.objects.Mutable(ObjectId(0)).votes["cup"] += 1.0; },
                {"object 0", "votes"});
}

// Two islands of which the second one was begun first but one.
Map MadeIslands() {
  Map map;
  map.BeginIsland();
  map.BeginIsland();
  for (const IslandId island : {IslandId(0), map.BeginIsland()}) {
    std::vector<KeyframeId> ids;
    for (int i = 0; i < 3; ++i) {
      ids.push_back(map.AddKeyframe(MakeFrame(map.keyframes().NextId().value, 40), {}, island));
    }
    Share(map, ids, 20);
    for (const KeyframeId id : ids) {
      UpdateCovisibility(map, id);
    }
  }
  return map;
}

TEST(RestoreMap, KeepsIslands) {
  const Map map = MadeIslands();
  Map restored = RestoreMap(TablesOf(map));
  EXPECT_EQ(Dump(restored), Dump(map));
  EXPECT_EQ(Islands(restored), (std::vector<IslandId>{IslandId(0), IslandId(2)}));
  EXPECT_EQ(restored.BeginIsland(), IslandId(3));
}

TEST(RestoreMap, TakesEachTreeForAnIslandIfThereAreNone) {
  Map map = MadeIslands();
  MakeRoot(map, KeyframeId(5));
  MapTables tables = TablesOf(map);
  for (uint32_t i = 0; i < 6; ++i) {
    tables.keyframes.Mutable(KeyframeId(i)).island = IslandId();
  }
  const Map restored = RestoreMap(std::move(tables));
  for (uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(restored.keyframes().At(KeyframeId(i)).island, IslandId(i / 3)) << i;
  }
}

TEST(RestoreMap, RefusesIslandsThatCannotBe) {
  ExpectRefusal([](MapTables& t) { t.keyframes.Mutable(KeyframeId(3)).island = IslandId(1); },
                {"keyframe", "another island"});
  const auto all_in = [](IslandId island) {
    return [island](MapTables& t) {
      for (const uint32_t i : {0U, 1U, 3U, 4U}) {
        t.keyframes.Mutable(KeyframeId(i)).island = island;
      }
    };
  };
  ExpectRefusal(all_in(IslandId(5)), {"keyframe 0", "island that cannot be"});
  ExpectRefusal(
      [&](MapTables& t) {
        all_in(IslandId())(t);
        t.keyframes.Mutable(KeyframeId(0)).parent = KeyframeId(4);  // a tree without a root
      },
      {"keyframe 0", "island that cannot be"});
  ExpectRefusal([](MapTables& t) { t.keyframes.Mutable(KeyframeId(3)).parent = KeyframeId(); },
                {"keyframe 3", "second root"});
}

TEST(RestoreMap, KeyframesThatWereRemovedWithTheirIslandHaveNoPose) {
  Map map;
  for (uint32_t i = 0; i < 2; ++i) {
    const IslandId island = map.BeginIsland();
    for (int k = 0; k < 2; ++k) {
      map.AddKeyframe(MakeFrame(map.keyframes().NextId().value, 20), Rigid3(), island);
    }
    SetParent(map, KeyframeId(2 * i + 1), KeyframeId(2 * i));
  }
  ASSERT_TRUE(KeepOnlyIsland(map, IslandId(1)));
  const Map restored = RestoreMap(TablesOf(map));
  EXPECT_EQ(restored.keyframes().size(), 2u);
  EXPECT_EQ(Islands(restored).size(), 1u);
  EXPECT_FALSE(restored.NearestAlive(KeyframeId(0)).IsValid());
  EXPECT_EQ(restored.NearestAlive(KeyframeId(3)), KeyframeId(3));

  Share(map, {KeyframeId(2), KeyframeId(3)});
  MapTables tables = TablesOf(map);
  const LandmarkId landmark = (*tables.landmarks.begin()).first;
  tables.landmarks.Mutable(landmark).reference = KeyframeId(1);
  ExpectInputError([&] { RestoreMap(std::move(tables)); },
                   {"landmark", "a keyframe without a pose"});
}

// Each of these keyframes refers to the one before it, and the landmarks to the last one. If the
// chain were followed from each of them, this would take minutes.
TEST(RestoreMap, TheTimeForALongChainIsProportionalToItsLength) {
  constexpr uint32_t kHalf = 50'000;
  MapTables tables;
  for (uint32_t i = 0; i < kHalf; ++i) {
    Keyframe keyframe;
    keyframe.frame = MakeFrame(i, 0);
    keyframe.objects.resize(keyframe.frame->detections.size());
    keyframe.parent = i > 0 ? KeyframeId(i - 1) : KeyframeId();
    tables.keyframes.Put(KeyframeId(i), std::move(keyframe));
  }
  for (uint32_t i = kHalf; i < 2 * kHalf; ++i) {
    tables.culled.Put(KeyframeId(i), Culled(i, i - 1));
    Landmark landmark;
    landmark.reference = KeyframeId(2 * kHalf - 1);
    tables.landmarks.Put(LandmarkId(i - kHalf, 0), landmark);
  }
  const std::clock_t start = std::clock();
  EXPECT_EQ(RestoreMap(std::move(tables)).landmarks().size(), kHalf);
  EXPECT_LT((std::clock() - start) / CLOCKS_PER_SEC, 5);
}

}  // namespace
}  // namespace hullslam
