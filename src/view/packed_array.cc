// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/packed_array.h"

#include <bit>
#include <string>

#include "files/base64.h"

namespace hullslam {
namespace {

void AppendWord(std::string& bytes, uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>(word >> shift & 0xffu);
  }
}

}  // namespace

nlohmann::json PackArray(std::span<const float> values) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) {
    AppendWord(bytes, std::bit_cast<uint32_t>(value));
  }
  return {{"f32", EncodeBase64(bytes)}};
}

nlohmann::json PackArray(std::span<const uint32_t> values) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const uint32_t value : values) {
    AppendWord(bytes, value);
  }
  return {{"u32", EncodeBase64(bytes)}};
}

nlohmann::json PackArray(std::span<const uint8_t> values) {
  return {{"u8", EncodeBase64(std::string(values.begin(), values.end()))}};
}

}  // namespace hullslam
