// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "bags/message_fields.h"
#include "files/random_access_file.h"

namespace hullslam {

struct BagTopic {
  std::string name;
  std::string type;  // as ROS 1 writes it: "sensor_msgs/Image"
  size_t messages = 0;
  MessageCoding coding = MessageCoding::kCdr;
};

// Where a message is in its file. What the numbers mean is known to the reader of the format.
struct MessagePosition {
  uint64_t chunk = 0;
  uint64_t offset = 0;
  uint64_t size = 0;
};

struct BagMessage {
  size_t topic = 0;    // index into Bag::topics()
  int64_t logged = 0;  // the time at which it was recorded, ns
  MessagePosition place;
  std::string_view bytes;  // only valid during the visit
};

// A file with messages of ROS or Foxglove.
class Bag {
 public:
  Bag() = default;
  virtual ~Bag() = default;
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;

  // Visits all messages in the order of the file and fills topics() and warnings(). To be called
  // once. Only one chunk is in memory at a time. Throws InputError with the file and the position
  // of what is broken. A file that ends too early is read up to there, with a warning.
  virtual void Scan(const std::function<void(const BagMessage& message)>& visit) = 0;
  // A message that Scan() visited. Messages that are near to each other in the file are read fast.
  virtual std::string Read(const MessagePosition& place) = 0;

  // Grows during Scan(): the topic of a message is known before the message.
  const std::vector<BagTopic>& topics() const { return topics_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 protected:
  // The index of the topic, which is added if it is new. Throws InputError for too many topics.
  size_t AddTopic(const std::string& name, const std::string& type, MessageCoding coding);
  // Adds the warning that the file ends within the record that begins at byte `record`.
  void WarnOfMissingEnd(const RandomAccessFile& file, uint64_t record);

  std::vector<BagTopic> topics_;
  std::vector<std::string> warnings_;

 private:
  std::map<std::tuple<std::string, std::string, MessageCoding>, size_t> indices_;
};

// Opens the files of a recording: one file in the format of MCAP, of rosbag2 (SQLite) or of ROS 1
// (2.0), recognised by its first bytes, or a folder of rosbag2 with such files, in the order of
// their names. Throws InputError for anything else.
std::vector<std::unique_ptr<Bag>> OpenBags(const std::filesystem::path& path);

}  // namespace hullslam
