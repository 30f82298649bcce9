// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/row_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

namespace hullslam {
namespace {

constexpr size_t kNoLimit = 1000000;

// A copy of the table that only sees the changes, as a browser does.
struct Copy {
  std::vector<uint32_t> ids;
  std::vector<float> values;

  void Apply(const RowChange& change, size_t width) {
    ids.resize(change.count);
    values.resize(change.count * width);
    for (size_t i = 0; i < change.at.size(); ++i) {
      ids.at(change.at[i]) = change.ids[i];
      for (size_t k = 0; k < width; ++k) {
        values.at(change.at[i] * width + k) = change.values[i * width + k];
      }
    }
  }
};

RowChange UpdateTo(RowTable& table, const std::map<uint32_t, float>& wanted, float tolerance = 0.0f,
                   size_t most = kNoLimit) {
  std::vector<uint32_t> ids;
  std::vector<float> values;
  for (const auto& [id, value] : wanted) {
    ids.push_back(id);
    values.push_back(value);
  }
  return table.Update(
      ids,
      [&](size_t i, float* row) {
        row[0] = values[i];
        row[1] = -values[i];
      },
      tolerance, most);
}

TEST(RowTable, ACopyThatOnlySeesTheChangesIsTheSame) {
  RowTable table(2, 2);
  Copy copy;
  std::mt19937 random(3);
  std::map<uint32_t, float> wanted;
  for (int round = 0; round < 300; ++round) {
    for (int i = 0; i < 20; ++i) {
      const uint32_t id = random() % 60;
      if (random() % 3 == 0) {
        wanted.erase(id);
      } else {
        wanted[id] = static_cast<float>(random() % 1000);
      }
    }
    copy.Apply(UpdateTo(table, wanted), 2);
    ASSERT_EQ(copy.ids, table.ids());
    ASSERT_EQ(copy.values, table.values());
    ASSERT_EQ(table.size(), wanted.size());
    for (size_t row = 0; row < table.size(); ++row) {
      ASSERT_EQ(table.values()[2 * row], wanted.at(table.ids()[row]));
      ASSERT_TRUE(table.Contains(table.ids()[row]));
    }
  }
}

TEST(RowTable, NothingIsSentWithoutAChange) {
  RowTable table(2, 1);
  EXPECT_EQ(UpdateTo(table, {{7, 1.0f}, {9, 2.0f}}).at.size(), 2u);
  EXPECT_TRUE(UpdateTo(table, {{7, 1.0f}, {9, 2.0f}}).empty());
  EXPECT_TRUE(UpdateTo(table, {{7, 1.05f}, {9, 2.0f}}, 0.1f).empty());
  EXPECT_EQ(UpdateTo(table, {{7, 1.2f}, {9, 2.0f}}, 0.1f).ids, std::vector<uint32_t>{7});
}

TEST(RowTable, RemovingTheLastRowsIsAChange) {
  RowTable table(2, 1);
  UpdateTo(table, {{7, 1.0f}, {9, 2.0f}});
  const RowChange change = UpdateTo(table, {{7, 1.0f}});
  EXPECT_FALSE(change.empty());
  EXPECT_EQ(change.count, 1u);
  EXPECT_TRUE(change.at.empty());
}

TEST(RowTable, ALimitedChangeIsContinuedByTheNextOnes) {
  RowTable table(2, 2);
  std::map<uint32_t, float> wanted;
  for (uint32_t id = 0; id < 100; ++id) {
    wanted[id] = static_cast<float>(id);
  }
  Copy copy;
  for (int round = 0; round < 10; ++round) {
    const RowChange change = UpdateTo(table, wanted, 0.0f, 10);
    EXPECT_LE(change.at.size(), 10u);
    copy.Apply(change, 2);
  }
  EXPECT_EQ(table.size(), 100u);
  EXPECT_EQ(copy.values, table.values());
  EXPECT_TRUE(UpdateTo(table, wanted, 0.0f, 10).empty());
}

}  // namespace
}  // namespace hullslam
