// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <clocale>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// While it exists, this thread has the locale "C", whatever locale the program has. It is for calls
// of libraries that read numbers by the locale.
class ClassicLocale {
 public:
  ClassicLocale() : former_(::uselocale(Classic())) {}
  ~ClassicLocale() { ::uselocale(former_); }
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;

 private:
  static locale_t Classic() {
    static const locale_t classic = ::newlocale(LC_ALL_MASK, "C", locale_t{});
    return classic;
  }

  locale_t former_;
};

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

// A value in a JSON file that knows its path in the file. If a value is not as expected, InputError
// says "FILE: PATH is VALUE, expected ...". The file name and the value must outlive the node.
class JsonNode {
 public:
  JsonNode(const std::filesystem::path& file, const nlohmann::json& value)
      : file_(&file), value_(&value) {}

  // A member of an object. Throws InputError if it is missing.
  JsonNode At(const std::string& key) const;
  // Whether the object has this member and its value is not null.
  bool Has(const std::string& key) const;
  // The members of an object, sorted by key.
  std::vector<std::pair<std::string, JsonNode>> Members() const;
  std::vector<JsonNode> Elements() const;

  std::string Text() const;  // in printable characters
  bool Flag() const;
  double Number() const;                     // finite
  double Number(double most) const;          // from -most to most
  double PositiveNumber(double most) const;  // > 0, up to `most`
  uint32_t Count() const;                    // 0 to 2^32 - 2
  // An array of exactly `count` finite numbers. If `expected` is given, the error message describes
  // the array with this text instead.
  std::vector<double> Numbers(size_t count, std::string_view expected = {}) const;
  // An array of three numbers > 0, in metres.
  Eigen::Vector3d Lengths() const;
  // An array of points [x, y], in pixels.
  std::vector<Eigen::Vector2d> Points() const;

  [[noreturn]] void Fail(std::string_view expected) const;

 private:
  JsonNode(const JsonNode& parent, const nlohmann::json& value, std::string path)
      : file_(parent.file_), value_(&value), path_(std::move(path)) {}

  const std::filesystem::path* file_;
  const nlohmann::json* value_;
  std::string path_;  // such as objects[2].hull; empty at the top
};

}  // namespace hullslam
