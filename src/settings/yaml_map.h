// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <yaml-cpp/node/node.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The first document of a YAML file. The first line `%YAML:1.0`, which OpenCV demands, is accepted
// and not needed, and a key at the begin of a line may lack the blank after its colon, as in the
// files of ORB-SLAM2. Throws InputError with file and line for a file that is not YAML, that has a
// byte 0, or that is larger than 1 MB.
YAML::Node ReadYaml(const std::filesystem::path& file);

// FILE:LINE of a node of the file.
std::string OriginOf(const std::filesystem::path& file, const YAML::Node& node);

// The finite number of a node; nothing if it is anything else, also a number in quotes.
std::optional<double> NumberOf(const YAML::Node& node);

// A map of a YAML file that holds a calibration. Each error names file, line and key.
class YamlMap {
 public:
  // The map at the top level of `file`. `kind` says in messages what the file should be, such as
  // "a sensor.yaml of EuRoC". Throws InputError if there is none.
  YamlMap(std::filesystem::path file, std::string kind);
  // The same for a file that was read already, since a pipe can be read only once.
  YamlMap(std::filesystem::path file, std::string kind, YAML::Node root);

  bool Has(std::string_view key) const;
  // These throw InputError if the key is not given or has another kind of value.
  std::string Text(std::string_view key) const;
  double Number(std::string_view key) const;
  // `names` says in messages what the numbers are.
  std::vector<double> Numbers(std::string_view key, size_t count, std::string_view names) const;
  std::vector<double> Numbers(std::string_view key) const;  // as many as there are
  int Pixels(std::string_view key, double value) const;     // a whole number from 1 to 1e6
  YamlMap Map(std::string_view key) const;

  // Throws InputError "FILE:LINE: KEY what".
  [[noreturn]] void Fail(std::string_view key, std::string_view what) const;

 private:
  YamlMap(const YamlMap& parent, std::string_view key, YAML::Node node);
  YAML::Node Find(std::string_view key) const;
  double Number(std::string_view key, const YAML::Node& node) const;
  std::vector<double> Numbers(std::string_view key, const YAML::Node& list) const;

  std::filesystem::path file_;
  std::string kind_;
  std::string prefix_ = {};  // the keys that lead to this map, for messages
  YAML::Node node_;
};

}  // namespace hullslam
