// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/protobuf_reader.h"

#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {

ProtobufReader::ProtobufReader(std::string_view bytes, std::string name)
    : left_(bytes), name_(std::move(name)) {}

std::string_view ProtobufReader::Take(uint64_t count) {
  if (count > left_.size()) {
    throw InputError(name_ + " is cut off");
  }
  const std::string_view taken = left_.substr(0, count);
  left_.remove_prefix(count);
  return taken;
}

// Seven bits a byte, the lowest first; the highest bit says that more bytes follow.
uint64_t ProtobufReader::TakeVarint() {
  uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = static_cast<unsigned char>(Take(1)[0]);
    value |= uint64_t{byte & 0x7fU} << shift;
    if (byte < 0x80) {
      return value;
    }
  }
  throw InputError(name_ + " has a number of more than ten bytes, expected a message of protobuf");
}

uint64_t ProtobufReader::TakeFixed(size_t size) {
  const std::string_view bytes = Take(size);
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) {
    value |= uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  }
  return value;
}

bool ProtobufReader::Next() {
  if (left_.empty()) {
    return false;
  }
  const uint64_t key = TakeVarint();
  field_ = key >> 3U;
  number_ = 0;
  has_bytes_ = (key & 7U) == 2;
  value_ = {};
  switch (key & 7U) {
    case 0:
      number_ = TakeVarint();
      return true;
    case 1:
      number_ = TakeFixed(8);
      return true;
    case 2:
      value_ = Take(TakeVarint());
      return true;
    case 5:
      number_ = TakeFixed(4);
      return true;
    default:
      throw InputError(name_ + " has a field of no known kind, expected a message of protobuf");
  }
}

}  // namespace hullslam
