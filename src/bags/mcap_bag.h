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

// The first and the last bytes of a file of MCAP, version 0.
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

// The kinds of records of MCAP (https://mcap.dev/spec) that are read or written here.
enum class McapRecord : uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

// A file of MCAP with messages of ROS 2, of ROS 1 or of Foxglove (protobuf), in chunks or not. Its
// data section is read from the beginning to the end, so a file without an index is read like any
// other. Channels with other encodings are only listed.
class McapBag final : public Bag {
 public:
  explicit McapBag(const std::filesystem::path& path) : file_(path), expansion_(path) {}

  void Scan(const std::function<void(const BagMessage& message)>& visit) override;
  std::string Read(const MessagePosition& place) override;

 private:
  struct Channel {
    size_t topic = 0;
    bool is_read = true;
  };

  std::string Place(uint64_t position) const;
  // The content of the chunk record whose content begins at `position`.
  std::string LoadChunk(uint64_t position, std::string_view record) const;
  // Records that may be in a chunk: schemas, channels and messages. The content is at `place`.
  void Take(McapRecord kind, std::string_view content, const MessagePosition& place,
            const std::function<void(const BagMessage& message)>& visit);
  void TakeChunk(uint64_t position, std::string_view record,
                 const std::function<void(const BagMessage& message)>& visit);

  RandomAccessFile file_;
  ExpansionLimit expansion_;
  ChunkCache chunks_;
  std::map<uint16_t, std::string> schemas_;  // the names, by id
  std::map<uint16_t, Channel> channels_;
};

}  // namespace hullslam
