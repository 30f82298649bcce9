// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "files/json_file.h"
#include "files/text_rows.h"
#include "hullslam/util/error.h"
#include "masks/mask_checks.h"

namespace hullslam {
namespace {

using Json = nlohmann::json;

constexpr size_t kMostValues = 2'000'000;
constexpr size_t kMostRecords = 1'000'000;
constexpr int kMostDepth = 16;

// A callback of the parser that visits each record as soon as it is complete, and does not keep it.
class RecordTaker {
 public:
  RecordTaker(const std::filesystem::path& path,
              const std::function<void(const JsonRecord& record)>& visit)
      : path_(path), visit_(visit) {}

  // Called for each event of the parser. Returns whether the value is kept.
  bool operator()(int depth, Json::parse_event_t event, Json& parsed) {
    Count();
    if (depth == 0 && event == Json::parse_event_t::object_start) {
      records_depth_ = 2;
    } else if (depth == 1 && event == Json::parse_event_t::key) {
      section_ = parsed.get<std::string>();
    } else if (depth == records_depth_ && event == Json::parse_event_t::object_end) {
      if (++records_ > kMostRecords) {
        throw InputError(fmt::format("{}: more than {} records", path_.string(), kMostRecords));
      }
      visit_({path_, section_, indices_[section_]++, std::move(parsed)});
      values_ = 0;
      return false;
    }
    return true;
  }

 private:
  void Count() {
    if (++values_ > kMostValues) {
      throw InputError(fmt::format("{}: more than {} values in one record or outside of records",
                                   path_.string(), kMostValues));
    }
  }

  const std::filesystem::path& path_;
  const std::function<void(const JsonRecord& record)>& visit_;
  int records_depth_ = 1;  // depth of the records: 1 in a list, 2 in a list in an object
  std::string section_;
  std::map<std::string, size_t> indices_;
  size_t values_ = 0;
  size_t records_ = 0;
};

}  // namespace

void JsonRecord::Fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}[{}]: {}", path.string(), section, index, what));
}

void ForEachJsonRecord(const std::filesystem::path& path,
                       const std::function<void(const JsonRecord& record)>& visit) {
  RecordTaker taker(path, visit);
  // The RecordTaker counts the values, because the limit is one for each record.
  const JsonLimits limits = {.most_bytes = kMostJsonFileBytes,
                             .most_values = std::numeric_limits<size_t>::max(),
                             .most_depth = kMostDepth};
  ReadJson(path, limits, std::ref(taker));
}

const Json& Member(const JsonRecord& record, const Json& object, const char* name) {
  const auto found = object.find(name);  // end() if `object` is no object
  if (found == object.end()) {
    record.Fail(fmt::format("has no '{}'", name));
  }
  return *found;
}

std::vector<double> Numbers(const JsonRecord& record, const Json& list, const char* name) {
  const bool is_list =
      list.is_array() &&
      std::all_of(list.begin(), list.end(), [](const Json& number) { return number.is_number(); });
  if (!is_list) {
    record.Fail(fmt::format("{} is {}, expected a list of numbers", name, ShowJson(list)));
  }
  return list.get<std::vector<double>>();
}

double ScoreOf(const JsonRecord& record, const Json& object) {
  for (const char* const name : {"score", "detection_score", "confidence", "conf", "probability"}) {
    const auto found = object.find(name);
    if (found == object.end() || found->is_null()) {
      continue;
    }
    double score = found->is_number() ? found->get<double>() : -1.0;
    if (found->is_string()) {
      ParseFinite(found->get_ref<const std::string&>(), score);
    }
    if (!(score >= 0.0 && score <= 1.0)) {
      record.Fail(fmt::format("{} is {}, expected a number from 0 to 1", name, ShowJson(*found)));
    }
    return score;
  }
  return 1.0;
}

std::optional<std::string> ClassNameOf(const Json& object) {
  for (const char* const name : {"label", "class", "class_name", "category_name", "category"}) {
    const auto found = object.find(name);
    if (found != object.end() && found->is_string() &&
        !found->get_ref<const std::string&>().empty()) {
      return found->get<std::string>();
    }
  }
  return std::nullopt;
}

}  // namespace hullslam
