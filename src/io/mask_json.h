// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hullslam {

// An object of a JSON file, and where it is, so that messages can say so.
struct JsonRecord {
  const std::filesystem::path& path;
  std::string section;  // "annotations"; empty for a file that is a list
  size_t index = 0;     // in the list, from 0
  nlohmann::json value;

  // Throws InputError "FILE: annotations[17]: what".
  [[noreturn]] void Fail(const std::string& what) const;
};

// Visits the objects of a file that is a list of objects, or an object of such lists, in order and
// one at a time, so that memory is bounded by the largest. What is neither is passed over. Throws
// InputError for a file that is missing, no JSON (with line and column), beyond 512 MB, or with
// more than a million records, or two million values in one or outside of all.
void ForEachJsonRecord(const std::filesystem::path& path,
                       const std::function<void(const JsonRecord& record)>& visit);

// The document of a file of at most `most_bytes`; the same errors.
nlohmann::json ReadJson(const std::filesystem::path& path, size_t most_bytes);

// What a message can show of a value.
std::string ShowJson(const nlohmann::json& value);

// The member of a record; it fails where there is none.
const nlohmann::json& Member(const JsonRecord& record, const nlohmann::json& object,
                             const char* name);

// A list of numbers; it fails for anything else, with the name of what it is.
std::vector<double> Numbers(const JsonRecord& record, const nlohmann::json& list, const char* name);

// A member that is a confidence, from 0 to 1; 1 where there is none.
double ScoreOf(const JsonRecord& record, const nlohmann::json& object, const char* name);

}  // namespace hullslam
