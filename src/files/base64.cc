// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/base64.h"

#include <algorithm>
#include <cstdint>

#include "util/text.h"

namespace hullslam {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr size_t kDigitsOfThreeBytes = 4;

}  // namespace

std::string EncodeBase64(std::string_view bytes) {
  std::string text;
  text.reserve(Base64Size(bytes.size()));
  for (size_t at = 0; at < bytes.size(); at += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - at);
    uint32_t bits = 0;
    for (size_t i = 0; i < 3; ++i) {
      bits = bits << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0u);
    }
    // Three bytes give four digits; one byte gives two digits, and two bytes give three.
    for (size_t digit = 0; digit < 4; ++digit) {
      text += digit <= count ? kDigits[bits >> (18 - 6 * digit) & 63u] : '=';
    }
  }
  return text;
}

std::optional<std::string> DecodeBase64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / kDigitsOfThreeBytes * 3);
  uint32_t bits = 0;
  size_t digits = 0;
  size_t padding = 0;
  for (const char c : text) {
    const size_t digit = kDigits.find(c);
    if (IsBlank(c)) {
      continue;
    }
    padding += c == '=' ? 1 : 0;
    if ((digit == std::string_view::npos && c != '=') || (padding > 0 && c != '=')) {
      return std::nullopt;
    }
    if (c != '=') {
      bits = bits << 6 | static_cast<uint32_t>(digit);
      // Each digit but the first of four completes a byte.
      if (const size_t rest = ++digits % kDigitsOfThreeBytes; rest != 1) {
        bytes += static_cast<char>(bits >> (rest == 0 ? 0 : 8 - 2 * rest) & 255u);
      }
    }
  }
  const size_t rest = digits % kDigitsOfThreeBytes;
  const bool is_whole =
      rest != 1 && (padding == 0 || (rest > 0 && rest + padding == kDigitsOfThreeBytes));
  return is_whole ? std::optional(bytes) : std::nullopt;
}

}  // namespace hullslam
