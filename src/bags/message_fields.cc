// SPDX-License-Identifier: GPL-3.0-or-later
#include "bags/message_fields.h"

#include <fmt/format.h>

#include <utility>

#include "hullslam/util/error.h"

namespace hullslam {

FieldReader::FieldReader(MessageCoding coding, std::string_view bytes, std::string name)
    : coding_(coding), bytes_(bytes), name_(std::move(name)) {
  if (coding_ != MessageCoding::kCdr) {
    return;
  }
  const std::string_view kind = Take(4);
  position_ = 0;
  if (kind[0] != 0 || (kind[1] != 0 && kind[1] != 1)) {
    Fail(fmt::format("has the representation {:02x}{:02x}, expected plain CDR (0000 or 0001)",
                     static_cast<unsigned char>(kind[0]), static_cast<unsigned char>(kind[1])));
  }
  is_big_endian_ = kind[1] == 0;
}

std::string_view FieldReader::Take(size_t count) {
  if (count > bytes_.size()) {
    Fail("is cut off");
  }
  const std::string_view taken = bytes_.substr(0, count);
  bytes_.remove_prefix(count);
  position_ += count;
  return taken;
}

size_t FieldReader::GetCount(size_t bytes_each) {
  const size_t count = Get<uint32_t>();
  if (count > bytes_.size() / bytes_each) {
    Fail("has more elements than bytes");
  }
  return count;
}

std::string_view FieldReader::GetBytes() { return Take(GetCount(1)); }

std::string_view FieldReader::GetText() {
  std::string_view text = GetBytes();
  if (coding_ == MessageCoding::kCdr && text.ends_with('\0')) {
    text.remove_suffix(1);
  }
  return text;
}

void FieldReader::Fail(const std::string& fault) const { throw InputError(name_ + ' ' + fault); }

}  // namespace hullslam
