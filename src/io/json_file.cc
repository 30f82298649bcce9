// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_file.h"

#include <algorithm>
#include <string_view>

#include "hullslam/util/error.h"
#include "io/text_rows.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

std::string Shorten(std::string text) {
  constexpr size_t kLongest = 120;
  if (text.size() > kLongest) {
    text.resize(kLongest);
    text += "...";
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

// The message of nlohmann begins with the name that the library has for the error.
[[noreturn]] void FailParsing(const std::filesystem::path& path, std::string_view message) {
  const size_t begin = message.find("] ");
  message.remove_prefix(begin == std::string_view::npos ? 0 : begin + 2);
  throw InputError(path.string() + ": is no valid JSON, " + Shorten(std::string(message)));
}

}  // namespace

Json ReadJson(const std::filesystem::path& path, size_t most_bytes,
              const Json::parser_callback_t& callback) {
  CheckFileSize(path, most_bytes);
  const std::string text = ReadFile(path);
  try {
    return Json::parse(text, callback);
  } catch (const Json::exception& error) {
    FailParsing(path, error.what());
  }
}

std::string ShowJson(const Json& value) {
  return Shorten(value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace hullslam
