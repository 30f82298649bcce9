// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace hullslam {

// Reads and parses a JSON file. `callback`, if there is one, sees every parse event and decides
// which values are kept. Throws InputError with the name of the file if it cannot be read, has more
// than `most_bytes`, or is no valid JSON (with line and column).
nlohmann::json ReadJson(const std::filesystem::path& path,
                        size_t most_bytes = std::numeric_limits<size_t>::max(),
                        const nlohmann::json::parser_callback_t& callback = nullptr);

// A value as shown in messages: on one line, in ASCII, and shortened if it is long.
std::string ShowJson(const nlohmann::json& value);

}  // namespace hullslam
