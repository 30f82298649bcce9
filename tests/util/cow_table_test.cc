// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/cow_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "hullslam/util/id.h"

namespace hullslam {
namespace {

constexpr size_t kChunk = 4;
using Table = CowTable<LandmarkId, std::string, kChunk>;

Table MakeTable(uint32_t count) {
  Table table;
  for (uint32_t i = 0; i < count; ++i) {
    table.Insert(std::to_string(i));
  }
  return table;
}

std::map<uint32_t, std::string> Content(const Table& table) {
  std::map<uint32_t, std::string> content;
  table.ForEach([&](LandmarkId id, const std::string& value) { content[id.value] = value; });
  return content;
}

TEST(CowTable, AssignsIdsInOrderAndNeverReusesThem) {
  Table table = MakeTable(10);
  EXPECT_EQ(table.size(), 10u);
  table.Erase(LandmarkId(9));
  EXPECT_EQ(table.NextId(), LandmarkId(10));
  EXPECT_EQ(table.Insert("next"), LandmarkId(10));
  EXPECT_FALSE(table.Contains(LandmarkId(9)));
  EXPECT_EQ(table.At(LandmarkId(10)), "next");
}

TEST(CowTable, VisitsInOrderOfIds) {
  Table table = MakeTable(23);
  for (const uint32_t erased : {0u, 5u, 8u, 9u, 10u, 11u, 22u}) {
    table.Erase(LandmarkId(erased));
  }
  std::vector<uint32_t> visited;
  table.ForEach([&](LandmarkId id, const std::string& value) {
    EXPECT_EQ(value, std::to_string(id.value));
    visited.push_back(id.value);
  });
  EXPECT_EQ(visited,
            (std::vector<uint32_t>{1, 2, 3, 4, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}));
  EXPECT_EQ(table.size(), visited.size());
}

// Chunks and whole blocks between the ids have no values, before and after some were erased.
TEST(CowTable, FindsTheNearestIdsWithValues) {
  Table table;
  const std::vector<uint32_t> ids = {3, 4, 11, 90, 2000, 2001, 50'000};
  for (const uint32_t id : ids) {
    table.Put(LandmarkId(id), "value");
  }
  table.Put(LandmarkId(700), "erased");
  table.Put(LandmarkId(60'000), "erased");
  table.Erase(LandmarkId(700));
  table.Erase(LandmarkId(60'000));
  for (uint32_t id = 0; id < 70'000; id += id < 3000 ? 1 : 997) {
    const auto after = std::upper_bound(ids.begin(), ids.end(), id);
    const auto before = std::lower_bound(ids.begin(), ids.end(), id);
    EXPECT_EQ(table.After(LandmarkId(id)), after != ids.end() ? LandmarkId(*after) : LandmarkId());
    EXPECT_EQ(table.Before(LandmarkId(id)),
              before != ids.begin() ? LandmarkId(*std::prev(before)) : LandmarkId());
  }
  EXPECT_EQ(table.After(LandmarkId()), LandmarkId());
  EXPECT_EQ(table.Before(LandmarkId()), LandmarkId(50'000));
  EXPECT_EQ(Table().After(LandmarkId(0)), LandmarkId());
  EXPECT_EQ(Table().Before(LandmarkId(5)), LandmarkId());
}

TEST(CowTable, PutStoresAValueUnderAnId) {
  Table table;
  table.Put(LandmarkId(9), "nine");
  table.Put(LandmarkId(2), "two");
  EXPECT_EQ(table.NextId(), LandmarkId(10));
  EXPECT_EQ(Content(table), (std::map<uint32_t, std::string>{{2, "two"}, {9, "nine"}}));
  EXPECT_THROW(table.Put(LandmarkId(9), "again"), CheckError);
  EXPECT_THROW(table.Put(LandmarkId(), "invalid"), CheckError);
}

TEST(CowTable, RefusesIdsWithoutValue) {
  Table table = MakeTable(3);
  table.Erase(LandmarkId(1));
  for (const LandmarkId id : {LandmarkId(1), LandmarkId(3), LandmarkId(999), LandmarkId()}) {
    EXPECT_EQ(table.Find(id), nullptr);
    EXPECT_FALSE(table.Contains(id));
    EXPECT_THROW(table.At(id), CheckError);
    EXPECT_THROW(table.Mutable(id), CheckError);
    EXPECT_THROW(table.Erase(id), CheckError);
  }
}

// No kind of write to a table or to its snapshot changes the other one.
TEST(CowTable, SnapshotAndTableDoNotSeeEachOthersWrites) {
  Table table = MakeTable(10);
  const auto before = Content(table);
  Table snapshot = table.Snapshot();
  table.Mutable(LandmarkId(2)) = "changed";
  table.Erase(LandmarkId(5));
  table.Insert("new");
  EXPECT_EQ(Content(snapshot), before);
  EXPECT_EQ(snapshot.size(), 10u);
  EXPECT_EQ(snapshot.NextId(), LandmarkId(10));
  const auto after = Content(table);
  snapshot.Mutable(LandmarkId(0)) = "other";
  snapshot.Erase(LandmarkId(9));
  snapshot.Insert("theirs");
  EXPECT_EQ(Content(table), after);
}

TEST(CowTable, OldSnapshotsKeepTheirContent) {
  std::mt19937 random(2);
  Table table;
  std::map<uint32_t, std::string> model;
  std::vector<std::pair<Table, std::map<uint32_t, std::string>>> history;
  for (int step = 0; step < 2000; ++step) {
    const LandmarkId any(
        table.NextId().value == 0 ? 0 : static_cast<uint32_t>(random()) % table.NextId().value);
    const std::string value = std::to_string(step);
    if (random() % 3 == 0 || !table.Contains(any)) {
      model[table.Insert(value).value] = value;
    } else if (random() % 2 == 0) {
      table.Mutable(any) = value;
      model[any.value] = value;
    } else {
      table.Erase(any);
      model.erase(any.value);
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

TEST(CowTable, ClonesOnlyTheChunkThatIsWritten) {
  Table table = MakeTable(3 * kChunk);
  const Table snapshot = table.Snapshot();
  table.Mutable(LandmarkId(kChunk)) = "changed";
  EXPECT_EQ(table.Find(LandmarkId(0)), snapshot.Find(LandmarkId(0)));
  EXPECT_NE(table.Find(LandmarkId(kChunk + 1)), snapshot.Find(LandmarkId(kChunk + 1)));
  EXPECT_EQ(table.Find(LandmarkId(2 * kChunk)), snapshot.Find(LandmarkId(2 * kChunk)));
  const std::string* written = table.Find(LandmarkId(kChunk));
  table.Mutable(LandmarkId(kChunk)) = "again";
  EXPECT_EQ(table.Find(LandmarkId(kChunk)), written) << "a chunk is cloned once";
}

TEST(CowTable, FreesAChunkWithoutValues) {
  CowTable<LandmarkId, std::shared_ptr<int>, kChunk> table;
  std::vector<std::weak_ptr<int>> watched;
  for (int i = 0; i < 8; ++i) {
    const auto value = std::make_shared<int>(i);
    watched.push_back(value);
    table.Insert(value);
  }
  {
    const auto snapshot = table.Snapshot();
    for (uint32_t i = 0; i < kChunk; ++i) {
      table.Erase(LandmarkId(i));
    }
    EXPECT_EQ(*snapshot.At(LandmarkId(3)), 3) << "the snapshot still holds it";
    EXPECT_FALSE(watched[3].expired());
  }
  for (uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(watched[i].expired(), i < kChunk) << i;
  }
  table.Put(LandmarkId(1), std::make_shared<int>(11));
  EXPECT_EQ(*table.At(LandmarkId(1)), 11);
}

// A snapshot copies pointers to blocks of 64 chunks. Two writes to one block clone it once, and the
// other chunks of the block stay shared.
TEST(CowTable, ASnapshotSharesAllChunksThatAreNotWritten) {
  constexpr uint32_t kBlock = 64 * kChunk;
  Table table = MakeTable(3 * kBlock + 1);
  const auto before = Content(table);
  const Table snapshot = table.Snapshot();
  table.Mutable(LandmarkId(kBlock)) = "changed";
  table.Mutable(LandmarkId(2 * kBlock - 1)) = "changed";
  table.Erase(LandmarkId(3 * kBlock));
  table.Put(LandmarkId(9 * kBlock), "far away");
  size_t shared = 0;
  for (uint32_t i = 0; i < 3 * kBlock; ++i) {
    shared += table.Find(LandmarkId(i)) == snapshot.Find(LandmarkId(i)) ? 1 : 0;
  }
  EXPECT_EQ(shared, 3 * kBlock - 2 * kChunk);
  EXPECT_EQ(Content(snapshot), before);
  EXPECT_EQ(table.size(), 3 * kBlock + 1);
  EXPECT_EQ(Content(table).rbegin()->second, "far away") << "empty blocks in between are skipped";
  EXPECT_EQ(table.Find(LandmarkId(5 * kBlock)), nullptr);
}

TEST(CowTable, AnErasedBlockCanBeFilledAgain) {
  constexpr uint32_t kBlock = 64 * kChunk;
  Table table = MakeTable(kBlock);
  const Table snapshot = table.Snapshot();
  for (uint32_t i = 0; i < kBlock; ++i) {
    table.Erase(LandmarkId(i));
  }
  EXPECT_TRUE(table.empty());
  EXPECT_TRUE(Content(table).empty());
  table.Put(LandmarkId(5), "five");
  EXPECT_EQ(Content(table), (std::map<uint32_t, std::string>{{5, "five"}}));
  EXPECT_EQ(snapshot.size(), kBlock);
  EXPECT_EQ(snapshot.At(LandmarkId(5)), "5");
}

TEST(CowTable, MovingATableDoesNotMoveItsValues) {
  Table table = MakeTable(5);
  const std::string* value = table.Find(LandmarkId(4));
  const Table moved = std::move(table);
  EXPECT_EQ(moved.Find(LandmarkId(4)), value);
  EXPECT_EQ(moved.size(), 5u);
}

TEST(CowTable, ARangeForVisitsTheValuesInTheOrderOfTheirIds) {
  const Table empty;
  EXPECT_TRUE(empty.begin() == empty.end());
  Table table = MakeTable(200);  // several chunks
  for (uint32_t i = 0; i < 200; ++i) {
    if (i % 7 != 0 && i != 199) {
      table.Erase(LandmarkId(i));
    }
  }
  for (uint32_t i = 70; i < 133; i += 7) {
    table.Erase(LandmarkId(i));  // now a whole chunk is empty
  }
  std::vector<uint32_t> ids;
  for (const auto& [id, value] : table) {
    EXPECT_EQ(&value, table.Find(id)) << "the value itself, not a copy";
    ids.push_back(id.value);
  }
  std::vector<uint32_t> visited;
  table.ForEach([&](LandmarkId id, const std::string&) { visited.push_back(id.value); });
  EXPECT_EQ(ids, visited);
  EXPECT_EQ(ids.size(), table.size());
  EXPECT_EQ(ids.front(), 0u);
  EXPECT_EQ(ids.back(), 199u);
  EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
}

TEST(CowTable, WorksWithTheAlgorithmsForRanges) {
  const Table table = MakeTable(5);
  static_assert(std::ranges::input_range<const Table>);
  EXPECT_EQ(
      std::ranges::count_if(table, [](const auto& entry) { return entry.first == LandmarkId(3); }),
      1);
}

// The writer continues while a reader reads a snapshot and releases it; ThreadSanitizer checks
// this.
TEST(CowTable, SnapshotsAreReadWhileTheTableIsWritten) {
  Table table = MakeTable(100);
  for (int round = 0; round < 20; ++round) {
    const auto expected = Content(table);
    auto snapshot = std::make_unique<Table>(table.Snapshot());
    std::thread reader([&] {
      EXPECT_EQ(Content(*snapshot), expected);
      snapshot.reset();
    });
    for (uint32_t i = 0; i < 100; ++i) {
      table.Mutable(LandmarkId(i)) = std::to_string(round);
    }
    reader.join();
  }
}

TEST(CowTable, SkipsIdsThatWereUsed) {
  CowTable<KeyframeId, int, 4> table;
  table.Put(KeyframeId(3), 1);
  table.SkipIds(KeyframeId(2));
  EXPECT_EQ(table.NextId(), KeyframeId(4));
  table.SkipIds(KeyframeId(9));
  EXPECT_EQ(table.Insert(2), KeyframeId(9));
  EXPECT_EQ(table.size(), 2u);
}

}  // namespace
}  // namespace hullslam
