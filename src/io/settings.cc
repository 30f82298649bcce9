// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/io/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "hullslam/util/error.h"
#include "io/read_file.h"
#include "io/settings_orb_slam3.h"
#include "io/text_rows.h"
#include "io/yaml_nesting.h"
#include "util/shown_text.h"

namespace hullslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kIntrinsics = {"Camera.fx", "Camera.fy", "Camera.cx", "Camera.cy"};
constexpr std::string_view kBlanks = " \t\r";

// A `key: value` line as it is written in the file. OpenCV's nodes have no line numbers, do not
// notice repeated keys, and cannot represent integers above 32 bits.
struct WrittenValue {
  int line = 0;
  std::string text;
};
using WrittenValues = std::map<std::string, WrittenValue, std::less<>>;

std::string Place(const fs::path& file, int line) {
  return fmt::format("{}:{}", file.string(), line);
}

std::string_view Trim(std::string_view text) {
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

bool HoldsKey(std::string_view line) {
  return !line.empty() && kBlanks.find(line[0]) == std::string_view::npos && line[0] != '#' &&
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
      throw InputError(fmt::format("{}: key '{}' was given before, in line {}", Place(file, number),
                                   ShowText(key), it->second.line));
    }
  }
  return values;
}

// A byte order mark, which editors on Windows add, is accepted.
std::string ReadYamlText(const fs::path& file) {
  constexpr size_t kLargest = 1'000'000;
  std::string text = ReadFile(file, kLargest);
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.erase(0, 3);
  }
  if (!text.starts_with("%YAML")) {
    throw InputError(Place(file, 1) + ": expected a settings file with '%YAML:1.0' as first line");
  }
  if (text.find('\0') != std::string::npos) {
    throw InputError(file.string() + ": is not a text file with settings");
  }
  return text;
}

// OpenCV's parser puts "(line): message" into the field for the name of the function.
[[noreturn]] void FailParsing(const fs::path& file, const cv::Exception& error) {
  int line = 0;
  char reason[200] = "is not valid YAML";
  if (std::sscanf(error.func.c_str(), "(%d): %199[^\n]", &line, reason) >= 1) {
    throw InputError(Place(file, line) + ": " + reason);
  }
  throw InputError(file.string() + ": is not valid YAML");
}

cv::FileStorage ParseYaml(const fs::path& file, const std::string& text) {
  try {
    return cv::FileStorage(
        text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  } catch (const cv::Exception& error) {
    FailParsing(file, error);
  }
}

// The text for OptionTable::Set(). A quoted number keeps its quotes, so that it is not accepted as
// a number.
std::string ScalarText(const cv::FileNode& node, const WrittenValue& written,
                       const std::string& place) {
  if (node.isInt() || node.isReal()) {
    double value = 0.0;
    const bool is_plain = ParseFinite(written.text, value);
    const bool is_whole = is_plain && std::abs(value) < 1e15 && value == std::trunc(value);
    const bool has_exponent_or_point = written.text.find_first_of(".eE") != std::string::npos;
    // OpenCV writes a whole number as "1000.".
    return is_whole && has_exponent_or_point ? fmt::format("{:.0f}", value) : written.text;
  }
  if (node.isString()) {
    double value = 0.0;
    const std::string text = node.string();
    return ParseFinite(text, value) ? '"' + text + '"' : text;
  }
  throw InputError(fmt::format("{}: {} is {}, expected a single value", place,
                               ShowText(node.name()),
                               node.isMap()   ? "a map"
                               : node.isSeq() ? "a list"
                                              : "empty"));
}

// Applies the nodes of a settings file, of ORB-SLAM2 or ORB-SLAM3, to the table.
class NodeReader {
 public:
  NodeReader(const fs::path& file, const WrittenValues& written, OptionTable& table,
             std::set<std::string>& given)
      : file_(file), written_(written), table_(table), given_(given) {}

  void Apply(const cv::FileNode& root) {
    for (const cv::FileNode& node : root) {
      const std::string key = node.name();
      const auto it = written_.find(key);
      if (it == written_.end()) {
        throw InputError(fmt::format("{}: '{}' is not on a line of its own, expected 'key: value'",
                                     file_.string(), ShowText(key)));
      }
      const std::string place = Place(file_, it->second.line);
      if (const auto setting = FindOrb3Setting(key)) {
        ApplyOrb3(*setting, key, node, it->second, place);
        continue;
      }
      if (!table_.Contains(key)) {
        table_.Set(key, "", place);  // throws and suggests the most similar known key
      }
      Set(key, ScalarText(node, it->second, place), place, key);
    }
    ApplyBaseline();
    CheckSizes();
    CheckRectified();
  }

 private:
  // A setting of ORB-SLAM3 whose value can only be used when all settings are known.
  struct Waiting {
    std::string name;
    std::string key;
    double value = 0.0;
    std::string place;
  };

  // `name` is the name of the setting in the file.
  void Set(const std::string& key, const std::string& value, const std::string& place,
           const std::string& name) {
    if (!given_.insert(key).second) {
      throw InputError(fmt::format("{}: {} was given before under another name", place, name));
    }
    table_.Set(key, value, name == key ? place : fmt::format("{}: {}", place, name));
  }

  void ApplyOrb3(const Orb3Setting& setting, const std::string& name, const cv::FileNode& node,
                 const WrittenValue& written, const std::string& place) {
    switch (setting.kind) {
      case Orb3Setting::Kind::kIgnored:
        return;
      case Orb3Setting::Kind::kRefused:
        throw InputError(
            fmt::format("{}: {} of ORB-SLAM3 cannot be translated: {}", place, name, setting.why));
      case Orb3Setting::Kind::kVersion:
        ExpectText(node, name, written, {"1.0"}, place, "");
        return;
      case Orb3Setting::Kind::kModel:
        ExpectText(node, name, written, {"PinHole", "Rectified"}, place,
                   "; HullSLAM has no other camera model");
        is_rectified_ = node.string() == "Rectified";
        return;
      case Orb3Setting::Kind::kRenamed:
        Set(setting.key, ScalarText(node, written, place), place, name);
        return;
      case Orb3Setting::Kind::kBaseline:
        baseline_ = {name, "Camera.bf", Number(node, written, name, place), place};
        return;
      case Orb3Setting::Kind::kSize:
        sizes_.push_back({name, setting.key, Number(node, written, name, place), place});
        return;
    }
  }

  static void ExpectText(const cv::FileNode& node, const std::string& name,
                         const WrittenValue& written, const std::vector<std::string>& choices,
                         const std::string& place, const char* reason) {
    const std::string text = node.isString() ? node.string() : written.text;
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
      throw InputError(fmt::format("{}: {} is '{}', expected \"{}\"{}", place, name, text,
                                   fmt::join(choices, "\" or \""), reason));
    }
  }

  static double Number(const cv::FileNode& node, const WrittenValue& written,
                       const std::string& name, const std::string& place) {
    const std::string text = ScalarText(node, written, place);
    double value = 0.0;
    if (!ParseFinite(text, value) || value <= 0.0) {
      throw InputError(fmt::format("{}: {} is '{}', expected a number > 0", place, name, text));
    }
    return value;
  }

  double Value(const std::string& key) const {
    for (const OptionTable::Entry& entry : table_.Entries()) {
      if (entry.key == key) {
        return std::stod(entry.value);
      }
    }
    return 0.0;
  }

  // Without Camera.fx the file is refused later.
  void ApplyBaseline() {
    if (baseline_ && given_.contains("Camera.fx")) {
      Set("Camera.bf", fmt::format("{}", baseline_->value * Value("Camera.fx")), baseline_->place,
          baseline_->name);
    }
  }

  void CheckSizes() const {
    for (const Waiting& size : sizes_) {
      if (size.value != Value(size.key)) {
        throw InputError(
            fmt::format("{}: {} is '{}', expected {}, '{}': HullSLAM does not resize images",
                        size.place, size.name, size.value, size.key, Value(size.key)));
      }
    }
  }

  void CheckRectified() const {
    for (const char* const key :
         {"Camera.k1", "Camera.k2", "Camera.p1", "Camera.p2", "Camera.k3"}) {
      if (is_rectified_ && Value(key) != 0.0) {
        throw InputError(fmt::format("{}: {} is '{}', expected 0 with Camera.type \"Rectified\"",
                                     file_.string(), key, Value(key)));
      }
    }
  }

  const fs::path& file_;
  const WrittenValues& written_;
  OptionTable& table_;
  std::set<std::string>& given_;
  std::optional<Waiting> baseline_;
  std::vector<Waiting> sizes_;
  bool is_rectified_ = false;
};

void ApplyFile(const fs::path& file, OptionTable& table, std::set<std::string>& given) {
  const std::string text = ReadYamlText(file);
  CheckYamlNesting(file, text);
  const cv::FileStorage storage = ParseYaml(file, text);
  try {
    const cv::FileNode root = storage.root();
    if (!root.isMap()) {
      throw InputError(file.string() + ": has no settings, expected lines of 'key: value'");
    }
    const WrittenValues written = ScanLines(file, text);
    NodeReader(file, written, table, given).Apply(root);
  } catch (const cv::Exception& error) {
    FailParsing(file, error);
  }
}

void ApplyOverrides(std::span<const std::string> overrides, OptionTable& table,
                    std::set<std::string>& given) {
  for (const std::string_view assignment : overrides) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw InputError(fmt::format("--set: '{}', expected key=value", ShowText(assignment)));
    }
    const std::string key(Trim(assignment.substr(0, equals)));
    table.Set(key, std::string(Trim(assignment.substr(equals + 1))), "--set");
    given.insert(key);
  }
}

// The number of the TUM camera in a name, such as "rgbd_dataset_freiburg1_xyz" or "fr1_desk"; 0 if
// there is none.
int TumCamera(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view mark : {"freiburg", "fr"}) {
    const size_t at = name.find(mark);
    const size_t digit = at + mark.size();
    const bool begins_word = at == 0 || (at != std::string::npos && !std::isalnum(name[at - 1]));
    const bool is_camera =
        begins_word && digit < name.size() && name[digit] >= '1' && name[digit] <= '3';
    if (is_camera && (digit + 1 == name.size() || !std::isdigit(name[digit + 1]))) {
      return name[digit] - '0';
    }
  }
  return 0;
}

std::string FolderName(const fs::path& folder) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(folder, error);
  const fs::path& path = error ? folder : absolute;
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace

SystemOptions ReadSettings(const fs::path& file, std::span<const std::string> overrides) {
  SystemOptions options;
  OptionTable table = options.Bind();
  std::set<std::string> given;
  ApplyFile(file, table, given);
  ApplyOverrides(overrides, table, given);
  for (const char* const key : kIntrinsics) {
    if (!given.contains(key)) {
      throw InputError(file.string() + ": " + key +
                       " is not given, expected the intrinsics of the camera in px");
    }
  }
  options.Validate();
  return options;
}

fs::path FindDefaultSettings(const fs::path& sequence, const fs::path& config_folder) {
  std::error_code error;
  fs::path own = sequence / "camera.yaml";
  if (fs::exists(own, error)) {
    return own;
  }
  const std::string name = FolderName(sequence);
  const int camera = TumCamera(name);
  if (camera == 0) {
    throw InputError(
        fmt::format("{}: the name '{}' does not contain a known camera and there is no "
                    "camera.yaml in the folder, expected --settings FILE",
                    sequence.string(), name));
  }
  return config_folder / fmt::format("TUM{}.yaml", camera);
}

fs::path FindConfigFolder() {
  std::error_code error;
  // Nothing in this library changes the environment, so reading it is safe.
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* const chosen = std::getenv("HULLSLAM_CONFIG");
  if (chosen != nullptr && *chosen != '\0') {
    if (!fs::is_directory(chosen, error)) {
      throw InputError(std::string("HULLSLAM_CONFIG: '") + chosen + "' is not a folder");
    }
    return chosen;
  }
  for (const char* const folder : {HULLSLAM_INSTALLED_CONFIG, HULLSLAM_SOURCE_CONFIG}) {
    if (fs::is_directory(folder, error)) {
      return folder;
    }
  }
  throw InputError(
      fmt::format("neither {} nor {} is a folder, expected the settings of known "
                  "cameras there; set HULLSLAM_CONFIG or give --settings FILE",
                  HULLSLAM_INSTALLED_CONFIG, HULLSLAM_SOURCE_CONFIG));
}

std::string FormatSettings(SystemOptions options) {
  std::string text = "%YAML:1.0\n";
  for (const OptionTable::Entry& entry : options.Bind().Entries()) {
    if (!entry.is_shared) {
      text += entry.key + ": " + entry.value + '\n';
    }
  }
  return text;
}

std::string HashSettings(const SystemOptions& options) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : FormatSettings(options)) {
    hash = (hash ^ byte) * 0x100000001b3;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace hullslam
