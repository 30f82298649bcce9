// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_map.h"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/node/parse.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/read_file.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostFileBytes = 1'000'000;

// The position of a colon that ends a key, which is the first word of `line`, and is followed by
// the value without a blank; npos if there is none.
size_t ColonWithoutBlank(std::string_view line) {
  const size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const auto* const end = std::find_if(line.begin() + begin, line.end(), [](char c) {
    return !IsDigit(c) && !IsLetter(c) && c != '.' && c != '_';
  });
  const size_t colon = static_cast<size_t>(end - line.begin());
  const bool has_value = colon > begin && colon + 1 < line.size() && line[colon] == ':' &&
                         std::string_view(" \t\r").find(line[colon + 1]) == std::string_view::npos;
  return has_value ? colon : std::string_view::npos;
}

// The text as YAML. "%YAML:1.0" is no directive of YAML, so it becomes a comment. Lines keep their
// numbers. The end of the last line is left out, because yaml-cpp 0.7 takes it for the end of a
// text whose closing quote is missing.
std::string ToYaml(std::string_view text) {
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  std::string yaml;
  yaml.reserve(text.size() + 100);
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string_view line = text.substr(begin, end - begin);
    const size_t colon = ColonWithoutBlank(line);
    if (line.starts_with("%YAML")) {
      yaml += '#';
    }
    if (colon == std::string_view::npos) {
      yaml += line;
    } else {
      yaml.append(line.substr(0, colon + 1)).append(" ").append(line.substr(colon + 1));
    }
    begin = end;
  }
  return yaml;
}

std::string Origin(const fs::path& file, const YAML::Mark& mark) {
  return mark.is_null() ? file.string() : fmt::format("{}:{}", file.string(), mark.line + 1);
}

}  // namespace

YAML::Node ReadYaml(const fs::path& file) {
  const std::string text = ReadText(file, kMostFileBytes);
  if (text.find('\0') != std::string::npos) {
    throw InputError(file.string() + ": is not a text file with settings");
  }
  try {
    return YAML::Load(ToYaml(text));
  } catch (const YAML::DeepRecursion& error) {
    throw InputError(fmt::format("{}: is nested too deep, expected lines of 'key: value'",
                                 Origin(file, error.mark)));
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}: is not valid YAML: {}", Origin(file, error.mark), error.msg));
  }
}

std::string OriginOf(const fs::path& file, const YAML::Node& node) {
  return Origin(file, node.Mark());
}

std::optional<double> NumberOf(const YAML::Node& node) {
  double value = 0.0;
  const bool is_plain = node.IsScalar() && node.Tag() != "!";  // the tag of a text in quotes
  return is_plain && ParseFinite(node.Scalar(), value) ? std::optional(value) : std::nullopt;
}

YamlMap::YamlMap(fs::path file, std::string kind)
    : YamlMap(file, std::move(kind), ReadYaml(file)) {}

YamlMap::YamlMap(fs::path file, std::string kind, YAML::Node root)
    : file_(std::move(file)), kind_(std::move(kind)), node_(std::move(root)) {
  if (!node_.IsMap()) {
    throw InputError(fmt::format("{}: has no keys, expected {}", file_.string(), kind_));
  }
}

YamlMap::YamlMap(const YamlMap& parent, std::string_view key, YAML::Node node)
    : file_(parent.file_),
      kind_(parent.kind_),
      prefix_(fmt::format("{}{}.", parent.prefix_, key)),
      node_(std::move(node)) {}

void YamlMap::Fail(std::string_view key, std::string_view what) const {
  std::string origin = file_.string();
  for (const auto& pair : node_) {
    if (pair.first.IsScalar() && pair.first.Scalar() == key) {
      origin = OriginOf(file_, pair.first);
    }
  }
  throw InputError(fmt::format("{}: {}{} {}", origin, prefix_, key, what));
}

bool YamlMap::Has(std::string_view key) const {
  const YAML::Node node = std::as_const(node_)[std::string(key)];
  return node.IsDefined() && !node.IsNull();
}

YAML::Node YamlMap::Find(std::string_view key) const {
  if (!Has(key)) {
    Fail(key, fmt::format("is not given, expected {}", kind_));
  }
  return std::as_const(node_)[std::string(key)];
}

std::string YamlMap::Text(std::string_view key) const {
  const YAML::Node node = Find(key);
  if (!node.IsScalar()) {
    Fail(key, "has no single value, expected a name");
  }
  return node.Scalar();
}

double YamlMap::Number(std::string_view key) const { return Number(key, Find(key)); }

double YamlMap::Number(std::string_view key, const YAML::Node& node) const {
  constexpr double kMost = 1e9;
  const std::optional<double> value = NumberOf(node);
  if (!value || std::abs(*value) > kMost) {
    Fail(key, fmt::format("has a value that is not a number of reasonable size{}",
                          node.IsScalar() ? ": '" + ShowText(node.Scalar()) + "'" : ""));
  }
  return *value;
}

std::vector<double> YamlMap::Numbers(std::string_view key, size_t count,
                                     std::string_view names) const {
  const YAML::Node node = Find(key);
  if (!node.IsSequence() || node.size() != count) {
    Fail(key, fmt::format("has {} value(s), expected {} numbers: {}",
                          node.IsSequence() ? node.size() : 1, count, names));
  }
  return Numbers(key, node);
}

std::vector<double> YamlMap::Numbers(std::string_view key) const {
  const YAML::Node node = Find(key);
  if (!node.IsSequence()) {
    Fail(key, "is not a list of numbers");
  }
  return Numbers(key, node);
}

std::vector<double> YamlMap::Numbers(std::string_view key, const YAML::Node& list) const {
  std::vector<double> numbers;
  for (const YAML::Node& element : list) {
    numbers.push_back(Number(key, element));
  }
  return numbers;
}

std::vector<double> YamlMap::Matrix(std::string_view key, size_t count) const {
  constexpr std::string_view kNames = "a matrix by rows";
  const YAML::Node node = Find(key);
  if (node.IsMap()) {
    return Map(key).Numbers("data", count, kNames);
  }
  if (!node.IsSequence() || node.size() == 0 || !node[0].IsSequence()) {
    return Numbers(key, count, kNames);
  }
  std::vector<double> numbers;
  for (const YAML::Node& row : node) {
    const std::vector<double> of_row = Numbers(key, row);
    numbers.insert(numbers.end(), of_row.begin(), of_row.end());
  }
  if (numbers.size() != count) {
    Fail(key, fmt::format("has {} numbers, expected {}: {}", numbers.size(), count, kNames));
  }
  return numbers;
}

int YamlMap::Pixels(std::string_view key, double value) const {
  constexpr double kMost = 1e6;
  if (value != std::floor(value) || value < 1.0 || value > kMost) {
    Fail(key, fmt::format("has the value '{:g}', expected a number of pixels", value));
  }
  return static_cast<int>(value);
}

YamlMap YamlMap::Map(std::string_view key) const {
  const YAML::Node node = Find(key);
  if (!node.IsMap()) {
    Fail(key, "is not a map");
  }
  return {*this, key, node};
}

}  // namespace hullslam
