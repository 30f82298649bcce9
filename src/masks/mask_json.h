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

// An object in a JSON file and its position there, for messages.
struct JsonRecord {
  const std::filesystem::path& path;
  std::string section;  // such as "annotations"; empty if the file is a list
  size_t index = 0;     // in the list, from 0
  nlohmann::json value;

  // Throws InputError "FILE: annotations[17]: what".
  [[noreturn]] void Fail(const std::string& what) const;
};

// Visits the objects in a file that is a list of objects, or an object whose members are such
// lists. They are visited in order and one at a time, so that the memory is bounded by the largest
// object. Everything else is skipped. Throws InputError for a file that is missing, no valid JSON
// (with line and column), larger than 512 MB, or has more than a million objects, or more than two
// million values in one object or outside of all objects.
void ForEachJsonRecord(const std::filesystem::path& path,
                       const std::function<void(const JsonRecord& record)>& visit);

// A member of an object; record.Fail() if it is missing.
const nlohmann::json& Member(const JsonRecord& record, const nlohmann::json& object,
                             const char* name);

// A list of numbers; for anything else record.Fail() with `name`.
std::vector<double> Numbers(const JsonRecord& record, const nlohmann::json& list, const char* name);

// A member that is a confidence from 0 to 1; 1 if the member is missing.
double ScoreOf(const JsonRecord& record, const nlohmann::json& object, const char* name);

}  // namespace hullslam
