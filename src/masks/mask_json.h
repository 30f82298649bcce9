// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
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

// Visits all records of a file: the objects in its list or, if the file is an object, in the lists
// that are its members. The records are parsed one at a time, in order, so the memory is bounded by
// the largest one. Everything else is skipped. Throws InputError for a file that is missing, no
// valid JSON (with line and column), larger than 512 MB, or has more than a million objects, or
// more than two million values in one object or outside of all objects.
void ForEachJsonRecord(const std::filesystem::path& path,
                       const std::function<void(const JsonRecord& record)>& visit);

// A member of an object. Calls record.Fail() if it is missing.
const nlohmann::json& Member(const JsonRecord& record, const nlohmann::json& object,
                             const char* name);

// Reads a list of numbers. Calls record.Fail() with `name` if the value is anything else.
std::vector<double> Numbers(const JsonRecord& record, const nlohmann::json& list, const char* name);

// The confidence of an object, from 0 to 1, in any of the members that tools use for it: "score",
// "detection_score", "confidence", "conf", "probability". It is 1 if there is none, or if it is
// null. Calls record.Fail() for any other value. As some tools write numbers as text, "0.9" is 0.9.
double ScoreOf(const JsonRecord& record, const nlohmann::json& object);

// The name of the class of an object in any of the members that tools use for it: "label", "class",
// "class_name", "category_name", "category". Nothing if there is none that is a text.
std::optional<std::string> ClassNameOf(const nlohmann::json& object);

}  // namespace hullslam
