// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hullslam {

// Durations in milliseconds, grouped by the name of the stage. Not thread-safe: each thread keeps
// its own, and Merge() joins them at the end.
class StageTimes {
 public:
  void Add(std::string_view stage, double milliseconds);
  void Merge(const StageTimes& other);
  const std::map<std::string, std::vector<double>, std::less<>>& samples() const {
    return samples_;
  }

 private:
  std::map<std::string, std::vector<double>, std::less<>> samples_;
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

}  // namespace hullslam
