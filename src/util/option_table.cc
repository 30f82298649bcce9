// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/option_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "hullslam/util/check.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

template <typename Number>
std::optional<Number> ParseNumber(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

template <typename Number>
std::string PrintNumber(Number value) {
  char buffer[64];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

std::optional<bool> ParseBool(std::string_view text) {
  if (text == "1" || text == "true") {
    return true;
  }
  if (text == "0" || text == "false") {
    return false;
  }
  return std::nullopt;
}

std::optional<std::map<std::string, double>> ParseMap(std::string_view text, const Range& range) {
  std::map<std::string, double> numbers;
  while (!Trim(text).empty()) {
    const std::string_view pair = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    const size_t colon = pair.find(':');
    const std::string name(Trim(pair.substr(0, colon)));
    const auto number = colon == std::string_view::npos
                            ? std::nullopt
                            : ParseNumber<double>(Trim(pair.substr(colon + 1)));
    if (name.empty() || !number || !range.Contains(*number) ||
        !numbers.emplace(name, *number).second) {
      return std::nullopt;
    }
  }
  return numbers;
}

std::string PrintMap(const std::map<std::string, double>& numbers) {
  std::string text;
  for (const auto& [name, number] : numbers) {
    text += (text.empty() ? "" : ",") + name + ":" + PrintNumber(number);
  }
  return text;
}

std::string Join(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) {
    joined += (joined.empty() ? "" : ", ") + word;
  }
  return joined;
}

}  // namespace

bool Range::Contains(double value) const {
  return std::isfinite(value) && (low_open ? value > low : value >= low) && value <= high;
}

std::string Range::ToString() const {
  if (std::isinf(low) && std::isinf(high)) {
    return "of any size";
  }
  if (std::isinf(high)) {
    return (low_open ? "> " : ">= ") + PrintNumber(low);
  }
  return (low_open ? "above " : "from ") + PrintNumber(low) + " to " + PrintNumber(high);
}

void OptionTable::AddOption(std::string key, Option option) {
  const bool inserted = options_.emplace(std::move(key), std::move(option)).second;
  Check(inserted, "an option is bound twice");
}

// The arguments are moved, but clang-tidy does not see this in a template.
template <typename Number>
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void OptionTable::AddNumber(std::string key, std::vector<Number*> fields, Range range,
                            // NOLINTNEXTLINE(performance-unnecessary-value-param)
                            std::string help) {
  const char* const kind = std::is_integral_v<Number> ? "an integer " : "a number ";
  const auto parse = [fields, range](const std::string& text) {
    const auto value = ParseNumber<Number>(text);
    if (!value || !range.Contains(static_cast<double>(*value))) {
      return false;
    }
    for (Number* const field : fields) {
      *field = *value;
    }
    return true;
  };
  AddOption(std::move(key), {.parse = parse,
                             .print = [field = fields.front()] { return PrintNumber(*field); },
                             .expected = kind + range.ToString(),
                             .help = std::move(help)});
}

void OptionTable::Add(std::string key, double* field, Range range, std::string help) {
  AddNumber<double>(std::move(key), {field}, range, std::move(help));
}

void OptionTable::Add(std::string key, std::vector<double*> fields, Range range, std::string help) {
  const bool are_equal = std::all_of(
      fields.begin(), fields.end(), [&](const double* field) { return *field == *fields.front(); });
  Check(!fields.empty() && are_equal, "an option is bound to fields with different defaults");
  AddNumber<double>(std::move(key), std::move(fields), range, std::move(help));
}

void OptionTable::Add(std::string key, int* field, Range range, std::string help) {
  AddNumber<int>(std::move(key), {field}, range, std::move(help));
}

void OptionTable::Add(std::string key, uint64_t* field, Range range, std::string help) {
  AddNumber<uint64_t>(std::move(key), {field}, range, std::move(help));
}

void OptionTable::Add(std::string key, bool* field, std::string help) {
  AddOption(std::move(key), {.parse =
                                 [field](const std::string& text) {
                                   const auto value = ParseBool(text);
                                   if (value) *field = *value;
                                   return value.has_value();
                                 },
                             .print = [field] { return std::string(*field ? "true" : "false"); },
                             .expected = "true or false (1 or 0)",
                             .help = std::move(help)});
}

void OptionTable::Add(std::string key, std::map<std::string, double>* field, Range range,
                      std::string help) {
  AddOption(std::move(key),
            {.parse =
                 [field, range](const std::string& text) {
                   auto numbers = ParseMap(text, range);
                   const bool good = numbers.has_value();
                   if (good) *field = std::move(*numbers);
                   return good;
                 },
             .print = [field] { return PrintMap(*field); },
             .expected = "name:number pairs, separated by commas, each number " + range.ToString(),
             .help = std::move(help),
             .is_map = true});
}

void OptionTable::Add(std::string key, std::string* field, std::vector<std::string> choices,
                      std::string help) {
  std::string expected = "one of: " + Join(choices);
  AddOption(std::move(key), {.parse =
                                 [field, choices = std::move(choices)](const std::string& text) {
                                   const bool good = std::find(choices.begin(), choices.end(),
                                                               text) != choices.end();
                                   if (good) *field = text;
                                   return good;
                                 },
                             .print = [field] { return *field; },
                             .expected = std::move(expected),
                             .help = std::move(help)});
}

void OptionTable::AddChoice(std::string key, std::vector<std::string> names,
                            std::function<void(size_t)> set, std::function<size_t()> get,
                            std::string help) {
  std::string expected = "one of: " + Join(names);
  const auto index_of = [names](const std::string& text) {
    return static_cast<size_t>(std::find(names.begin(), names.end(), text) - names.begin());
  };
  AddOption(std::move(key),
            {.parse =
                 [index_of, set = std::move(set), count = names.size()](const std::string& text) {
                   const size_t index = index_of(text);
                   const bool good = index < count;
                   if (good) set(index);
                   return good;
                 },
             .print = [names = std::move(names), get = std::move(get)] { return names.at(get()); },
             .expected = std::move(expected),
             .help = std::move(help)});
}

void OptionTable::AddShared(std::string key, const std::vector<std::string>& members,
                            std::string help) {
  std::vector<Option> options;
  for (const std::string& member : members) {
    const auto it = options_.find(member);
    Check(it != options_.end(), "a shared key has a member that is not bound");
    options.push_back(it->second);
  }
  AddOption(std::move(key), {.parse =
                                 [options](const std::string& text) {
                                   // If a member refuses the value, earlier members stay set. This
                                   // is harmless, because the run ends anyway.
                                   return std::all_of(
                                       options.begin(), options.end(),
                                       [&](const Option& option) { return option.parse(text); });
                                 },
                             .print = options.front().print,
                             .expected = options.front().expected,
                             .help = std::move(help),
                             .members = members});
}

void OptionTable::AddText(std::string key, std::string* field, std::string help) {
  AddOption(std::move(key), {.parse =
                                 [field](const std::string& text) {
                                   *field = text;
                                   return true;
                                 },
                             .print = [field] { return *field; },
                             .expected = "text",
                             .help = std::move(help)});
}

void OptionTable::AddIgnored(std::string key) {
  Option option;
  option.parse = [](const std::string&) { return true; };
  option.ignored = true;
  AddOption(std::move(key), std::move(option));
}

bool OptionTable::Contains(std::string_view key) const { return options_.contains(key); }

std::vector<std::string> OptionTable::KeysSetBy(std::string_view key) const {
  const auto it = options_.find(key);
  return it == options_.end() || it->second.members.empty()
             ? std::vector<std::string>{std::string(key)}
             : it->second.members;
}

bool OptionTable::IsMap(std::string_view key) const {
  const auto it = options_.find(key);
  return it != options_.end() && it->second.is_map;
}

// The key that is most similar to a misspelt one. Empty if no key is similar enough.
std::string OptionTable::MostSimilarKey(const std::string& key) const {
  constexpr size_t kLongestKey = 100;
  const std::string compared = key.substr(0, kLongestKey);
  std::string most_similar;
  size_t least_distance = std::numeric_limits<size_t>::max();
  for (const auto& [name, option] : options_) {
    const size_t distance = EditDistance(compared, name);
    if (distance < least_distance && IsMisspelt(compared, name)) {
      least_distance = distance;
      most_similar = name;
    }
  }
  return most_similar;
}

void OptionTable::Set(const std::string& key, const std::string& value, const std::string& origin) {
  const auto it = options_.find(key);
  if (it == options_.end()) {
    const std::string similar = MostSimilarKey(key);
    throw InputError(origin + ": unknown key '" + ShowText(key) + "'" +
                     (similar.empty() ? "" : "; did you mean '" + similar + "'?"));
  }
  if (!it->second.parse(value)) {
    throw InputError(origin + ": " + key + " is '" + ShowText(value) + "', expected " +
                     it->second.expected);
  }
}

std::vector<OptionTable::Entry> OptionTable::Entries() const {
  std::vector<Entry> entries;
  for (const auto& [key, option] : options_) {
    if (!option.ignored) {
      entries.push_back(
          {key, option.print(), option.expected, option.help, !option.members.empty()});
    }
  }
  return entries;
}

void OptionScope::AddShared(const std::string& name, std::vector<std::string> members,
                            std::string help) const {
  for (std::string& member : members) {
    member = Key(member);
  }
  table_.AddShared(Key(name), members, std::move(help));
}

}  // namespace hullslam
