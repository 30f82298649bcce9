// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace hullslam {

// The functions of <cctype> ask the locale, which a program of a user may set: in a locale of
// Latin-1 they take bytes of UTF-8 for letters and blanks. These know ASCII only.

constexpr bool IsDigit(char c) { return c >= '0' && c <= '9'; }

constexpr bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

constexpr bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

constexpr bool IsControl(char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; }

}  // namespace hullslam
