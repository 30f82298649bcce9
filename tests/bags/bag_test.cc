// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/bag.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/made_bags.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

const std::vector<MadeMessage> kMessages = {
    {"/a", "sensor_msgs/Image", 1'000'000'001, "first"},
    {"/b", "std_msgs/String", 2'000'000'002, ""},
    {"/a", "sensor_msgs/Image", 3'000'000'003, std::string("th\0ird", 6)}};

// Expects that a recording has the messages above.
void ExpectMessages(Bag& bag, const std::string& what) {
  struct Visited {
    MadeMessage message;
    MessagePosition place;
  };
  std::vector<Visited> visited;
  bag.Scan([&](const BagMessage& message) {
    const BagTopic& topic = bag.topics()[message.topic];
    visited.push_back({{topic.name, topic.type, static_cast<uint64_t>(message.logged),
                        std::string(message.bytes)},
                       message.place});
  });
  EXPECT_TRUE(bag.warnings().empty()) << what << bag.warnings()[0];
  ASSERT_EQ(visited.size(), kMessages.size()) << what;
  ASSERT_EQ(bag.topics().size(), 2u) << what;
  EXPECT_EQ(bag.topics()[0].messages, 2u) << what;
  for (const size_t i : {1, 2, 0}) {  // in any order
    EXPECT_EQ(visited[i].message.topic, kMessages[i].topic) << what;
    EXPECT_EQ(visited[i].message.type, kMessages[i].type) << what;
    EXPECT_EQ(visited[i].message.time, kMessages[i].time) << what;
    EXPECT_EQ(visited[i].message.bytes, kMessages[i].bytes) << what;
    EXPECT_EQ(bag.Read(visited[i].place), kMessages[i].bytes) << what;
  }
}

TEST(BagTest, EveryFormatIsRecognisedAndRead) {
  const TemporaryFolder folder;
  for (const char* const compression : {"", "none", "lz4", "zstd"}) {
    const auto file = folder.Write("a.mcap", MadeMcap(kMessages, compression));
    ExpectMessages(*OpenBags(file).at(0), std::string("MCAP, ") + compression);
  }
  for (const char* const compression : {"", "none", "lz4", "bz2"}) {
    const auto file = folder.Write("a.bag", MadeRos1(kMessages, compression));
    ExpectMessages(*OpenBags(file).at(0), std::string("ROS 1, ") + compression);
  }
  for (const char* const compression : {"none", "zstd"}) {
    const auto file = WriteMadeSqlite(folder.path() / "a.db3", kMessages, compression);
    ExpectMessages(*OpenBags(file).at(0), std::string("SQLite, ") + compression);
  }
}

TEST(BagTest, AFolderHasItsFilesInTheOrderOfTheirNames) {
  const TemporaryFolder folder;
  const auto bag = folder.path() / "run";
  folder.Write("run/metadata.yaml", "rosbag2_bagfile_information:\n");
  folder.Write("run/run_10.mcap", MadeMcap({kMessages[2]}));
  folder.Write("run/run_9.mcap", MadeMcap({kMessages[0], kMessages[1]}));
  const auto bags = OpenBags(bag);
  ASSERT_EQ(bags.size(), 2u);
  size_t messages = 0;
  bags[0]->Scan([&](const BagMessage&) { ++messages; });
  EXPECT_EQ(messages, 2u);
}

TEST(BagTest, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError([&] { OpenBags(folder.path() / "none.bag"); }, {"none.bag", "No such file"});
  ExpectInputError([&] { OpenBags(folder.path()); }, {"no file that ends in .mcap or .db3"});
  ExpectInputError([&] { OpenBags(folder.Write("empty.bag", "")); }, {"empty.bag: is no bag"});
  ExpectInputError([&] { OpenBags(folder.Write("a.bag", "#ROSBAG V1.2\n")); },
                   {"a.bag: is no bag", "2.0"});
  ExpectInputError([&] { OpenBags(folder.Write("a.db3.zstd", CompressZstd("SQLite"))); },
                   {"a.db3.zstd", "compressed as a whole", "unzstd"});
}

}  // namespace
}  // namespace hullslam
