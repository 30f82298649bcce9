// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/mcap_bag.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/made_bags.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::vector<MadeMessage> kThreeImages = {{"/a", "sensor_msgs/Image", 1, "first"},
                                               {"/a", "sensor_msgs/Image", 2, "second"},
                                               {"/a", "sensor_msgs/Image", 3, "third"}};

class McapBagTest : public ::testing::Test {
 protected:
  struct Result {
    std::vector<std::string> messages;
    std::vector<std::string> warnings;
    std::vector<BagTopic> topics;
  };

  Result Scan(const std::string& bytes) const {
    McapBag bag(folder_.Write("a.mcap", bytes));
    Result result;
    bag.Scan([&](const BagMessage& message) { result.messages.emplace_back(message.bytes); });
    result.warnings = bag.warnings();
    result.topics = bag.topics();
    return result;
  }

  void ExpectRefusal(const std::string& bytes, std::vector<std::string> parts) const {
    parts.emplace_back("a.mcap: the record at byte ");
    ExpectInputError([&] { Scan(bytes); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(McapBagTest, ACutFileIsReadUpToTheCutWithAWarning) {
  for (const char* const compression : {"", "zstd"}) {
    const std::string whole = MadeMcap(kThreeImages, compression);
    size_t former = 0;
    for (size_t kept = kMcapMagic.size(); kept < whole.size(); ++kept) {
      const Result result = Scan(whole.substr(0, kept));
      EXPECT_GE(result.messages.size(), former);
      former = result.messages.size();
      ASSERT_EQ(result.warnings.size(), 1u) << kept;
      EXPECT_NE(result.warnings[0].find("cut off"), std::string::npos) << result.warnings[0];
    }
    EXPECT_EQ(former, kThreeImages.size());
    EXPECT_TRUE(Scan(whole).warnings.empty());
  }
}

TEST_F(McapBagTest, ChunksWithWrongSizesOrChecksumsAreRefused) {
  const std::string file(kMcapMagic);
  const std::string records(1000, '\0');
  ExpectRefusal(file + McapChunkBytes("zstd", records, 999), {"more than 999 bytes"});
  ExpectRefusal(file + McapChunkBytes("lz4", records, 1001), {"1001 bytes, but has 1000"});
  ExpectRefusal(file + McapChunkBytes("none", records, 1000, 12345), {"wrong checksum"});
  ExpectRefusal(file + McapChunkBytes("xz", records, 1000), {"'xz'", "none, bz2, lz4 or zstd"});
  ExpectRefusal(file + McapChunkBytes("zstd", records, uint64_t{1} << 60U),
                {"1152921504606846976 bytes", "at most 256000000"});
}

TEST_F(McapBagTest, AbsurdRecordsAreRefused) {
  const std::string file(kMcapMagic);
  // A record in a chunk that is longer than the chunk.
  std::string record = McapRecordBytes(McapRecord::kMessage, "12");
  record[1] = 100;
  ExpectRefusal(file + McapChunkBytes("none", record, record.size()), {"is cut off"});
  ExpectRefusal(file + McapRecordBytes(McapRecord::kMessage, std::string(22, '\7')),
                {"a channel that was not declared"});
  ExpectRefusal(file + McapRecordBytes(McapRecord::kChannel, "\1"), {"is cut off"});
}

TEST_F(McapBagTest, RecordsOfOtherKindsAreSkipped) {
  std::string file = MadeMcap(kThreeImages);
  file.insert(kMcapMagic.size(), McapRecordBytes(static_cast<McapRecord>(0x80), "unknown") +
                                     McapRecordBytes(McapRecord::kHeader, "header"));
  EXPECT_EQ(Scan(file).messages.size(), 3u);
}

// `mcap convert` writes the messages of a bag of ROS 1 as they are.
TEST_F(McapBagTest, MessagesOfRos1AndOfProtobufAreKnown) {
  const Result ros1 = Scan(MadeMcap(kThreeImages, "", "ros1"));
  EXPECT_EQ(ros1.messages.size(), 3u);
  EXPECT_EQ(ros1.topics.at(0).type, "sensor_msgs/Image");
  EXPECT_EQ(ros1.topics[0].coding, MessageCoding::kRos1);
  const Result protobuf = Scan(MadeMcap(kThreeImages, "", "protobuf"));
  EXPECT_EQ(protobuf.messages.size(), 3u);
  EXPECT_EQ(protobuf.topics.at(0).coding, MessageCoding::kProtobuf);
}

TEST_F(McapBagTest, OtherEncodingsAreListedOnly) {
  const Result result = Scan(MadeMcap(kThreeImages, "", "json"));
  EXPECT_TRUE(result.messages.empty());
  ASSERT_EQ(result.topics.size(), 1u);
  EXPECT_EQ(result.topics[0].type, "sensor_msgs/Image (json)");
  EXPECT_EQ(result.topics[0].messages, 3u);
}

}  // namespace
}  // namespace hullslam
