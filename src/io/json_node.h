// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "hullslam/geometry/rigid3.h"

namespace hullslam {

// The content of a JSON file. Throws InputError with the file's name where it cannot be read or is
// no JSON.
nlohmann::json ReadJson(const std::filesystem::path& path);

// A value of a JSON file that knows its place in it. What is not as expected throws InputError
// "FILE: PLACE is VALUE, expected ...". File and value must outlive the node.
class JsonNode {
 public:
  JsonNode(const std::filesystem::path& file, const nlohmann::json& value)
      : file_(&file), value_(&value) {}

  // A member of an object; it must be there.
  JsonNode At(const std::string& key) const;
  // Whether the object has this member, and not as null.
  bool Has(const std::string& key) const;
  // The members of an object in the order of their keys, the values of an array in theirs.
  std::vector<std::pair<std::string, JsonNode>> Members() const;
  std::vector<JsonNode> Elements() const;

  std::string Text() const;
  bool Flag() const;
  double Number() const;          // finite
  double PositiveNumber() const;  // finite, > 0
  uint32_t Count() const;         // 0 to 2^32 - 2
  // An array of just so many finite numbers.
  std::vector<double> Numbers(size_t count) const;
  // An array of points [x, y].
  std::vector<Eigen::Vector2d> Points() const;
  // [tx, ty, tz, qx, qy, qz, qw]; the rotation is normalised.
  Rigid3 Pose() const;

  [[noreturn]] void Fail(std::string_view expected) const;

 private:
  JsonNode(const JsonNode& parent, const nlohmann::json& value, std::string place)
      : file_(parent.file_), value_(&value), place_(std::move(place)) {}

  const std::filesystem::path* file_;
  const nlohmann::json* value_;
  std::string place_;  // as objects[2].hull; empty at the top
};

}  // namespace hullslam
