// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/recycling_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace hullslam {
namespace {

using TextTable = RecyclingTable<LandmarkId, std::string, 4>;

TextTable MakeTextTable(uint32_t count) {
  TextTable table;
  for (uint32_t i = 0; i < count; ++i) {
    table.Insert(std::to_string(i));
  }
  return table;
}

std::map<LandmarkId, std::string> Content(const TextTable& table) {
  std::map<LandmarkId, std::string> content;
  for (const auto& [id, value] : table) {
    content.emplace(id, value);
  }
  return content;
}

TEST(RecyclingTable, FirstUsesEverySlotOnce) {
  const TextTable table = MakeTextTable(10);
  EXPECT_EQ(table.size(), 10u);
  EXPECT_EQ(table.slots(), 10u);
  for (uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(table.At(LandmarkId(i)), std::to_string(i));
  }
}

TEST(RecyclingTable, UsesTheSlotThatWasFreedLastAgain) {
  TextTable table = MakeTextTable(10);
  table.Erase(LandmarkId(3));
  table.Erase(LandmarkId(7));
  EXPECT_EQ(table.size(), 8u);
  EXPECT_EQ(table.Insert("a"), LandmarkId(7, 1));
  EXPECT_EQ(table.Insert("b"), LandmarkId(3, 1));
  EXPECT_EQ(table.Insert("c"), LandmarkId(10, 0));
  EXPECT_EQ(table.At(LandmarkId(7, 1)), "a");
  EXPECT_EQ(table.slots(), 11u);
}

TEST(RecyclingTable, FindsStaleIdsAbsent) {
  TextTable table = MakeTextTable(3);
  table.Erase(LandmarkId(1));
  for (int round = 0; round < 2; ++round) {
    for (const LandmarkId id : {LandmarkId(1), LandmarkId(1, 2), LandmarkId(3), LandmarkId(0, 1),
                                LandmarkId(999), LandmarkId()}) {
      EXPECT_EQ(table.Find(id), nullptr);
      EXPECT_FALSE(table.Contains(id));
      EXPECT_THROW(table.At(id), CheckError);
      EXPECT_THROW(table.Mutable(id), CheckError);
      EXPECT_THROW(table.Erase(id), CheckError);
    }
    if (round == 0) {
      EXPECT_FALSE(table.Contains(LandmarkId(1, 1))) << "no value has this id yet";
      table.Insert("again");
    }
  }
  EXPECT_EQ(table.At(LandmarkId(1, 1)), "again");
}

TEST(RecyclingTable, NeverGivesAnIdTwice) {
  RecyclingTable<LandmarkId, int, 4> table;
  std::set<LandmarkId> given;
  for (int i = 0; i < 2000; ++i) {
    const LandmarkId id = table.Insert(i);
    EXPECT_TRUE(given.insert(id).second);
    EXPECT_TRUE(id.IsValid());
    table.Erase(id);
  }
  EXPECT_LE(table.slots(), 1u) << "a slot without unused generations is not kept";
  for (const LandmarkId id : given) {
    EXPECT_FALSE(table.Contains(id));
  }
  EXPECT_EQ(given.rbegin()->slot(), 2000u / (LandmarkId::kMaxGeneration + 1));
}

TEST(RecyclingTable, VisitsInOrderOfIds) {
  TextTable table = MakeTextTable(23);
  for (const uint32_t erased : {0u, 5u, 8u, 9u, 10u, 11u, 22u}) {
    table.Erase(LandmarkId(erased));
  }
  table.Insert("in slot 22");
  table.Insert("in slot 11");
  std::vector<LandmarkId> visited;
  table.ForEach([&](LandmarkId id, const std::string& value) {
    EXPECT_EQ(&value, table.Find(id)) << "the value itself, not a copy";
    visited.push_back(id);
  });
  EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
  EXPECT_EQ(visited.size(), table.size());
  EXPECT_EQ(visited.front(), LandmarkId(1));
  EXPECT_EQ(visited.back(), LandmarkId(22, 1));
  const TextTable empty;
  EXPECT_TRUE(empty.begin() == empty.end());
}

TEST(RecyclingTable, VisitsNothingWhenAllIsErased) {
  TextTable table = MakeTextTable(9);
  for (uint32_t i = 0; i < 9; ++i) {
    table.Erase(LandmarkId(i));
  }
  EXPECT_TRUE(table.empty());
  EXPECT_TRUE(Content(table).empty());
}

TEST(RecyclingTable, StaysAsLargeAsTheMostValuesAtATime) {
  RecyclingTable<LandmarkId, std::shared_ptr<int>> table;
  std::mt19937 random(3);
  std::vector<LandmarkId> alive;
  std::vector<std::weak_ptr<int>> watched;
  for (int i = 0; i < 20000; ++i) {
    if (alive.size() == 100) {
      std::swap(alive[random() % alive.size()], alive.back());
      table.Erase(alive.back());
      alive.pop_back();
    }
    const auto value = std::make_shared<int>(i);
    watched.push_back(value);
    alive.push_back(table.Insert(value));
  }
  EXPECT_EQ(table.slots(), 100u);
  EXPECT_EQ(std::ranges::count_if(watched, [](const auto& value) { return !value.expired(); }), 100)
      << "an erased value is freed at once";
}

TEST(RecyclingTable, SnapshotAndTableDoNotSeeEachOthersWrites) {
  TextTable table = MakeTextTable(300);
  table.Erase(LandmarkId(4));
  const auto before = Content(table);
  TextTable snapshot = table.Snapshot();
  table.Mutable(LandmarkId(2)) = "changed";
  table.Erase(LandmarkId(5));
  EXPECT_EQ(table.Insert("new"), LandmarkId(5, 1));
  EXPECT_EQ(Content(snapshot), before);
  EXPECT_EQ(snapshot.At(LandmarkId(5)), "5");
  EXPECT_FALSE(snapshot.Contains(LandmarkId(5, 1)));
  EXPECT_EQ(table.Find(LandmarkId(200)), snapshot.Find(LandmarkId(200))) << "they share chunks";
  const auto after = Content(table);
  EXPECT_EQ(snapshot.Insert("theirs"), LandmarkId(4, 1));
  snapshot.Erase(LandmarkId(9));
  EXPECT_EQ(Content(table), after);
}

TEST(RecyclingTable, OldSnapshotsKeepTheirContent) {
  std::mt19937 random(2);
  TextTable table;
  std::map<LandmarkId, std::string> model;
  std::vector<std::pair<TextTable, std::map<LandmarkId, std::string>>> history;
  for (int step = 0; step < 3000; ++step) {
    const std::string value = std::to_string(step);
    const auto any = std::next(model.begin(), model.empty() ? 0 : random() % model.size());
    if (model.empty() || random() % 3 == 0) {
      model[table.Insert(value)] = value;
    } else if (random() % 2 == 0) {
      table.Mutable(any->first) = value;
      any->second = value;
    } else {
      table.Erase(any->first);
      model.erase(any);
    }
    if (step % 100 == 0) {
      history.emplace_back(table.Snapshot(), model);
    }
  }
  EXPECT_EQ(Content(table), model);
  for (const auto& [snapshot, expected] : history) {
    EXPECT_EQ(Content(snapshot), expected);
    EXPECT_EQ(snapshot.size(), expected.size());
  }
}

// The writer continues while a reader reads a snapshot and releases it; ThreadSanitizer checks
// this.
TEST(RecyclingTable, SnapshotsAreReadWhileTheTableIsWritten) {
  TextTable table = MakeTextTable(100);
  for (int round = 0; round < 20; ++round) {
    const auto expected = Content(table);
    auto snapshot = std::make_unique<TextTable>(table.Snapshot());
    std::thread reader([&] {
      EXPECT_EQ(Content(*snapshot), expected);
      snapshot.reset();
    });
    for (const auto& [id, value] : expected) {
      table.Erase(id);
      table.Insert(value);
    }
    reader.join();
  }
}

TEST(RecyclingTable, IsRestoredFromItsValuesAndFreeIds) {
  TextTable table = MakeTextTable(10);
  for (const uint32_t slot : {7u, 2u, 5u}) {
    table.Erase(LandmarkId(slot));
  }
  table.Insert("again");
  for (uint32_t generation = 0; generation <= LandmarkId::kMaxGeneration; ++generation) {
    table.Erase(LandmarkId(9, generation));  // the last time retires the slot
    if (generation < LandmarkId::kMaxGeneration) {
      table.Insert("short-lived");
    }
  }
  ASSERT_EQ(table.used_slots(), 10u);
  ASSERT_EQ(table.FreeIds(), (std::vector{LandmarkId(2, 1), LandmarkId(7, 1)}));

  TextTable copy;
  for (const auto& [id, value] : table) {
    copy.Put(id, value);
  }
  const std::vector<LandmarkId> free = table.FreeIds();
  std::for_each(free.rbegin(), free.rend(), [&](LandmarkId id) { copy.PutFree(id); });
  copy.SkipSlots(table.used_slots());
  EXPECT_EQ(Content(copy), Content(table));
  EXPECT_EQ(copy.slots(), table.slots());
  EXPECT_THROW(copy.Put(LandmarkId(2, 3), "used"), CheckError);
  EXPECT_THROW(copy.PutFree(LandmarkId(0, 1)), CheckError);
  EXPECT_THROW(copy.Put(LandmarkId(), "invalid"), CheckError);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(copy.Insert("new"), table.Insert("new"));
  }
}

}  // namespace
}  // namespace hullslam
