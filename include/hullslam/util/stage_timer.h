// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// The most samples of a stage that are kept: 4.5 minutes of a camera with 30 Hz.
inline constexpr size_t kMostSamples = 8192;

// All samples of a stage together.
struct StageTotal {
  size_t count = 0;
  double sum = 0.0;  // ms
  double max = 0.0;  // ms
};

// Durations in milliseconds, grouped by the name of the stage. Of a stage with more than
// kMostSamples every second, fourth, ... sample is kept, so memory does not grow with the time.
// Stages with equally many samples keep those with the same numbers. Not thread-safe: each thread
// keeps its own, and Merge() joins them at the end.
class StageTimes {
 public:
  void Add(std::string_view stage, double milliseconds);
  void Merge(const StageTimes& other);
  // The samples that are kept, in order.
  const std::map<std::string, std::vector<double>, std::less<>>& samples() const {
    return samples_;
  }
  // Of all samples; zero if there are none.
  StageTotal Total(std::string_view stage) const;

 private:
  struct Tally {
    StageTotal total;
    size_t stride = 1;  // every stride-th sample is kept
  };

  static void Thin(std::vector<double>& samples, Tally& tally);

  std::map<std::string, std::vector<double>, std::less<>> samples_;
  std::map<std::string, Tally, std::less<>> tallies_;  // the same stages
};

// Measures the time from construction to destruction and adds it to `times`.
class ScopedTimer {
 public:
  ScopedTimer(StageTimes& times, std::string_view stage)
      : times_(times), stage_(stage), start_(std::chrono::steady_clock::now()) {}
  ~ScopedTimer();
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  StageTimes& times_;
  std::string_view stage_;
  std::chrono::steady_clock::time_point start_;
};

// Median, mean, 95th percentile (nearest rank) and maximum; all zero if there are no samples.
struct TimeStatistics {
  double median = 0.0;
  double mean = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};
TimeStatistics Summarize(std::vector<double> samples);
// The same of a stage. Mean and maximum are over all its samples.
TimeStatistics Summarize(const StageTimes& times, std::string_view stage);

}  // namespace hullslam
