// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/decompress.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "support/expect_error.h"
#include "support/made_bags.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::map<std::string, Compression> kNames = {{"none", Compression::kNone},
                                                   {"bz2", Compression::kBzip2},
                                                   {"lz4", Compression::kLz4},
                                                   {"zstd", Compression::kZstd}};

std::string SomeBytes(size_t count) {
  std::string bytes;
  for (size_t i = 0; bytes.size() < count; ++i) {
    bytes += std::to_string(i * i);
  }
  return bytes;
}

TEST(DecompressTest, GivesBackWhatWasCompressed) {
  for (const auto& [name, compression] : kNames) {
    EXPECT_EQ(ParseCompression(name, "file"), compression);
    for (const size_t size : {size_t{1}, size_t{1000}, size_t{1'000'000}}) {
      const std::string bytes = SomeBytes(size);
      EXPECT_EQ(Decompress(compression, Compressed(name, bytes), bytes.size(), "file"), bytes)
          << name << ' ' << size;
    }
  }
  EXPECT_EQ(ParseCompression("", "file"), Compression::kNone);
}

TEST(DecompressTest, BrokenBytesAreRefused) {
  const std::string bytes = SomeBytes(300'000);
  for (const auto& [name, compression] : kNames) {
    if (compression == Compression::kNone) {
      continue;
    }
    const std::string packed = Compressed(name, bytes);
    const auto decompress = [&, kind = compression](const std::string& some, uint64_t most) {
      return [=] { Decompress(kind, some, most, "a.bag: chunk 7"); };
    };
    for (const size_t kept : {size_t{0}, size_t{3}, packed.size() / 2, packed.size() - 1}) {
      ExpectInputError(decompress(packed.substr(0, kept), bytes.size()),
                       {"a.bag: chunk 7", "compressed bytes are"});
    }
    ExpectInputError(decompress("no compressed bytes", 100), {"a.bag: chunk 7", "broken"});
    ExpectInputError(decompress(packed + "and more", bytes.size()), {"a.bag: chunk 7"});
    // A bomb is stopped at the limit.
    ExpectInputError(decompress(packed, bytes.size() - 1),
                     {"more than " + std::to_string(bytes.size() - 1) + " bytes"});
    ExpectInputError(decompress(Compressed(name, std::string(3'000'000, 'x')), 1000),
                     {"more than 1000 bytes"});
  }
}

TEST(DecompressTest, UnknownCompressionsAreNamed) {
  ExpectInputError([] { ParseCompression("xz", "a.mcap: chunk"); },
                   {"a.mcap: chunk", "'xz'", "none, bz2, lz4 or zstd"});
}

// A chunk of zeros is a thousand times smaller than its content. So a small file must not be read
// for minutes.
TEST(ExpansionLimitTest, AFileMayBecomeAHundredTimesItsSizeAndOneChunkMore) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.mcap", std::string(1000, 'x'));
  ExpansionLimit limit(file);
  limit.Add(kMostBagBytes);
  limit.Add(100'000);
  ExpectInputError([&] { limit.Add(1); },
                   {"a.mcap: its compressed parts have more than 256100000 bytes"});
  ExpansionLimit with_log(file, 500);
  with_log.Add(kMostBagBytes + 150'000);
  EXPECT_THROW(with_log.Add(1), InputError);
}

TEST(ChunkCacheTest, KeepsTheChunksThatWereUsedLast) {
  ChunkCache cache;
  int loads = 0;
  const auto get = [&](uint64_t position) {
    return cache.Get(position, [&] {
      ++loads;
      return std::to_string(position);
    });
  };
  for (const uint64_t position : {1, 2, 3, 1, 2, 1}) {
    EXPECT_EQ(get(position), std::to_string(position));
  }
  EXPECT_EQ(loads, 3);
  get(4);  // takes the place of 3
  get(1);
  get(2);
  EXPECT_EQ(loads, 4);
  get(3);
  EXPECT_EQ(loads, 5);
}

}  // namespace

}  // namespace hullslam
