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

// An interval of allowed numbers. Its lower end may be excluded.
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

// The options of a run, by the names that they have in settings files. Each struct of options binds
// its fields here, with range and description. The reader of settings files, --set, the list of
// settings and the error for an unknown key all use this table. The fields must outlive the table.
class OptionTable {
 public:
  void Add(std::string key, double* field, Range range, std::string help);
  void Add(std::string key, int* field, Range range, std::string help);
  void Add(std::string key, uint64_t* field, Range range, std::string help);
  void Add(std::string key, bool* field, std::string help);  // accepts 0, 1, true, false
  void Add(std::string key, std::string* field, std::vector<std::string> choices, std::string help);
  // An enum that is set by name: `names[i]` is the enumerator with value i.
  template <typename Enum>
  void AddEnum(const std::string& key, Enum* field, const std::vector<std::string>& names,
               const std::string& help) {
    AddChoice(
        key, names, [field](size_t index) { *field = static_cast<Enum>(index); },
        [field] { return static_cast<size_t>(*field); }, help);
  }
  // Numbers by name: `name:number` pairs that are separated by commas.
  void Add(std::string key, std::map<std::string, double>* field, Range range, std::string help);
  // A key that sets several other keys at once. They must be bound before, with the same type and
  // value. The last key that is set wins, whether it is this one or one of the others.
  void AddShared(std::string key, std::vector<std::string> members, std::string help);
  // Any text.
  void AddText(std::string key, std::string* field, std::string help);
  // A key of other programs' settings files that has no meaning here: it is accepted and ignored.
  void AddIgnored(std::string key);

  bool Contains(std::string_view key) const;
  // Whether the option is one of numbers by name.
  bool IsMap(std::string_view key) const;
  // Sets an option from text. Throws InputError that starts with `origin` (a file name or "--set")
  // and names the key, the value and what was expected. For an unknown key the message suggests the
  // most similar known key.
  void Set(const std::string& key, const std::string& value, const std::string& origin);

  struct Entry {
    std::string key;
    std::string value;     // the current value
    std::string expected;  // "a number > 0", "an integer >= 1", "one of: a, b"
    std::string help;
    bool is_shared = false;  // sets other keys (AddShared) and has no value of its own
  };
  // All options but the ignored, sorted by key. The value of a shared one is that of its first
  // member.
  std::vector<Entry> Entries() const;

 private:
  struct Option {
    std::function<bool(const std::string&)> parse;  // false if the text is no valid value
    std::function<std::string()> print;
    std::string expected;
    std::string help;
    bool ignored = false;
    bool shared = false;
    bool is_map = false;
  };
  void AddOption(std::string key, Option option);
  void AddChoice(std::string key, std::vector<std::string> names, std::function<void(size_t)> set,
                 std::function<size_t()> get, std::string help);
  template <typename Number>
  void AddNumber(std::string key, Number* field, Range range, std::string help);

  std::map<std::string, Option, std::less<>> options_;
};

}  // namespace hullslam
