// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/json_file.h"

#include <fmt/format.h>

#include <functional>
#include <string_view>

#include "files/read_text.h"
#include "hullslam/util/error.h"
#include "util/classic_locale.h"
#include "util/text.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

// nlohmann's message begins with the library's name for the error in brackets, which is cut off.
[[noreturn]] void FailParsing(const std::filesystem::path& path, std::string_view message) {
  const size_t begin = message.find("] ");
  message.remove_prefix(begin == std::string_view::npos ? 0 : begin + 2);
  throw InputError(path.string() + ": is no valid JSON, " + ShowText(message));
}

// Appends the JSON of a value until the text has `enough` characters. The library's own dump() is
// not used: it writes the whole value, and it calls itself for each level of nesting. Here each
// level adds a character, so the nesting is limited too.
void AppendJson(const Json& value, size_t enough, std::string& text) {
  if (text.size() > enough) {
    return;
  }
  if (!value.is_structured()) {
    const bool is_long = value.is_string() && value.get_ref<const std::string&>().size() > enough;
    const Json& shown =
        is_long ? Json(value.get_ref<const std::string&>().substr(0, enough)) : value;
    text += shown.dump(-1, ' ', true, Json::error_handler_t::replace);
    return;
  }
  text += value.is_array() ? '[' : '{';
  bool is_first = true;
  for (auto item = value.begin(); item != value.end() && text.size() <= enough; ++item) {
    text += is_first ? "" : ",";
    is_first = false;
    if (value.is_object()) {
      AppendJson(Json(item.key()), enough, text);
      text += ':';
    }
    AppendJson(*item, enough, text);
  }
  text += value.is_array() ? ']' : '}';
}

// Checks the limits at each parse event. The parser itself does not call itself for nested lists.
class LimitChecker {
 public:
  LimitChecker(const std::filesystem::path& path, const JsonLimits& limits,
               const Json::parser_callback_t& callback)
      : path_(path), limits_(limits), callback_(callback) {}

  bool operator()(int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > limits_.most_depth) {
      throw InputError(
          fmt::format("{}: is nested more than {} deep", path_.string(), limits_.most_depth));
    }
    if (++values_ > limits_.most_values) {
      throw InputError(
          fmt::format("{}: has more than {} values", path_.string(), limits_.most_values));
    }
    return callback_ == nullptr || callback_(depth, event, parsed);
  }

 private:
  const std::filesystem::path& path_;
  const JsonLimits& limits_;
  const Json::parser_callback_t& callback_;
  size_t values_ = 0;
};

}  // namespace

Json ReadJson(const std::filesystem::path& path, const JsonLimits& limits,
              const Json::parser_callback_t& callback) {
  const std::string text = ReadText(path, limits.most_bytes);
  LimitChecker checker(path, limits, callback);
  const ClassicLocale locale;  // the parser knows decimal points of one byte only
  try {
    return Json::parse(text, std::ref(checker));
  } catch (const Json::exception& error) {
    FailParsing(path, error.what());
  }
}

std::string ShowJson(const Json& value) {
  constexpr size_t kEnough = 120;
  std::string text;
  AppendJson(value, kEnough, text);
  return ShowText(text, kEnough);
}

}  // namespace hullslam
