// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/mcap_bag.h"

#include <fmt/format.h>
#include <zlib.h>

#include <optional>

#include "files/bytes.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

constexpr size_t kRecordHead = 9;               // kind and length
constexpr size_t kMessageHead = 2 + 4 + 8 + 8;  // channel, number, two times

struct RecordHead {
  McapRecord kind = McapRecord::kHeader;
  uint64_t length = 0;
};

RecordHead ReadRecordHead(std::string_view bytes) {
  ByteReader reader(bytes, "the head of a record");
  return {static_cast<McapRecord>(reader.Get<uint8_t>()), reader.Get<uint64_t>()};
}

// The codings of messages by the names that channels have for them.
std::optional<MessageCoding> CodingOf(std::string_view encoding) {
  if (encoding == "cdr") {
    return MessageCoding::kCdr;
  }
  if (encoding == "ros1") {
    return MessageCoding::kRos1;
  }
  return encoding == "protobuf" ? std::optional(MessageCoding::kProtobuf) : std::nullopt;
}

}  // namespace

std::string McapBag::Place(uint64_t position) const {
  return fmt::format("{}: the record at byte {}", file_.path().string(), position);
}

std::string McapBag::LoadChunk(uint64_t position, std::string_view record) const {
  const std::string place = Place(position);
  ByteReader reader(record, place);
  reader.GetRaw(16);  // the times of the first and the last message
  const auto size = reader.Get<uint64_t>();
  const auto expected_checksum = reader.Get<uint32_t>();
  const Compression compression = ParseCompression(reader.GetText(), place);
  const auto compressed_size = reader.Get<uint64_t>();
  if (size > kMostBagBytes) {
    throw InputError(
        fmt::format("{} is a chunk of {} bytes, expected at most {}", place, size, kMostBagBytes));
  }
  std::string content = Decompress(compression, reader.GetRaw(compressed_size), size, place);
  if (content.size() != size) {
    throw InputError(
        fmt::format("{} is a chunk of {} bytes, but has {}", place, size, content.size()));
  }
  const auto checksum = static_cast<uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()));
  if (expected_checksum != 0 && checksum != expected_checksum) {  // 0: there is none
    throw InputError(place + " is a chunk with a wrong checksum");
  }
  return content;
}

void McapBag::Take(McapRecord kind, std::string_view content, const MessagePosition& place,
                   const std::function<void(const BagMessage& message)>& visit) {
  ByteReader reader(content, Place(place.chunk == kNoChunk ? place.offset : place.chunk));
  if (kind == McapRecord::kSchema) {
    const auto id = reader.Get<uint16_t>();
    schemas_[id] = reader.GetText();
  } else if (kind == McapRecord::kChannel) {
    const auto id = reader.Get<uint16_t>();
    const auto schema = reader.Get<uint16_t>();
    const std::string topic = reader.GetText();
    const std::string encoding = reader.GetText();
    const std::string type = schemas_.contains(schema) ? schemas_.at(schema) : "no type";
    const std::optional<MessageCoding> coding = CodingOf(encoding);
    channels_[id] = {AddTopic(topic, coding ? type : fmt::format("{} ({})", type, encoding),
                              coding.value_or(MessageCoding::kCdr)),
                     coding.has_value()};
  } else if (kind == McapRecord::kMessage) {
    const auto channel = channels_.find(reader.Get<uint16_t>());
    reader.Require(channel != channels_.end(), "is a message of a channel that was not declared");
    reader.Get<uint32_t>();
    const auto logged = static_cast<int64_t>(reader.Get<uint64_t>());
    reader.Get<uint64_t>();
    ++topics_[channel->second.topic].messages;
    if (channel->second.is_read) {
      visit({channel->second.topic,
             logged,
             {place.chunk, place.offset + kMessageHead, place.size - kMessageHead},
             content.substr(kMessageHead)});
    }
  }
}

void McapBag::TakeChunk(uint64_t position, std::string_view record,
                        const std::function<void(const BagMessage& message)>& visit) {
  const std::string chunk = LoadChunk(position, record);
  expansion_.Add(chunk.size());
  const std::string_view records = chunk;
  for (size_t at = 0; at < records.size();) {
    ByteReader reader(records.substr(at), Place(position));
    const RecordHead head = ReadRecordHead(reader.GetRaw(kRecordHead));
    const std::string_view content = reader.GetRaw(head.length);
    at += kRecordHead;
    Take(head.kind, content, {position, at, head.length}, visit);
    at += head.length;
  }
}

void McapBag::Scan(const std::function<void(const BagMessage& message)>& visit) {
  uint64_t at = kMcapMagic.size();
  while (true) {
    const std::string start = file_.Read(at, kRecordHead);
    const RecordHead head = start.size() == kRecordHead ? ReadRecordHead(start) : RecordHead{};
    const uint64_t position = at + kRecordHead;
    if (start.size() < kRecordHead || head.length > file_.size() - position) {
      WarnOfMissingEnd(file_, at);
      return;
    }
    if (head.kind == McapRecord::kDataEnd || head.kind == McapRecord::kFooter) {
      break;
    }
    const bool is_chunk = head.kind == McapRecord::kChunk;
    if (is_chunk || head.kind == McapRecord::kSchema || head.kind == McapRecord::kChannel ||
        head.kind == McapRecord::kMessage) {
      if (head.length > kMostBagBytes) {
        throw InputError(fmt::format("{} has {} bytes, expected at most {}", Place(at), head.length,
                                     kMostBagBytes));
      }
      const std::string content = file_.Read(position, head.length);
      if (is_chunk) {
        TakeChunk(position, content, visit);
      } else {
        Take(head.kind, content, {kNoChunk, position, head.length}, visit);
      }
    }
    at = position + head.length;
  }
  if (file_.Read(file_.size() - kMcapMagic.size(), kMcapMagic.size()) != kMcapMagic) {
    warnings_.push_back(file_.path().string() +
                        ": has no index at its end, because it is cut off; all messages are there");
  }
}

std::string McapBag::Read(const MessagePosition& place) {
  if (place.chunk == kNoChunk) {
    return file_.Read(place.offset, place.size);
  }
  const std::string& chunk = chunks_.Get(place.chunk, [&] {
    // The length of the record stands before its content.
    const std::string start = file_.Read(place.chunk - kRecordHead, kRecordHead);
    return LoadChunk(place.chunk, file_.Read(place.chunk, ReadRecordHead(start).length));
  });
  return chunk.substr(place.offset, place.size);
}

}  // namespace hullslam
