// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/bytes.h"

namespace hullslam {

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
