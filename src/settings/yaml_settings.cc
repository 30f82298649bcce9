// SPDX-License-Identifier: GPL-3.0-or-later
#include "settings/yaml_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <string_view>

#include "files/read_text.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "settings/yaml_storage.h"
#include "util/shown_text.h"
#include "util/trim.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

// A `key: value` line as it is written in the file. OpenCV's nodes have no line numbers, do not
// notice repeated keys, and cannot represent integers above 32 bits.
struct WrittenValue {
  int line = 0;
  std::string text;
};
using WrittenValues = std::map<std::string, WrittenValue, std::less<>>;

std::string Origin(const fs::path& file, int line) {
  return fmt::format("{}:{}", file.string(), line);
}

bool HoldsKey(std::string_view line) {
  return !line.empty() && line[0] != ' ' && line[0] != '\t' && line[0] != '\r' && line[0] != '#' &&
         line[0] != '%' && line.find(':') != std::string_view::npos;
}

WrittenValues ScanLines(const fs::path& file, std::string_view text) {
  WrittenValues values;
  int number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (!HoldsKey(line)) {
      continue;
    }
    const size_t colon = line.find(':');
    const std::string key(Trim(line.substr(0, colon)));
    const std::string_view value = line.substr(colon + 1);
    const auto [it, is_new] = values.try_emplace(
        key, WrittenValue{number, std::string(Trim(value.substr(0, value.find('#'))))});
    if (!is_new) {
      throw InputError(fmt::format("{}: key '{}' was given before, in line {}",
                                   Origin(file, number), ShowText(key), it->second.line));
    }
  }
  return values;
}

// The text without comments. OpenCV's parser takes a comment after a text for a part of it. As in
// YAML, a comment begins after a blank or at the begin of a line. If there is a quote before it, it
// may be part of a text, so it stays. Lines keep their numbers.
std::string WithoutComments(std::string_view text) {
  std::string kept;
  kept.reserve(text.size());
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    size_t comment = line.find('#');
    while (comment != std::string_view::npos && comment > 0 && line[comment - 1] != ' ' &&
           line[comment - 1] != '\t') {
      comment = line.find('#', comment + 1);
    }
    const size_t quote = line.find_first_of("\"'");
    const std::string_view shown = comment < quote ? line.substr(0, comment) : line;
    kept += shown.substr(0, shown.find_last_not_of(" \t") + 1);
    kept += end < text.size() ? "\n" : "";
    begin = end + 1;
  }
  return kept;
}

constexpr std::string_view kHead = "%YAML:1.0\n";

// Whether a line names a camera, as those of all settings files do.
bool NamesCamera(std::string_view text) {
  return text.starts_with("Camera") || text.find("\nCamera") != std::string_view::npos;
}

// The text of a file without comments. OpenCV needs the line %YAML as the first one. People write
// comments before it or leave it out; then it is not in the text, which keeps its lines.
std::string ReadYamlText(const fs::path& file) {
  constexpr size_t kLargest = 1'000'000;
  const std::string whole = ReadText(file, kLargest);
  if (whole.find('\0') != std::string::npos) {
    throw InputError(file.string() + ": is not a text file with settings");
  }
  std::string text = WithoutComments(whole);
  if (text.starts_with("%YAML")) {
    return text;
  }
  const size_t begin = std::min(text.find_first_not_of("\r\n\t "), text.size());
  if (text.compare(begin, 5, "%YAML") == 0) {
    text.erase(begin, std::min(text.find('\n', begin), text.size()) - begin);
  } else if (!NamesCamera(text)) {
    throw InputError(Origin(file, 1) + ": expected a settings file with '%YAML:1.0' as first line");
  }
  return text;
}

// The text of a single value; see WrittenSetting.
std::string SingleText(const cv::FileNode& node, const WrittenValue& written) {
  if (node.isString()) {
    double value = 0.0;
    const std::string text = node.string();
    return ParseFinite(text, value) ? '"' + text + '"' : text;
  }
  double value = 0.0;
  const bool is_plain = ParseFinite(written.text, value);
  const bool is_whole = is_plain && std::abs(value) < 1e15 && value == std::trunc(value);
  const bool has_exponent_or_point = written.text.find_first_of(".eE") != std::string::npos;
  // OpenCV writes a whole number as "1000.".
  return is_whole && has_exponent_or_point ? fmt::format("{:.0f}", value) : written.text;
}

// The pairs of a map; nothing unless all its values are single.
std::optional<std::string> MapText(const cv::FileNode& map) {
  std::string text;
  for (const cv::FileNode& node : map) {
    if (!node.isString() && !node.isReal() && !node.isInt()) {
      return std::nullopt;
    }
    const std::string value = node.isString() ? node.string() : fmt::format("{}", node.real());
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", node.name(), value);
  }
  return text;
}

WrittenSetting ToSetting(const cv::FileNode& node, const WrittenValue& written,
                         const fs::path& file) {
  WrittenSetting setting{
      .key = node.name(), .name = node.name(), .origin = Origin(file, written.line)};
  // If the last key of a file has no value, OpenCV returns "...", the mark for the end of the file,
  // as its value.
  if (written.text.empty() && node.isString() && node.string() == "...") {
    setting.no_value = "empty";
  } else if (node.isMap() || node.isSeq()) {
    setting.no_value = node.isMap() ? "a map" : "a list";
    setting.pairs = node.isMap() ? MapText(node) : std::nullopt;
  } else {
    setting.text = SingleText(node, written);
  }
  return setting;
}

std::vector<WrittenSetting> CollectSettings(const fs::path& file, const std::string& text,
                                            const cv::FileNode& root) {
  if (!root.isMap()) {
    throw InputError(file.string() + ": has no settings, expected lines of 'key: value'");
  }
  const WrittenValues written = ScanLines(file, text);
  std::vector<WrittenSetting> settings;
  for (const cv::FileNode& node : root) {
    const auto it = written.find(node.name());
    if (it == written.end()) {
      throw InputError(fmt::format("{}: '{}' is not on a line of its own, expected 'key: value'",
                                   file.string(), ShowText(node.name())));
    }
    settings.push_back(ToSetting(node, it->second, file));
  }
  return settings;
}

}  // namespace

std::vector<WrittenSetting> ReadYamlSettings(const fs::path& file) {
  const std::string text = ReadYamlText(file);
  const bool has_head = text.starts_with("%YAML");
  const int added_lines = has_head ? 0 : 1;
  const cv::FileStorage storage =
      ParseYaml(file, has_head ? text : std::string(kHead) + text, added_lines);
  try {
    return CollectSettings(file, text, storage.root());
  } catch (const cv::Exception& error) {
    FailParsing(file, error, added_lines);
  }
}

const std::string& SingleValue(const WrittenSetting& setting) {
  if (!setting.no_value.empty()) {
    throw InputError(fmt::format("{}: {} is {}, expected a single value", setting.origin,
                                 ShowText(setting.name), setting.no_value));
  }
  return setting.text;
}

std::string TextOf(const WrittenSetting& setting, const OptionTable& table) {
  if (table.IsMap(setting.key) && setting.pairs) {
    return *setting.pairs;
  }
  return table.Contains(setting.key) ? SingleValue(setting) : std::string();
}

}  // namespace hullslam
