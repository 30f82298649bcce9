// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/mcap_writer.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "bags/decompress.h"

namespace hullslam {
namespace {

constexpr size_t kChunkBytes = 1'000'000;  // a chunk that is longer is ended

std::string Record(McapRecord kind, std::string_view content) {
  ByteWriter record;
  record.Put(static_cast<uint8_t>(kind));
  record.Put(uint64_t{content.size()});
  record.PutRaw(content);
  return record.bytes();
}

uint32_t ChecksumOf(std::string_view bytes) {
  return static_cast<uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path, const std::string& library)
    : file_(path) {
  Put(kMcapMagic);
  ByteWriter header;
  header.PutText("ros2");
  header.PutText(library);
  PutRecord(McapRecord::kHeader, header.bytes());
}

void McapWriter::Put(std::string_view bytes) {
  file_.Write(bytes);
  position_ += bytes.size();
}

void McapWriter::PutRecord(McapRecord kind, std::string_view content) {
  Put(Record(kind, content));
}

uint16_t McapWriter::AddTopic(const std::string& name, const std::string& type,
                              const std::string& schema) {
  const auto id = static_cast<uint16_t>(topics_.size() + 1);
  ByteWriter of_schema;
  of_schema.Put(id);
  of_schema.PutText(type);
  of_schema.PutText("ros2msg");
  of_schema.PutText(schema);
  ByteWriter of_channel;
  of_channel.Put(id);
  of_channel.Put(id);  // the schema's id
  of_channel.PutText(name);
  of_channel.PutText("cdr");
  of_channel.PutCount(0);  // no metadata
  topics_.push_back({of_schema.bytes(), of_channel.bytes()});
  chunk_.PutRaw(Record(McapRecord::kSchema, of_schema.bytes()));
  chunk_.PutRaw(Record(McapRecord::kChannel, of_channel.bytes()));
  return id;
}

void McapWriter::Write(uint16_t topic, uint64_t time, std::string_view message) {
  uint64_t& count = topics_.at(topic - 1U).messages;
  chunk_messages_[topic].emplace_back(time, chunk_.bytes().size());
  ByteWriter content;
  content.Put(topic);
  content.Put(static_cast<uint32_t>(count++));
  content.Put(time);  // at which it was recorded
  content.Put(time);  // at which it was published
  content.PutRaw(message);
  chunk_.PutRaw(Record(McapRecord::kMessage, content.bytes()));
  if (chunk_.bytes().size() > kChunkBytes) {
    EndChunk();
  }
}

void McapWriter::EndChunk() {
  ChunkIndex index{.start_time = std::numeric_limits<uint64_t>::max(), .position = position_};
  for (const auto& [topic, messages] : chunk_messages_) {
    for (const auto& [time, offset] : messages) {
      index.start_time = std::min(index.start_time, time);
      index.end_time = std::max(index.end_time, time);
    }
  }
  index.start_time = std::min(index.start_time, index.end_time);  // a chunk without messages
  index.size = chunk_.bytes().size();
  const std::string compressed = CompressZstd(chunk_.bytes());
  index.compressed_size = compressed.size();
  ByteWriter content;
  content.Put(index.start_time);
  content.Put(index.end_time);
  content.Put(index.size);
  content.Put(ChecksumOf(chunk_.bytes()));
  content.PutText("zstd");
  content.Put(index.compressed_size);
  content.PutRaw(compressed);
  PutRecord(McapRecord::kChunk, content.bytes());
  index.length = position_ - index.position;
  const uint64_t indices_position = position_;
  for (const auto& [topic, messages] : chunk_messages_) {
    index.message_indices.emplace_back(topic, position_);
    ByteWriter of_topic;
    of_topic.Put(topic);
    of_topic.PutCount(16 * messages.size());  // bytes
    for (const auto& [time, offset] : messages) {
      of_topic.Put(time);
      of_topic.Put(offset);
    }
    PutRecord(McapRecord::kMessageIndex, of_topic.bytes());
  }
  index.message_indices_length = position_ - indices_position;
  chunks_.push_back(std::move(index));
  chunk_.Clear();
  chunk_messages_.clear();
}

std::string McapWriter::Statistics() const {
  uint64_t messages = 0;
  uint64_t start = std::numeric_limits<uint64_t>::max();
  uint64_t end = 0;
  for (const Topic& topic : topics_) {
    messages += topic.messages;
  }
  for (const ChunkIndex& chunk : chunks_) {
    if (!chunk.message_indices.empty()) {
      start = std::min(start, chunk.start_time);
      end = std::max(end, chunk.end_time);
    }
  }
  ByteWriter content;
  content.Put(messages);
  content.Put(static_cast<uint16_t>(topics_.size()));  // schemas
  content.PutCount(topics_.size());
  content.PutCount(0);  // attachments
  content.PutCount(0);  // metadata
  content.PutCount(chunks_.size());
  content.Put(std::min(start, end));
  content.Put(end);
  content.PutCount(10 * topics_.size());  // bytes
  for (size_t i = 0; i < topics_.size(); ++i) {
    content.Put(static_cast<uint16_t>(i + 1));
    content.Put(topics_[i].messages);
  }
  return Record(McapRecord::kStatistics, content.bytes());
}

std::string McapWriter::Summary() const {
  ByteWriter records;
  ByteWriter offsets;
  const auto end_group = [&](McapRecord kind, uint64_t begin) {
    ByteWriter offset;
    offset.Put(static_cast<uint8_t>(kind));
    offset.Put(position_ + begin);
    offset.Put(uint64_t{records.bytes().size()} - begin);
    offsets.PutRaw(Record(McapRecord::kSummaryOffset, offset.bytes()));
    return uint64_t{records.bytes().size()};
  };
  for (const Topic& topic : topics_) {
    records.PutRaw(Record(McapRecord::kSchema, topic.schema_record));
  }
  uint64_t begin = end_group(McapRecord::kSchema, 0);
  for (const Topic& topic : topics_) {
    records.PutRaw(Record(McapRecord::kChannel, topic.channel_record));
  }
  begin = end_group(McapRecord::kChannel, begin);
  records.PutRaw(Statistics());
  begin = end_group(McapRecord::kStatistics, begin);
  for (const ChunkIndex& chunk : chunks_) {
    ByteWriter content;
    content.Put(chunk.start_time);
    content.Put(chunk.end_time);
    content.Put(chunk.position);
    content.Put(chunk.length);
    content.PutCount(10 * chunk.message_indices.size());  // bytes
    for (const auto& [topic, position] : chunk.message_indices) {
      content.Put(topic);
      content.Put(position);
    }
    content.Put(chunk.message_indices_length);
    content.PutText("zstd");
    content.Put(chunk.compressed_size);
    content.Put(chunk.size);
    records.PutRaw(Record(McapRecord::kChunkIndex, content.bytes()));
  }
  end_group(McapRecord::kChunkIndex, begin);
  // The footer: where the records and where the offsets of their groups begin, and a checksum.
  ByteWriter footer;
  footer.Put(static_cast<uint8_t>(McapRecord::kFooter));
  footer.Put(uint64_t{20});
  footer.Put(position_);
  footer.Put(position_ + records.bytes().size());
  std::string summary = records.bytes() + offsets.bytes() + footer.bytes();
  ByteWriter checksum;
  checksum.Put(ChecksumOf(summary));
  return summary + checksum.bytes();
}

void McapWriter::Close() {
  EndChunk();
  ByteWriter data_end;
  data_end.Put(uint32_t{0});  // no checksum of the data section; the chunks have their own
  PutRecord(McapRecord::kDataEnd, data_end.bytes());
  Put(Summary());
  Put(kMcapMagic);
  file_.Commit();
}

}  // namespace hullslam
