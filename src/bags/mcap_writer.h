// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bags/mcap_bag.h"
#include "files/bytes.h"
#include "files/staged_file.h"

namespace hullslam {

// Writes a file of MCAP (https://mcap.dev/spec) with messages of ROS 2: chunks that are compressed
// with Zstandard, an index of the messages in each chunk, and a summary with an index of the chunks
// and the numbers of messages, by which players seek. The file gets its name by Close() as a
// whole. The same calls give the same bytes.
class McapWriter {
 public:
  // All functions throw InputError with `path` and the reason of the system if writing fails.
  // `library` names the program in the file.
  McapWriter(const std::filesystem::path& path, const std::string& library);

  // Adds a topic. `type` is one of ROS 2, such as "sensor_msgs/msg/Image", and `schema` the text of
  // its definition (Ros2Schema()). Returns the number by which messages name their topic.
  uint16_t AddTopic(const std::string& name, const std::string& type, const std::string& schema);
  // Adds a message, as CdrWriter gives it. `time` is in nanoseconds.
  void Write(uint16_t topic, uint64_t time, std::string_view message);
  // Writes the rest and replaces an earlier file. To be called once, at the end.
  void Close();

 private:
  struct ChunkIndex {
    uint64_t start_time = 0;
    uint64_t end_time = 0;
    uint64_t position = 0;
    uint64_t length = 0;
    std::vector<std::pair<uint16_t, uint64_t>> message_indices = {};  // topic, position
    uint64_t message_indices_length = 0;
    uint64_t compressed_size = 0;
    uint64_t size = 0;
  };
  struct Topic {
    std::string schema_record;  // the contents of the records
    std::string channel_record;
    uint64_t messages = 0;
  };
  using MessageTimes = std::vector<std::pair<uint64_t, uint64_t>>;  // time, offset in the chunk

  void Put(std::string_view bytes);
  void PutRecord(McapRecord kind, std::string_view content);
  void EndChunk();
  std::string Statistics() const;
  // The records of the summary, and the groups that they are in.
  std::string Summary() const;

  StagedFile file_;
  uint64_t position_ = 0;
  std::vector<Topic> topics_;  // the number of a topic is its index + 1
  ByteWriter chunk_;
  std::map<uint16_t, MessageTimes> chunk_messages_;
  std::vector<ChunkIndex> chunks_;
};

}  // namespace hullslam
