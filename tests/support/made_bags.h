// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bags/decompress.h"
#include "bags/mcap_bag.h"
#include "bags/message_fields.h"
#include "files/bytes.h"

namespace hullslam {

// A message of a recording that a test makes.
struct MadeMessage {
  std::string topic;
  std::string type;   // as ROS 1 writes it: "sensor_msgs/Image"
  uint64_t time = 0;  // ns, at which it was recorded
  std::string bytes;
};

// Writes fields in either coding: CDR with CdrWriter, that of ROS 1 with ByteWriter.
class MadeFields {
 public:
  explicit MadeFields(MessageCoding coding) : is_cdr_(coding == MessageCoding::kCdr) {}

  template <typename Number>
  void Put(Number number) {
    is_cdr_ ? cdr_.Put(number) : ros1_.Put(number);
  }
  void PutText(std::string_view text) { is_cdr_ ? cdr_.PutText(text) : ros1_.PutText(text); }
  void PutBytes(std::string_view bytes) { is_cdr_ ? cdr_.PutBytes(bytes) : ros1_.PutText(bytes); }
  // `time` is in ns.
  void PutHeader(uint64_t time) {
    if (!is_cdr_) {
      ros1_.Put(uint32_t{7});
    }
    Put(static_cast<uint32_t>(time / 1'000'000'000));
    Put(static_cast<uint32_t>(time % 1'000'000'000));
    PutText("camera");
  }
  std::string Message() const { return is_cdr_ ? cdr_.Message() : ros1_.bytes(); }

 private:
  bool is_cdr_;
  CdrWriter cdr_;
  ByteWriter ros1_;
};

// A field of a message of protobuf: a text, a list of bytes or a message inside it.
inline std::string ProtobufField(int field, std::string_view bytes) {
  std::string written(1, static_cast<char>(field << 3 | 2));
  size_t size = bytes.size();
  for (; size > 127; size >>= 7U) {
    written += static_cast<char>((size & 127U) | 128U);
  }
  return written + static_cast<char>(size) + std::string(bytes);
}

// A field of protobuf with a number of a fixed size.
template <typename Number>
std::string ProtobufNumber(int field, Number number) {
  ByteWriter writer;
  writer.Put(static_cast<uint8_t>(field << 3 | (sizeof(Number) == 8 ? 1 : 5)));
  writer.Put(number);
  return writer.bytes();
}

// The field 1 of Foxglove's messages, a google.protobuf.Timestamp.
inline std::string ProtobufStamp(uint64_t time) {
  return ProtobufField(1, ProtobufNumber(1, static_cast<uint32_t>(time / 1'000'000'000)) +
                              ProtobufNumber(2, static_cast<uint32_t>(time % 1'000'000'000)));
}

// A sensor_msgs/Image whose rows have no gaps.
inline std::string MadeImage(MessageCoding coding, uint64_t time, std::string_view encoding,
                             uint32_t width, uint32_t height, std::string_view pixels) {
  MadeFields fields(coding);
  fields.PutHeader(time);
  fields.Put(height);
  fields.Put(width);
  fields.PutText(encoding);
  fields.Put(uint8_t{0});
  fields.Put(static_cast<uint32_t>(height == 0 ? 0 : pixels.size() / height));
  fields.PutBytes(pixels);
  return fields.Message();
}

// A sensor_msgs/CompressedImage.
inline std::string MadeCompressed(MessageCoding coding, uint64_t time, std::string_view format,
                                  std::string_view data) {
  MadeFields fields(coding);
  fields.PutHeader(time);
  fields.PutText(format);
  fields.PutBytes(data);
  return fields.Message();
}

// A sensor_msgs/CameraInfo with fx = fy = 300 and the principal point in the middle. It is
// rectified and, if `baseline` (m) is not 0, the right camera of a pair. The rectified images may
// have another focal length.
inline std::string MadeCameraInfo(MessageCoding coding, uint32_t width, uint32_t height,
                                  std::string_view model = "plumb_bob",
                                  const std::vector<double>& distortion = {0, 0, 0, 0, 0},
                                  double focal_length = 300.0, double baseline = 0.0,
                                  std::optional<double> rectified_focal_length = std::nullopt) {
  const double projected = rectified_focal_length.value_or(focal_length);
  MadeFields fields(coding);
  fields.PutHeader(0);
  fields.Put(height);
  fields.Put(width);
  fields.PutText(model);
  fields.Put(static_cast<uint32_t>(distortion.size()));
  for (const double number : distortion) {
    fields.Put(number);
  }
  for (const double number : {focal_length, 0.0, 0.5 * (width - 1), 0.0, focal_length,
                              0.5 * (height - 1), 0.0, 0.0, 1.0}) {
    fields.Put(number);
  }
  for (const double number : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
    fields.Put(number);
  }
  for (const double number : {projected, 0.0, 0.5 * (width - 1), -baseline * projected, 0.0,
                              projected, 0.5 * (height - 1), 0.0, 0.0, 0.0, 1.0, 0.0}) {
    fields.Put(number);
  }
  return fields.Message();
}

inline std::string Compressed(const std::string& name, const std::string& bytes) {
  std::string packed(2 * bytes.size() + 4096, '\0');
  if (name == "lz4") {
    packed.resize(
        LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
    return packed;
  }
  if (name == "bz2") {
    auto size = static_cast<unsigned int>(packed.size());
    std::string input = bytes;
    BZ2_bzBuffToBuffCompress(packed.data(), &size, input.data(),
                             static_cast<unsigned int>(input.size()), 1, 0, 0);
    packed.resize(size);
    return packed;
  }
  return name == "zstd" ? CompressZstd(bytes) : bytes;
}

inline std::string McapRecordBytes(McapRecord kind, std::string_view content) {
  ByteWriter record;
  record.Put(static_cast<uint8_t>(kind));
  record.Put(uint64_t{content.size()});
  record.PutRaw(content);
  return record.bytes();
}

// The record of a chunk. The size that it claims can be another one than the true one.
inline std::string McapChunkBytes(const std::string& compression, const std::string& records,
                                  uint64_t claimed_size, uint32_t checksum = 0) {
  const std::string packed = Compressed(compression, records);
  ByteWriter chunk;
  chunk.Put(uint64_t{0});
  chunk.Put(uint64_t{0});
  chunk.Put(claimed_size);
  chunk.Put(checksum);
  chunk.PutText(compression == "none" ? "" : compression);
  chunk.Put(uint64_t{packed.size()});
  chunk.PutRaw(packed);
  return McapRecordBytes(McapRecord::kChunk, chunk.bytes());
}

// A file of MCAP without an index. "": no chunks; otherwise one chunk for each message, "none",
// "lz4" or "zstd".
inline std::string MadeMcap(const std::vector<MadeMessage>& messages,
                            const std::string& compression = "",
                            const std::string& encoding = "cdr") {
  std::string file(kMcapMagic);
  std::map<std::string, uint16_t> topics;
  for (const MadeMessage& message : messages) {
    std::string records;
    if (!topics.contains(message.topic)) {
      const auto id = static_cast<uint16_t>(topics.size() + 5);
      topics[message.topic] = id;
      ByteWriter schema;
      schema.Put(id);
      std::string type = message.type;
      if (encoding == "cdr") {
        type.insert(type.find('/'), "/msg");
      }
      schema.PutText(type);
      schema.PutText("ros2msg");
      schema.PutText("");
      ByteWriter channel;
      channel.Put(id);
      channel.Put(id);
      channel.PutText(message.topic);
      channel.PutText(encoding);
      channel.PutCount(0);
      records += McapRecordBytes(McapRecord::kSchema, schema.bytes()) +
                 McapRecordBytes(McapRecord::kChannel, channel.bytes());
    }
    ByteWriter content;
    content.Put(topics[message.topic]);
    content.Put(uint32_t{0});
    content.Put(message.time);
    content.Put(message.time);
    content.PutRaw(message.bytes);
    records += McapRecordBytes(McapRecord::kMessage, content.bytes());
    file += compression.empty() ? records : McapChunkBytes(compression, records, records.size());
  }
  return file + McapRecordBytes(McapRecord::kDataEnd, std::string(4, '\0')) +
         McapRecordBytes(McapRecord::kFooter, std::string(20, '\0')) + std::string(kMcapMagic);
}

inline std::string Ros1RecordBytes(const std::map<std::string, std::string>& fields,
                                   std::string_view data) {
  ByteWriter header;
  for (const auto& [name, value] : fields) {
    header.PutText(name + "=" + value);
  }
  ByteWriter record;
  record.PutText(header.bytes());
  record.PutText(data);
  return record.bytes();
}

template <typename Number>
std::string BytesOfNumber(Number number) {
  ByteWriter writer;
  writer.Put(number);
  return writer.bytes();
}

// A bag of ROS 1 with one chunk for each message: "none", "bz2" or "lz4"; "": no chunks.
inline std::string MadeRos1(const std::vector<MadeMessage>& messages,
                            const std::string& compression = "none") {
  std::string file = "#ROSBAG V2.0\n" + Ros1RecordBytes({{"op", "\x03"}}, std::string(100, ' '));
  std::map<std::string, uint32_t> connections;
  for (const MadeMessage& message : messages) {
    std::string records;
    if (!connections.contains(message.topic)) {
      const auto id = static_cast<uint32_t>(connections.size() + 3);
      connections[message.topic] = id;
      ByteWriter connection;
      connection.PutText("type=" + message.type);
      records +=
          Ros1RecordBytes({{"op", "\x07"}, {"conn", BytesOfNumber(id)}, {"topic", message.topic}},
                          connection.bytes());
    }
    const std::string time = BytesOfNumber(static_cast<uint32_t>(message.time / 1'000'000'000)) +
                             BytesOfNumber(static_cast<uint32_t>(message.time % 1'000'000'000));
    records += Ros1RecordBytes(
        {{"op", "\x02"}, {"conn", BytesOfNumber(connections[message.topic])}, {"time", time}},
        message.bytes);
    file += compression.empty()
                ? records
                : Ros1RecordBytes({{"op", "\x05"},
                                   {"compression", compression},
                                   {"size", BytesOfNumber(static_cast<uint32_t>(records.size()))}},
                                  Compressed(compression, records));
  }
  return file;
}

// Writes a file of rosbag2. With "zstd", each message is compressed by itself.
inline std::filesystem::path WriteMadeSqlite(const std::filesystem::path& path,
                                             const std::vector<MadeMessage>& messages,
                                             const std::string& compression = "none") {
  std::filesystem::remove(path);
  sqlite3* database = nullptr;
  const auto run = [&](const std::string& text, const std::string& blob = "") {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database, text.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
      throw std::runtime_error(sqlite3_errmsg(database));
    }
    if (sqlite3_bind_parameter_count(statement) > 0) {
      sqlite3_bind_blob(statement, 1, blob.data(), static_cast<int>(blob.size()), nullptr);
    }
    sqlite3_step(statement);
    sqlite3_finalize(statement);
  };
  sqlite3_open(path.c_str(), &database);
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format "
      "TEXT)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data "
      "BLOB)");
  std::map<std::string, size_t> topics;
  for (const MadeMessage& message : messages) {
    if (!topics.contains(message.topic)) {
      const size_t id = topics.size() + 1;
      topics[message.topic] = id;
      std::string type = message.type;
      type.insert(type.find('/'), "/msg");
      run("INSERT INTO topics VALUES (" + std::to_string(id) + ", '" + message.topic + "', '" +
          type + "', 'cdr')");
    }
    run("INSERT INTO messages(topic_id, timestamp, data) VALUES (" +
            std::to_string(topics[message.topic]) + ", " + std::to_string(message.time) + ", ?)",
        Compressed(compression, message.bytes));
  }
  sqlite3_close(database);
  return path;
}

}  // namespace hullslam
