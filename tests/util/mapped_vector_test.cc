// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/mapped_vector.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/file_size_limit.h"

namespace hullslam {
namespace {

struct Record {
  double number = 0.0;
  std::optional<int> half;
};

Record RecordOf(size_t i) {
  return {static_cast<double>(i),
          i % 2 == 0 ? std::optional(static_cast<int>(i / 2)) : std::nullopt};
}

void ExpectRecords(const MappedVector<Record>& records, size_t count) {
  ASSERT_EQ(records.size(), count);
  for (size_t i = 0; i < count; ++i) {
    ASSERT_EQ(records.all()[i].number, RecordOf(i).number);
    ASSERT_EQ(records.all()[i].half, RecordOf(i).half);
  }
}

constexpr size_t kMany = 5 * MappedVector<Record>::kMostInMemory + 7;

TEST(MappedVector, HasWhatWasAdded) {
  MappedVector<Record> records;
  EXPECT_TRUE(records.empty());
  for (size_t i = 0; i < kMany; ++i) {
    records.push_back(RecordOf(i));
    ASSERT_EQ(records.size(), i + 1);
    ASSERT_EQ(records.back().number, static_cast<double>(i));
  }
  ExpectRecords(records, kMany);
  records.all()[3].number = -1.0;
  EXPECT_EQ(records.all()[3].number, -1.0);
}

TEST(MappedVector, BeginsAgainAfterItWasCleared) {
  MappedVector<Record> records;
  for (const size_t count : {kMany, size_t{5}, kMany}) {
    for (size_t i = 0; i < count; ++i) {
      records.push_back(RecordOf(i));
    }
    ExpectRecords(records, count);
    records.clear();
    EXPECT_TRUE(records.empty());
  }
}

TEST(MappedVector, IsMovedWithItsElements) {
  MappedVector<Record> records;
  for (size_t i = 0; i < kMany; ++i) {
    records.push_back(RecordOf(i));
  }
  MappedVector<Record> moved = std::move(records);
  ExpectRecords(moved, kMany);
  EXPECT_TRUE(records.empty());  // NOLINT(bugprone-use-after-move): a moved one is empty
  records.push_back(RecordOf(0));
  ExpectRecords(records, 1);
}

TEST(MappedMemory, PagesThatWereGivenBackKeepTheirContent) {
  constexpr size_t kBytes = 100'000;
  MappedMemory memory;
  memory.Grow(kBytes);
  EXPECT_TRUE(memory.has_file());
  EXPECT_GE(memory.size(), kBytes);
  auto* bytes = static_cast<unsigned char*>(memory.data());
  for (size_t i = 0; i < kBytes; ++i) {
    bytes[i] = static_cast<unsigned char>(i % 251);
  }
  memory.GiveBack(kBytes);
  memory.Grow(20 * kBytes);
  bytes = static_cast<unsigned char*>(memory.data());
  for (size_t i = 0; i < kBytes; ++i) {
    ASSERT_EQ(bytes[i], i % 251);
  }
}

// The number of pages of these bytes that take memory of this process (Linux, pagemap).
size_t PresentPages(const MappedMemory& memory, size_t bytes) {
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  std::vector<uint64_t> entries(bytes / page);
  std::ifstream in("/proc/self/pagemap", std::ios::binary);
  in.seekg(static_cast<std::streamoff>(reinterpret_cast<uintptr_t>(memory.data()) / page * 8));
  in.read(reinterpret_cast<char*>(entries.data()),
          static_cast<std::streamsize>(8 * entries.size()));
  EXPECT_TRUE(in.good());
  return static_cast<size_t>(
      std::ranges::count_if(entries, [](uint64_t entry) { return (entry >> 63U) != 0; }));
}

TEST(MappedMemory, GivesAllBackInTurnButLittleAtATime) {
  constexpr size_t kBytes = 5 * MappedMemory::kMostGivenBack;
  MappedMemory memory;
  memory.Grow(kBytes);
  if (!memory.has_file()) {
    GTEST_SKIP() << "no room for a temporary file";
  }
  std::memset(memory.data(), 1, kBytes);
  const size_t all = PresentPages(memory, kBytes);
  const size_t most = all / 5;
  memory.GiveBack(kBytes);
  EXPECT_EQ(PresentPages(memory, kBytes), all - 2 * most) << "the last and the first ones";
  memory.GiveBack(kBytes);
  EXPECT_EQ(PresentPages(memory, kBytes), all - 3 * most);
  memory.GiveBack(kBytes);
  memory.GiveBack(kBytes);
  EXPECT_EQ(PresentPages(memory, kBytes), 0u);
  memory.GiveBack(kBytes);
  EXPECT_EQ(static_cast<const char*>(memory.data())[0], 1);
  memory.GiveBack(kBytes);
  EXPECT_EQ(PresentPages(memory, kBytes), 0u) << "it begins again";
}

TEST(MappedMemory, AFullDiskIsNoReasonToEndARun) {
  MappedMemory memory;
  memory.Grow(1000);
  ASSERT_TRUE(memory.has_file());
  static_cast<char*>(memory.data())[999] = 'x';
  const FileSizeLimit limit(10'000);
  memory.Grow(1'000'000);
  EXPECT_FALSE(memory.has_file());
  EXPECT_EQ(static_cast<char*>(memory.data())[999], 'x');
  static_cast<char*>(memory.data())[999'999] = 'y';
  memory.Grow(2'000'000);
  EXPECT_EQ(static_cast<char*>(memory.data())[999'999], 'y');
}

// A folder for temporary files that is not there is no reason to end a run.
TEST(MappedVector, NeedsNoFile) {
  const char* const before = std::getenv("TMPDIR");
  const std::string folder = before != nullptr ? before : "";
  setenv("TMPDIR", "/nowhere/at/all", 1);
  MappedMemory memory;
  memory.Grow(1);
  EXPECT_FALSE(memory.has_file());
  MappedVector<Record> records;
  for (size_t i = 0; i < kMany; ++i) {
    records.push_back(RecordOf(i));
  }
  ExpectRecords(records, kMany);
  if (before != nullptr) {
    setenv("TMPDIR", folder.c_str(), 1);
  } else {
    unsetenv("TMPDIR");
  }
}

}  // namespace
}  // namespace hullslam
