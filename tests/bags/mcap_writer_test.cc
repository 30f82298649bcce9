// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/mcap_writer.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bags/ros2_schemas.h"
#include "files/bytes.h"
#include "files/read_file.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

constexpr const char* kType = "sensor_msgs/msg/CompressedImage";

// Writes messages of 400000 bytes each, so that there are several chunks.
std::string WriteSome(const std::filesystem::path& path) {
  McapWriter writer(path, "test");
  const uint16_t a = writer.AddTopic("/a", kType, Ros2Schema(kType));
  const uint16_t b = writer.AddTopic("/b", kType, Ros2Schema(kType));
  for (uint64_t i = 0; i < 10; ++i) {
    writer.Write(i % 3 == 0 ? b : a, 1000 + i, std::string(400'000, static_cast<char>('0' + i)));
  }
  writer.Close();
  return ReadFile(path);
}

TEST(McapWriterTest, TheReaderReadsIt) {
  const TemporaryFolder folder;
  WriteSome(folder.path() / "a.mcap");
  McapBag bag(folder.path() / "a.mcap");
  std::vector<BagMessage> messages;
  bag.Scan([&](const BagMessage& message) {
    messages.push_back(message);
    EXPECT_EQ(message.bytes, std::string(400'000, static_cast<char>('0' + messages.size() - 1)));
  });
  EXPECT_TRUE(bag.warnings().empty());
  ASSERT_EQ(messages.size(), 10u);
  EXPECT_EQ(messages[9].logged, 1009);
  EXPECT_EQ(bag.topics()[0].name, "/a");
  EXPECT_EQ(bag.topics()[0].messages, 6u);
  EXPECT_EQ(bag.topics()[1].type, "sensor_msgs/CompressedImage");
  EXPECT_EQ(bag.Read(messages[4].place), std::string(400'000, '4'));
}

TEST(McapWriterTest, TheSameMessagesGiveTheSameBytes) {
  const TemporaryFolder folder;
  EXPECT_EQ(WriteSome(folder.path() / "a.mcap"), WriteSome(folder.path() / "b.mcap"));
}

// Follows the positions that the footer and the index give, as a player does.
TEST(McapWriterTest, TheIndexLeadsToTheMessages) {
  const TemporaryFolder folder;
  const std::string file = WriteSome(folder.path() / "a.mcap");
  ASSERT_TRUE(file.ends_with(kMcapMagic));
  constexpr size_t kFooter = 9 + 20;
  const std::string_view bytes = file;
  ByteReader footer(bytes.substr(bytes.size() - kMcapMagic.size() - kFooter), "footer");
  EXPECT_EQ(footer.Get<uint8_t>(), static_cast<uint8_t>(McapRecord::kFooter));
  footer.GetRaw(8);
  const auto summary = footer.Get<uint64_t>();
  const auto offsets = footer.Get<uint64_t>();
  ASSERT_LT(summary, offsets);
  size_t chunks = 0;
  for (size_t at = summary; at < offsets;) {
    ByteReader reader(bytes.substr(at), "summary");
    const auto kind = static_cast<McapRecord>(reader.Get<uint8_t>());
    const auto length = reader.Get<uint64_t>();
    if (kind == McapRecord::kChunkIndex) {
      ++chunks;
      reader.GetRaw(16);
      const auto position = reader.Get<uint64_t>();
      EXPECT_EQ(bytes[position], static_cast<char>(McapRecord::kChunk));
      reader.GetRaw(8);
      const size_t indices = reader.GetCount(1) / 10;
      for (size_t i = 0; i < indices; ++i) {
        const auto topic = reader.Get<uint16_t>();
        ByteReader index(bytes.substr(reader.Get<uint64_t>()), "index");
        EXPECT_EQ(index.Get<uint8_t>(), static_cast<uint8_t>(McapRecord::kMessageIndex));
        index.GetRaw(8);
        EXPECT_EQ(index.Get<uint16_t>(), topic);
      }
    }
    at += 9 + length;
  }
  EXPECT_EQ(chunks, 4u);
}

TEST(McapWriterTest, AFullDiskIsAnErrorThatNamesTheFile) {
  const TemporaryFolder folder;
  const auto path = folder.Write("a.mcap", "earlier");
  const FileSizeLimit limit(500);
  ExpectInputError([&] { WriteSome(path); }, {"a.mcap: cannot be written"});
  EXPECT_EQ(ReadFile(path), "earlier");
}

}  // namespace
}  // namespace hullslam
