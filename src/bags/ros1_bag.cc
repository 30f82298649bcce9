// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/ros1_bag.h"

#include <fmt/format.h>

#include <algorithm>

#include "files/bytes.h"
#include "hullslam/util/error.h"

namespace hullslam {
namespace {

// The kinds of records, which the field `op` of their headers tells.
constexpr uint8_t kMessageOp = 0x02;
constexpr uint8_t kChunkOp = 0x05;
constexpr uint8_t kConnectionOp = 0x07;
constexpr size_t kMostHeaderBytes = 1'000'000;

}  // namespace

std::string Ros1Bag::Place(uint64_t position) const {
  return fmt::format("{}: the record at byte {}", file_.path().string(), position);
}

Ros1Bag::Fields Ros1Bag::ParseFields(std::string_view header, uint64_t position) const {
  Fields fields;
  ByteReader reader(header, Place(position));
  while (reader.left() > 0) {
    const std::string field = reader.GetText();
    const size_t at = field.find('=');
    reader.Require(at != std::string::npos, "has a field without a '='");
    fields[field.substr(0, at)] = field.substr(at + 1);
  }
  return fields;
}

template <typename Number>
Number Ros1Bag::NumberOf(const Fields& fields, std::string_view name, uint64_t position) const {
  const auto found = fields.find(name);
  if (found == fields.end() || found->second.size() != sizeof(Number)) {
    throw InputError(
        fmt::format("{} has no field '{}' of {} bytes", Place(position), name, sizeof(Number)));
  }
  return ByteReader(found->second, Place(position)).Get<Number>();
}

bool Ros1Bag::ReadRecord(uint64_t position, Record& record) const {
  const auto read_length = [&](uint64_t at, uint32_t& length) {
    const std::string bytes = file_.Read(at, sizeof(length));
    if (bytes.size() < sizeof(length)) {
      return false;
    }
    length = ByteReader(bytes, Place(position)).Get<uint32_t>();
    return true;
  };
  uint32_t header_size = 0;
  if (!read_length(position, header_size)) {
    return false;
  }
  if (header_size > kMostHeaderBytes) {
    throw InputError(fmt::format("{} has a header of {} bytes, expected at most {}",
                                 Place(position), header_size, kMostHeaderBytes));
  }
  const std::string header = file_.Read(position + 4, header_size);
  uint32_t size = 0;
  if (header.size() < header_size || !read_length(position + 4 + header_size, size)) {
    return false;
  }
  record = {ParseFields(header, position), position + 8 + header_size, size};
  return true;
}

std::string Ros1Bag::LoadChunk(const Record& record) const {
  const std::string place = Place(record.position);
  const auto size = NumberOf<uint32_t>(record.fields, "size", record.position);
  const auto name = record.fields.find("compression");
  const Compression compression =
      ParseCompression(name == record.fields.end() ? "" : name->second, place);
  if (size > kMostBagBytes || record.size > kMostBagBytes) {
    throw InputError(fmt::format("{} is a chunk of {} bytes, expected at most {}", place,
                                 std::max<uint64_t>(size, record.size), kMostBagBytes));
  }
  std::string content =
      Decompress(compression, file_.Read(record.position, record.size), size, place);
  if (content.size() != size) {
    throw InputError(
        fmt::format("{} is a chunk of {} bytes, but has {}", place, size, content.size()));
  }
  return content;
}

void Ros1Bag::TakeConnection(const Fields& fields, std::string_view data, uint64_t position) {
  const Fields connection = ParseFields(data, position);
  const auto topic = fields.find("topic");
  const auto type = connection.find("type");
  topics_of_connections_[NumberOf<uint32_t>(fields, "conn", position)] =
      AddTopic(topic == fields.end() ? "" : topic->second,
               type == connection.end() ? "no type" : type->second, MessageCoding::kRos1);
}

void Ros1Bag::TakeMessage(const Fields& fields, std::string_view data, const MessagePosition& place,
                          const std::function<void(const BagMessage& message)>& visit) {
  const uint64_t position = place.chunk == kNoChunk ? place.offset : place.chunk;
  const auto topic = topics_of_connections_.find(NumberOf<uint32_t>(fields, "conn", position));
  if (topic == topics_of_connections_.end()) {
    throw InputError(Place(position) +
                     " is a message of a connection that was not declared before it");
  }
  const auto time = NumberOf<uint64_t>(fields, "time", position);  // seconds, then nanoseconds
  const auto seconds = static_cast<int64_t>(time & 0xffffffffU);
  ++topics_[topic->second].messages;
  visit({topic->second, seconds * 1'000'000'000 + static_cast<int64_t>(time >> 32U), place, data});
}

void Ros1Bag::TakeChunk(const Record& record, const std::function<void(const BagMessage&)>& visit) {
  const std::string chunk = LoadChunk(record);
  expansion_.Add(chunk.size());
  chunk_records_[record.position] = record;
  ByteReader reader(chunk, Place(record.position));
  while (reader.left() > 0) {
    const Fields fields = ParseFields(reader.GetRaw(reader.GetCount(1)), record.position);
    const size_t size = reader.GetCount(1);
    const MessagePosition place{record.position, chunk.size() - reader.left(), size};
    const std::string_view data = reader.GetRaw(size);
    const auto kind = NumberOf<uint8_t>(fields, "op", record.position);
    if (kind == kConnectionOp) {
      TakeConnection(fields, data, record.position);
    } else if (kind == kMessageOp) {
      TakeMessage(fields, data, place, visit);
    }
  }
}

void Ros1Bag::Scan(const std::function<void(const BagMessage& message)>& visit) {
  Record record;
  for (uint64_t at = kRos1Magic.size(); at < file_.size(); at = record.position + record.size) {
    if (!ReadRecord(at, record) || record.size > file_.size() - record.position) {
      WarnOfMissingEnd(file_, at);
      return;
    }
    const auto kind = NumberOf<uint8_t>(record.fields, "op", at);
    if (kind == kChunkOp) {
      TakeChunk(record, visit);
    } else if (kind == kConnectionOp || kind == kMessageOp) {
      if (record.size > kMostBagBytes) {
        throw InputError(fmt::format("{} has {} bytes, expected at most {}", Place(at), record.size,
                                     kMostBagBytes));
      }
      const std::string data = file_.Read(record.position, record.size);
      if (kind == kConnectionOp) {
        TakeConnection(record.fields, data, at);
      } else {
        TakeMessage(record.fields, data, {kNoChunk, record.position, record.size}, visit);
      }
    }
  }
}

std::string Ros1Bag::Read(const MessagePosition& place) {
  if (place.chunk == kNoChunk) {
    return file_.Read(place.offset, place.size);
  }
  const std::string& chunk =
      chunks_.Get(place.chunk, [&] { return LoadChunk(chunk_records_.at(place.chunk)); });
  return chunk.substr(place.offset, place.size);
}

}  // namespace hullslam
