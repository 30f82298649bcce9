// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include "files/plausible.h"
#include "files/read_file.h"
#include "hullslam/util/error.h"
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

namespace {

using Json = nlohmann::json;

bool IsFiniteNumber(const Json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

bool AreNumbers(const Json& value, size_t count) {
  return value.is_array() && value.size() == count &&
         std::all_of(value.begin(), value.end(), IsFiniteNumber);
}

}  // namespace

JsonNode JsonNode::At(const std::string& key) const {
  if (!value_->is_object()) {
    Fail("an object");
  }
  const auto found = value_->find(key);
  if (found == value_->end()) {
    throw InputError(fmt::format("{}: {}{}\"{}\" is missing", file_->string(), path_,
                                 path_.empty() ? "" : ": ", key));
  }
  const std::string shown = ShowText(key);  // a key may be a name of the user
  return {*this, *found, path_.empty() ? shown : path_ + '.' + shown};
}

bool JsonNode::Has(const std::string& key) const {
  return value_->is_object() && value_->contains(key) && !value_->at(key).is_null();
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::Members() const {
  if (!value_->is_object()) {
    Fail("an object");
  }
  std::vector<std::pair<std::string, JsonNode>> members;
  for (const auto& member : value_->items()) {
    members.emplace_back(member.key(), At(member.key()));
  }
  return members;
}

std::vector<JsonNode> JsonNode::Elements() const {
  if (!value_->is_array()) {
    Fail("an array");
  }
  std::vector<JsonNode> elements;
  elements.reserve(value_->size());
  for (const Json& element : *value_) {
    elements.push_back({*this, element, fmt::format("{}[{}]", path_, elements.size())});
  }
  return elements;
}

std::string JsonNode::Text() const {
  if (!value_->is_string()) {
    Fail("a string");
  }
  return Printable(value_->get<std::string>());
}

bool JsonNode::Flag() const {
  if (!value_->is_boolean()) {
    Fail("true or false");
  }
  return value_->get<bool>();
}

double JsonNode::Number() const {
  if (!IsFiniteNumber(*value_)) {
    Fail("a finite number");
  }
  return value_->get<double>();
}

double JsonNode::Number(double most) const {
  if (!IsFiniteNumber(*value_) || !(std::abs(value_->get<double>()) <= most)) {
    Fail(fmt::format("a number from {:g} to {:g}", -most, most));
  }
  return value_->get<double>();
}

double JsonNode::PositiveNumber(double most) const {
  const double value = IsFiniteNumber(*value_) ? value_->get<double>() : 0.0;
  if (!(value > 0.0 && value <= most)) {
    Fail(fmt::format("a number > 0, up to {:g}", most));
  }
  return value;
}

uint32_t JsonNode::Count() const {
  if (!value_->is_number_unsigned() ||
      value_->get<uint64_t>() >= std::numeric_limits<uint32_t>::max()) {
    Fail("an integer from 0 to 4294967294");
  }
  return value_->get<uint32_t>();
}

std::vector<double> JsonNode::Numbers(size_t count, std::string_view expected) const {
  if (!AreNumbers(*value_, count)) {
    Fail(expected.empty() ? fmt::format("{} finite numbers", count) : std::string(expected));
  }
  return value_->get<std::vector<double>>();
}

Eigen::Vector3d JsonNode::Lengths() const {
  const bool good =
      AreNumbers(*value_, 3) && std::all_of(value_->begin(), value_->end(), [](const Json& length) {
        return length.get<double>() > 0.0 && length.get<double>() <= kMostMetres;
      });
  if (!good) {
    Fail(fmt::format("three numbers > 0, up to {:g} m", kMostMetres));
  }
  return {value_->at(0).get<double>(), value_->at(1).get<double>(), value_->at(2).get<double>()};
}

std::vector<Eigen::Vector2d> JsonNode::Points() const {
  const bool good =
      value_->is_array() && std::all_of(value_->begin(), value_->end(), [](const Json& point) {
        return AreNumbers(point, 2) && std::abs(point[0].get<double>()) <= kMostPixels &&
               std::abs(point[1].get<double>()) <= kMostPixels;
      });
  if (!good) {
    Fail(fmt::format("points [x, y] of numbers from {:g} to {:g} px", -kMostPixels, kMostPixels));
  }
  std::vector<Eigen::Vector2d> points;
  points.reserve(value_->size());
  for (const Json& point : *value_) {
    points.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  return points;
}

void JsonNode::Fail(std::string_view expected) const {
  throw InputError(fmt::format("{}: {} is {}, expected {}", file_->string(),
                               path_.empty() ? "the top" : path_, ShowJson(*value_), expected));
}

}  // namespace hullslam
