// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "files/bytes.h"

namespace hullslam {

// How the fields of a message become bytes.
enum class MessageCoding {
  kCdr,       // ROS 2: CDR of OMG's RTPS, numbers aligned to their size, in either order of bytes
  kRos1,      // ROS 1: little-endian, without gaps
  kProtobuf,  // messages of Foxglove; ProtobufReader reads them
};

// Reads the fields of a message of ROS (kCdr or kRos1) one after the other. All functions throw
// InputError that begins with `name` if the bytes end too early.
class FieldReader {
 public:
  // `bytes` must outlive the reader. CDR begins with four bytes that tell its kind; throws
  // InputError for any other kind than plain CDR.
  FieldReader(MessageCoding coding, std::string_view bytes, std::string name);

  MessageCoding coding() const { return coding_; }

  template <typename Number>
  Number Get() {
    static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
    if (coding_ == MessageCoding::kCdr) {
      Take((sizeof(Number) - position_ % sizeof(Number)) % sizeof(Number));
    }
    std::array<char, sizeof(Number)> number{};
    const std::string_view taken = Take(number.size());
    std::copy(taken.begin(), taken.end(), number.begin());
    if (is_big_endian_ != (std::endian::native == std::endian::big)) {
      std::reverse(number.begin(), number.end());
    }
    return std::bit_cast<Number>(number);
  }
  // A text, without the zero byte at its end that CDR has.
  std::string_view GetText();
  // A list of bytes.
  std::string_view GetBytes();
  // The number of elements that follow, each of at least `bytes_each` bytes. Throws if fewer bytes
  // are left, so that it is safe to allocate memory for them.
  size_t GetCount(size_t bytes_each);

  [[noreturn]] void Fail(const std::string& fault) const;

 private:
  std::string_view Take(size_t count);

  MessageCoding coding_;
  std::string_view bytes_;  // those that were not read yet
  std::string name_;
  size_t position_ = 0;  // after the four bytes of CDR
  bool is_big_endian_ = false;
};

// Writes the fields of a message of ROS 2 one after the other, as little-endian CDR. FieldReader
// reads them.
class CdrWriter {
 public:
  template <typename Number>
  void Put(Number number) {
    while (fields_.bytes().size() % sizeof(Number) != 0) {
      fields_.Put(uint8_t{0});
    }
    fields_.Put(number);
  }
  void PutCount(size_t count) { Put(static_cast<uint32_t>(count)); }
  void PutText(std::string_view text) {
    PutCount(text.size() + 1);
    fields_.PutRaw(text);
    Put(uint8_t{0});
  }
  void PutBytes(std::string_view bytes) {
    PutCount(bytes.size());
    fields_.PutRaw(bytes);
  }

  // The whole message: the four bytes that say "little-endian CDR", then the fields.
  std::string Message() const { return std::string("\0\1\0\0", 4) + fields_.bytes(); }

 private:
  ByteWriter fields_;
};

}  // namespace hullslam
