// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace hullslam {

// Goes through the fields of a message in protobuf's wire format
// (https://protobuf.dev/programming-guides/encoding). All functions throw InputError that begins
// with `name` if the bytes end too early or are none of this format.
class ProtobufReader {
 public:
  // `bytes` must outlive the reader.
  ProtobufReader(std::string_view bytes, std::string name);

  // Goes to the next field; false behind the last one.
  bool Next();
  uint64_t field() const { return field_; }
  // The value of a field that is a number; 0 for other fields.
  uint64_t number() const { return number_; }
  // The value of a field that is a text, a message or a packed list; empty for other fields.
  std::string_view bytes() const { return value_; }
  bool has_bytes() const { return has_bytes_; }  // the field is of these

 private:
  std::string_view Take(uint64_t count);
  uint64_t TakeVarint();
  uint64_t TakeFixed(size_t size);

  std::string_view left_;
  std::string name_;
  uint64_t field_ = 0;
  uint64_t number_ = 0;
  bool has_bytes_ = false;
  std::string_view value_;
};

}  // namespace hullslam
