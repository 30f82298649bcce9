// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/stage_timer.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>

namespace hullslam {

void StageTimes::Add(std::string_view stage, double milliseconds) {
  auto it = tallies_.find(stage);
  if (it == tallies_.end()) {
    it = tallies_.emplace(std::string(stage), Tally()).first;
  }
  Tally& tally = it->second;
  std::vector<double>& samples = samples_[it->first];
  if (tally.total.count % tally.stride == 0) {
    samples.push_back(milliseconds);
  }
  ++tally.total.count;
  tally.total.sum += milliseconds;
  tally.total.max = std::max(tally.total.max, milliseconds);
  if (samples.size() > kMostSamples) {
    Thin(samples, tally);
  }
}

// Keeps every second one.
void StageTimes::Thin(std::vector<double>& samples, Tally& tally) {
  for (size_t i = 0; 2 * i < samples.size(); ++i) {
    samples[i] = samples[2 * i];
  }
  samples.resize((samples.size() + 1) / 2);
  tally.stride *= 2;
}

void StageTimes::Merge(const StageTimes& other) {
  for (const auto& [stage, tally] : other.tallies_) {
    std::vector<double>& mine = samples_[stage];
    Tally& together = tallies_[stage];
    std::vector<double> theirs = other.samples_.find(stage)->second;
    Tally added = tally;
    // Each sample stands for as many.
    while (added.stride < together.stride) {
      Thin(theirs, added);
    }
    while (together.stride < added.stride) {
      Thin(mine, together);
    }
    mine.insert(mine.end(), theirs.begin(), theirs.end());
    together.total.count += added.total.count;
    together.total.sum += added.total.sum;
    together.total.max = std::max(together.total.max, added.total.max);
    while (mine.size() > kMostSamples) {
      Thin(mine, together);
    }
  }
}

StageTotal StageTimes::Total(std::string_view stage) const {
  const auto found = tallies_.find(stage);
  return found == tallies_.end() ? StageTotal() : found->second.total;
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

TimeStatistics Summarize(const StageTimes& times, std::string_view stage) {
  const auto found = times.samples().find(stage);
  if (found == times.samples().end()) {
    return {};
  }
  const StageTotal total = times.Total(stage);
  TimeStatistics result = Summarize(found->second);
  result.mean = total.sum / static_cast<double>(total.count);
  result.max = total.max;
  return result;
}

}  // namespace hullslam
