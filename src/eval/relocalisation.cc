// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relocalisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "util/statistics.h"

namespace hullslam {
namespace {

constexpr double kFar = 0.1;      // m
constexpr double kFarTurn = 5.0;  // degrees
constexpr double kDegrees = 180.0 / std::numbers::pi;

QuerySummary Summarize(const std::string& name, std::span<const QueryResult> results,
                       const auto& is_wanted) {
  constexpr double kNear = 0.05;  // m
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

// The angle between the optical axes of two cameras, degrees.
double ViewAngle(const Eigen::Quaterniond& world_from_a, const Eigen::Quaterniond& world_from_b) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  return kDegrees * std::acos(std::clamp((world_from_a * z).dot(world_from_b * z), -1.0, 1.0));
}

// The table by view angle, in steps of 10 degrees.
std::string DescribeAngles(std::span<const QueryResult> results) {
  constexpr double kStep = 10.0;
  struct Bin {
    size_t queries = 0;
    size_t right = 0;
    size_t wrong = 0;
  };
  std::map<int, Bin> bins;
  for (const QueryResult& result : results) {
    Bin& bin = bins[static_cast<int>(result.view_angle / kStep)];
    const bool is_right = result.error <= kFar && result.turn_error <= kFarTurn;
    ++bin.queries;
    bin.right += result.found && is_right ? 1 : 0;
    bin.wrong += result.found && !is_right ? 1 : 0;
  }
  std::string text =
      fmt::format("{:<9}  {:>7}  {:>8}  {:>8}\n", "angle", "queries", "right", "wrong");
  for (const auto& [number, bin] : bins) {
    const auto percent = [&](size_t count) {
      return 100.0 * static_cast<double>(count) / static_cast<double>(bin.queries);
    };
    text += fmt::format("{:>3} to {:>3}  {:>7}  {:>6.1f} %  {:>6.1f} %\n", 10 * number,
                        10 * number + 10, bin.queries, percent(bin.right), percent(bin.wrong));
  }
  return text;
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

PointAlignment AlignWithRotations(const Trajectory& truth, const Trajectory& estimate,
                                  const PointAlignment& by_points) {
  constexpr double kMaxPoseGap = 0.1;  // s, between the two poses from which one is interpolated
  constexpr double kLever = 1.0;       // m
  std::vector<Rigid3> source;
  std::vector<Rigid3> target;
  for (const auto& [timestamp, pose] : estimate) {
    if (const auto true_pose = InterpolatePose(truth, timestamp, kMaxPoseGap)) {
      source.emplace_back(pose.rotation, by_points.scale * pose.translation);
      target.push_back(*true_pose);
    }
  }
  PointAlignment alignment = by_points;
  if (!source.empty()) {
    alignment.target_from_source = AlignPoses(source, target, kLever);
  }
  return alignment;
}

QueryResult Relocalise(const Relocaliser& relocaliser, const Map& map, const Frame& frame,
                       const PointAlignment& truth_from_map, const Rigid3& true_world_from_cam) {
  QueryResult result;
  const auto start = std::chrono::steady_clock::now();
  result.found = relocaliser.Find(frame);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const Eigen::Quaterniond& world = truth_from_map.target_from_source.rotation;
  if (result.found) {
    const Eigen::Vector3d position = Inverse(result.found->cam_from_world).translation;
    result.error = (truth_from_map * position - true_world_from_cam.translation).norm();
    result.turn_error =
        kDegrees * AngularDistance(world * Inverse(result.found->cam_from_world).rotation,
                                   true_world_from_cam.rotation);
  }
  result.view_angle = 180.0;
  for (const auto& [id, keyframe] : map.keyframes()) {
    const double angle =
        ViewAngle(world * Inverse(keyframe.cam_from_world).rotation, true_world_from_cam.rotation);
    result.view_angle = std::min(result.view_angle, angle);
  }
  return result;
}

std::string DescribeQuery(const QueryResult& result) {
  return result.found
             ? fmt::format(
                   "by {}, error {:.4f} m, {:.2f} deg, {} landmarks, {} objects, {:.1f} ms\n",
                   ToString(result.found->method), result.error, result.turn_error,
                   result.found->inliers, result.found->used_objects, result.milliseconds)
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
  return text + DescribeAngles(results);
}

}  // namespace hullslam
