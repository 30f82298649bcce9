// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "bags/bag.h"
#include "bags/decompress.h"
#include "files/random_access_file.h"

namespace hullslam {

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

// A bag of ROS 1 in the format 2.0 (http://wiki.ros.org/Bags/Format/2.0), in which TUM publishes
// its sequences. The records are read from the beginning to the end, so a bag without an index is
// read like any other.
class Ros1Bag final : public Bag {
 public:
  explicit Ros1Bag(const std::filesystem::path& path) : file_(path), expansion_(path) {}

  void Scan(const std::function<void(const BagMessage& message)>& visit) override;
  std::string Read(const MessagePosition& place) override;

 private:
  // The fields of a record's header by their names.
  using Fields = std::map<std::string, std::string, std::less<>>;
  struct Record {
    Fields fields;
    uint64_t position = 0;  // of the data
    uint64_t size = 0;      // of the data
  };

  std::string Place(uint64_t position) const;
  Fields ParseFields(std::string_view header, uint64_t position) const;
  // A field of the header that must be a number.
  template <typename Number>
  Number NumberOf(const Fields& fields, std::string_view name, uint64_t position) const;
  // The record at this position of the file; the size is that which it claims. Returns false if
  // the file ends in its header.
  bool ReadRecord(uint64_t position, Record& record) const;
  std::string LoadChunk(const Record& record) const;
  void TakeConnection(const Fields& fields, std::string_view data, uint64_t position);
  void TakeMessage(const Fields& fields, std::string_view data, const MessagePosition& place,
                   const std::function<void(const BagMessage& message)>& visit);
  void TakeChunk(const Record& record, const std::function<void(const BagMessage&)>& visit);

  RandomAccessFile file_;
  ExpansionLimit expansion_;
  ChunkCache chunks_;
  std::map<uint64_t, Record> chunk_records_;  // by the position of the data
  std::map<uint32_t, size_t> topics_of_connections_;
};

}  // namespace hullslam
