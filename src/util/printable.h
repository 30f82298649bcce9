// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace hullslam {

// The text in valid UTF-8 and without characters that control a terminal or a text file: '?' stands
// for control characters, of characters that change the direction of writing or end a
// line, and of bytes that are not UTF-8. The characters in `kept`, such as "\n", stay as they are.
std::string Printable(std::string_view text, std::string_view kept = {});

// Whether all bytes of the text are valid UTF-8.
bool IsUtf8(std::string_view text);

}  // namespace hullslam
