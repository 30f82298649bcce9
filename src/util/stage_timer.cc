// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/stage_timer.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>

namespace hullslam {

void StageTimes::Add(std::string_view stage, double milliseconds) {
  auto it = samples_.find(stage);
  if (it == samples_.end()) {
    it = samples_.emplace(std::string(stage), std::vector<double>()).first;
  }
  it->second.push_back(milliseconds);
}

void StageTimes::Merge(const StageTimes& other) {
  for (const auto& [stage, samples] : other.samples_) {
    std::vector<double>& mine = samples_[stage];
    mine.insert(mine.end(), samples.begin(), samples.end());
  }
}

ScopedTimer::~ScopedTimer() {
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start_;
  try {
    times_.Add(stage_, elapsed.count());
  } catch (const std::bad_alloc&) {
    // An exception of a destructor would end the program. The sample is lost instead.
  }
}

TimeStatistics Summarize(std::vector<double> samples) {
  if (samples.empty()) {
    return {};
  }
  std::sort(samples.begin(), samples.end());
  const size_t n = samples.size();
  TimeStatistics result;
  result.median = n % 2 == 1 ? samples[n / 2] : 0.5 * (samples[n / 2 - 1] + samples[n / 2]);
  result.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(n);
  const auto rank = static_cast<size_t>(std::ceil(0.95 * static_cast<double>(n)));
  result.p95 = samples[rank - 1];
  result.max = samples.back();
  return result;
}

}  // namespace hullslam
