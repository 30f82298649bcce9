// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relocalisation.h"

#include <algorithm>
#include <random>
#include <utility>

#include "util/statistics.h"

namespace hullslam {
namespace {

QuerySummary Summarize(const std::string& name, std::span<const QueryResult> results,
                       const auto& is_wanted) {
  constexpr double kNear = 0.05;  // m
  constexpr double kFar = 0.1;    // m
  QuerySummary summary{.name = name};
  size_t near = 0;
  size_t far = 0;
  std::vector<double> times;
  for (const QueryResult& result : results) {
    if (!is_wanted(result)) {
      continue;
    }
    times.push_back(result.milliseconds);
    if (result.found) {
      near += result.error <= kNear ? 1 : 0;
      far += result.error <= kFar ? 1 : 0;
      summary.wrong += result.error > kFar ? 1 : 0;
    }
  }
  const auto percent = [&](size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(results.size());
  };
  summary.queries = times.size();
  summary.near_percent = percent(near);
  summary.far_percent = percent(far);
  if (!times.empty()) {
    summary.max_ms = *std::max_element(times.begin(), times.end());
    summary.median_ms = Median(std::move(times));
  }
  return summary;
}

}  // namespace

std::vector<size_t> ChooseQueries(std::vector<size_t> frames, size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  count = std::min(count, frames.size());
  for (size_t i = 0; i < count; ++i) {
    std::swap(frames[i], frames[i + random() % (frames.size() - i)]);
  }
  frames.resize(count);
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::vector<QuerySummary> SummarizeQueries(std::span<const QueryResult> results) {
  std::vector<QuerySummary> lines;
  for (const auto method : {RelocalisationMethod::kWords, RelocalisationMethod::kObjects}) {
    lines.push_back(Summarize(ToString(method), results, [method](const QueryResult& result) {
      return result.found && result.found->method == method;
    }));
  }
  lines.push_back(
      Summarize("not found", results, [](const QueryResult& result) { return !result.found; }));
  lines.push_back(Summarize("all", results, [](const QueryResult&) { return true; }));
  return lines;
}

}  // namespace hullslam
