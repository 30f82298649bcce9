// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relocalisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
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

QueryResult Relocalise(const Relocaliser& relocaliser, const Frame& frame,
                       const PointAlignment& truth_from_map, const Rigid3& true_world_from_cam) {
  QueryResult result;
  const auto start = std::chrono::steady_clock::now();
  result.found = relocaliser.Find(frame);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (result.found) {
    const Eigen::Vector3d position = Inverse(result.found->cam_from_world).translation;
    result.error = (truth_from_map * position - true_world_from_cam.translation).norm();
  }
  return result;
}

std::string DescribeQuery(const QueryResult& result) {
  return result.found
             ? fmt::format("by {}, error {:.4f} m, {} landmarks, {} objects, {:.1f} ms\n",
                           ToString(result.found->method), result.error, result.found->inliers,
                           result.found->used_objects, result.milliseconds)
             : fmt::format("not found, {:.1f} ms\n", result.milliseconds);
}

std::string DescribeQueries(std::span<const QueryResult> results) {
  std::string text = fmt::format("{:<9}  {:>7}  {:>8}  {:>9}  {:>5}  {:>9}  {:>6}\n", "method",
                                 "queries", "<= 5 cm", "<= 10 cm", "false", "median ms", "max ms");
  for (const QuerySummary& line : SummarizeQueries(results)) {
    const std::string duration =
        line.queries == 0 ? fmt::format("{:>9}  {:>6}", "-", "-")
                          : fmt::format("{:>9.1f}  {:>6.1f}", line.median_ms, line.max_ms);
    text += fmt::format("{:<9}  {:>7}  {:>6.1f} %  {:>7.1f} %  {:>5}  {}\n", line.name,
                        line.queries, line.near_percent, line.far_percent, line.wrong, duration);
  }
  return text;
}

}  // namespace hullslam
