// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace hullslam {

// Limits for a JSON file.
struct JsonLimits {
  size_t most_bytes = 128'000'000;
  size_t most_values = 20'000'000;
  int most_depth = 32;  // how deep lists and objects may be nested
};

// Reads and parses a JSON file. `callback`, if there is one, sees every parse event and decides
// which values are kept. Throws InputError with the name of the file if it cannot be read, exceeds
// a limit, or is no valid JSON (with line and column).
nlohmann::json ReadJson(const std::filesystem::path& path, const JsonLimits& limits = {},
                        const nlohmann::json::parser_callback_t& callback = nullptr);

// A value as shown in messages: on one line, in ASCII, and shortened if it is long.
std::string ShowJson(const nlohmann::json& value);

}  // namespace hullslam
