// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hullslam {

// Closed or open interval of allowed numbers.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;

  static Range Positive() { return {.low = 0.0, .low_open = true}; }
  static Range AtLeast(double low) { return {.low = low}; }
  static Range Between(double low, double high) { return {.low = low, .high = high}; }
  static Range Any() { return {}; }
  bool Contains(double value) const;
  std::string ToString() const;  // "> 0", ">= 1", "from 0 to 1", "of any size"
};

// The options of a run by their names in settings files. A struct of options binds its fields here
// once, with range and description; from this table come the reader, --set, the list of settings
// and the error for an unknown key. The fields must outlive the table.
class OptionTable {
 public:
  void Add(std::string key, double* field, Range range, std::string help);
  void Add(std::string key, int* field, Range range, std::string help);
  void Add(std::string key, uint64_t* field, Range range, std::string help);
  void Add(std::string key, bool* field, std::string help);  // 0, 1, true, false
  void Add(std::string key, std::string* field, std::vector<std::string> choices, std::string help);
  // An enum by the names of its enumerators, which count from 0 in the order of `names`.
  template <typename Enum>
  void AddEnum(const std::string& key, Enum* field, const std::vector<std::string>& names,
               const std::string& help) {
    AddChoice(
        key, names, [field](size_t index) { *field = static_cast<Enum>(index); },
        [field] { return static_cast<size_t>(*field); }, help);
  }
  // A key that sets several others at once, all bound before with the same type and value. What is
  // set later wins, be it this key or one of the others.
  void AddShared(std::string key, std::vector<std::string> members, std::string help);
  // Any text.
  void AddText(std::string key, std::string* field, std::string help);
  // A key that other programs' settings files have and that means nothing here: accepted, ignored.
  void AddIgnored(std::string key);

  bool Contains(std::string_view key) const;
  // Throws InputError that names key, value and what was expected; `origin` (a file, "--set") goes
  // in front. An unknown key is told with the nearest known one.
  void Set(const std::string& key, const std::string& value, const std::string& origin);

  struct Entry {
    std::string key;
    std::string value;     // as it is now
    std::string expected;  // "a number > 0", "an integer >= 1", "one of: a, b"
    std::string help;
    bool is_shared = false;  // sets other keys (AddShared) and has no value of its own
  };
  // All options but the ignored, sorted by key. The value of a shared one is that of its first
  // member.
  std::vector<Entry> Entries() const;

 private:
  struct Option {
    std::function<bool(const std::string&)> parse;  // false where the text does not fit
    std::function<std::string()> print;
    std::string expected;
    std::string help;
    bool ignored = false;
    bool shared = false;
  };
  void AddOption(std::string key, Option option);
  void AddChoice(std::string key, std::vector<std::string> names, std::function<void(size_t)> set,
                 std::function<size_t()> get, std::string help);
  template <typename Number>
  void AddNumber(std::string key, Number* field, Range range, std::string help);

  std::map<std::string, Option, std::less<>> options_;
};

}  // namespace hullslam
