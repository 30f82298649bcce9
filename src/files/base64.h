// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace hullslam {

// The bytes in base64 with padding (RFC 4648, section 4).
std::string EncodeBase64(std::string_view bytes);

// The bytes of such a text; blanks and ends of lines in it are skipped, and the padding may be
// missing. Nothing for any other text.
std::optional<std::string> DecodeBase64(std::string_view text);

// The length of EncodeBase64() of so many bytes.
constexpr size_t Base64Size(size_t bytes) { return (bytes + 2) / 3 * 4; }

}  // namespace hullslam
