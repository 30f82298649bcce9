// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/ros1_bag.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/made_bags.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::vector<MadeMessage> kTwoImages = {{"/a", "sensor_msgs/Image", 1, "first"},
                                             {"/a", "sensor_msgs/Image", 2, "second"}};

class Ros1BagTest : public ::testing::Test {
 protected:
  // Returns the number of messages.
  size_t Scan(const std::string& bytes, std::vector<std::string>* warnings = nullptr) const {
    Ros1Bag bag(folder_.Write("a.bag", bytes));
    size_t messages = 0;
    bag.Scan([&](const BagMessage&) { ++messages; });
    if (warnings != nullptr) {
      *warnings = bag.warnings();
    }
    return messages;
  }

  void ExpectRefusal(const std::string& record, std::vector<std::string> parts) const {
    parts.emplace_back("a.bag: the record at byte ");
    ExpectInputError([&] { Scan(std::string(kRos1Magic) + record); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(Ros1BagTest, ACutBagIsReadUpToTheCutWithAWarning) {
  const std::string whole = MadeRos1(kTwoImages, "lz4");
  size_t warned = 0;
  for (size_t kept = kRos1Magic.size(); kept < whole.size(); ++kept) {
    std::vector<std::string> warnings;
    EXPECT_LE(Scan(whole.substr(0, kept), &warnings), 1u);
    warned += warnings.size();
  }
  // No warning where a record ends: after the magic, the header and the first chunk.
  EXPECT_EQ(warned, whole.size() - kRos1Magic.size() - 3);
  EXPECT_EQ(Scan(whole), 2u);
}

TEST_F(Ros1BagTest, BrokenRecordsAreRefused) {
  const auto number = [](uint32_t value) { return BytesOfNumber(value); };
  ExpectRefusal(Ros1RecordBytes({{"conn", number(1)}}, ""), {"no field 'op' of 1 bytes"});
  ExpectRefusal(Ros1RecordBytes({{"op", "\x02"}}, ""), {"no field 'conn' of 4 bytes"});
  ExpectRefusal(Ros1RecordBytes({{"op", "\x02"}, {"conn", number(1)}}, ""),
                {"a connection that was not declared"});
  ExpectRefusal(number(0xffffffff), {"a header of 4294967295 bytes"});
  ExpectRefusal(number(5) + number(1) + "x" + number(0), {"without a '='"});
  ExpectRefusal(number(4) + number(100) + number(0), {"has more elements than bytes"});
}

// Each topic was compared with all others: 50 000 took 4 s, 100 000 four times as much.
TEST_F(Ros1BagTest, TooManyTopicsAreRefusedInAMoment) {
  std::string records;
  for (uint32_t i = 0; i < 100'001; ++i) {
    records += Ros1RecordBytes(
        {{"op", "\x07"}, {"conn", BytesOfNumber(i)}, {"topic", std::to_string(i)}}, "");
  }
  const std::string chunk =
      Ros1RecordBytes({{"op", "\x05"},
                       {"compression", "none"},
                       {"size", BytesOfNumber(static_cast<uint32_t>(records.size()))}},
                      records);
  ExpectInputError([&] { Scan(std::string(kRos1Magic) + chunk); }, {"more than 100000 topics"});
}

TEST_F(Ros1BagTest, BrokenChunksAreRefused) {
  const auto chunk = [](const char* compression, uint32_t size, const std::string& data) {
    return Ros1RecordBytes(
        {{"op", "\x05"}, {"compression", compression}, {"size", BytesOfNumber(size)}}, data);
  };
  ExpectRefusal(chunk("bz2", 100, "no bzip2"), {"broken"});
  ExpectRefusal(chunk("lz4", 100, Compressed("lz4", std::string(101, 'x'))), {"more than 100"});
  ExpectRefusal(chunk("none", 0xffffffff, ""), {"4294967295 bytes, expected at most 256000000"});
  ExpectRefusal(chunk("none", 3, "abc"), {"is cut off"});
  ExpectRefusal(chunk("zip", 3, "abc"), {"'zip'"});
}

}  // namespace
}  // namespace hullslam
