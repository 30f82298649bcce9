// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "files/json_file.h"
#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// Rounds `value` to a multiple of `unit` (1 over a power of ten). Never returns -0. Throws
// CheckError for a value that is not finite.
double Rounded(double value, double unit);

// The value in JSON; null if it is absent.
template <typename Value>
nlohmann::ordered_json OrNull(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

// The JSON on one line. Labels come from the files of users and may contain any bytes; what is not
// UTF-8 is replaced.
std::string DumpLine(const nlohmann::ordered_json& json);

// The members of `head`, and then a list with the given name whose entries are each on a line of
// their own.
std::string WithEntries(const nlohmann::ordered_json& head, const char* name,
                        const std::vector<std::string>& entries);

// Reads a pose from an array [tx, ty, tz, qx, qy, qz, qw], in metres, and normalises the rotation.
// Throws InputError that names the file and the value if the node is no such array.
Rigid3 PoseOf(const JsonNode& node);

}  // namespace hullslam
