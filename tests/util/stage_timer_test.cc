// SPDX-License-Identifier: GPL-3.0-or-later
#include "hullslam/util/stage_timer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace hullslam {
namespace {

TEST(StageTimes, GroupsByName) {
  StageTimes times;
  times.Add("track", 3.0);
  times.Add("map", 7.0);
  times.Add("track", 4.0);
  ASSERT_EQ(times.samples().size(), 2u);
  EXPECT_EQ(times.samples().find("track")->second, (std::vector<double>{3.0, 4.0}));
  EXPECT_EQ(times.samples().find("map")->second, (std::vector<double>{7.0}));
}

TEST(StageTimes, MergeAppends) {
  StageTimes first;
  StageTimes second;
  first.Add("track", 1.0);
  second.Add("track", 2.0);
  second.Add("loop", 3.0);
  first.Merge(second);
  EXPECT_EQ(first.samples().find("track")->second, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(first.samples().find("loop")->second, (std::vector<double>{3.0}));
  EXPECT_EQ(second.samples().size(), 2u);
}

// So a run of many hours needs no more memory than one of minutes.
TEST(StageTimes, KeepsEvenlyChosenSamplesOfALongRun) {
  StageTimes times;
  constexpr size_t kCount = 5 * kMostSamples;
  for (size_t i = 0; i < kCount; ++i) {
    times.Add("track", static_cast<double>(i));
  }
  const std::vector<double>& kept = times.samples().at("track");
  ASSERT_LE(kept.size(), kMostSamples);
  ASSERT_GE(kept.size(), kMostSamples / 2);
  for (size_t i = 0; i < kept.size(); ++i) {
    ASSERT_EQ(kept[i], 8.0 * static_cast<double>(i));
  }
  const TimeStatistics of_all = Summarize(times, "track");
  EXPECT_EQ(of_all.mean, 0.5 * (kCount - 1));
  EXPECT_EQ(of_all.max, kCount - 1);
  EXPECT_NEAR(of_all.median, 0.5 * kCount, 8.0);
  EXPECT_EQ(times.Total("track").count, kCount);
  EXPECT_EQ(Summarize(times, "map").max, 0.0);
}

// Each sample that is left stands for as many samples of the whole.
TEST(StageTimes, MergeThinsTheFinerSamples) {
  StageTimes many;
  for (size_t i = 0; i < 3 * kMostSamples; ++i) {
    many.Add("track", 1.0);
  }
  StageTimes few;
  for (size_t i = 0; i < kMostSamples; ++i) {
    few.Add("track", 5.0);
  }
  StageTimes reversed = few;
  reversed.Merge(many);
  many.Merge(few);
  for (const StageTimes& merged : {many, reversed}) {
    const std::vector<double>& kept = merged.samples().at("track");
    const auto fives = static_cast<double>(std::count(kept.begin(), kept.end(), 5.0));
    EXPECT_LE(kept.size(), kMostSamples);
    EXPECT_NEAR(fives / static_cast<double>(kept.size()), 0.25, 0.01);
    EXPECT_DOUBLE_EQ(Summarize(merged, "track").mean, 2.0);
    EXPECT_EQ(merged.Total("track").max, 5.0);
  }
}

TEST(ScopedTimer, AddsOneSampleWhenDestroyed) {
  StageTimes times;
  {
    const ScopedTimer timer(times, "stage");
    EXPECT_TRUE(times.samples().empty());
  }
  ASSERT_EQ(times.samples().count("stage"), 1u);
  ASSERT_EQ(times.samples().find("stage")->second.size(), 1u);
  EXPECT_GE(times.samples().find("stage")->second[0], 0.0);
}

TEST(Summarize, GivesZerosForNoSamples) {
  const TimeStatistics none = Summarize({});
  EXPECT_EQ(none.median, 0.0);
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_EQ(none.p95, 0.0);
  EXPECT_EQ(none.max, 0.0);
}

TEST(Summarize, OfASingleSampleIsThatSample) {
  const TimeStatistics one = Summarize({2.5});
  EXPECT_EQ(one.median, 2.5);
  EXPECT_EQ(one.mean, 2.5);
  EXPECT_EQ(one.p95, 2.5);
  EXPECT_EQ(one.max, 2.5);
}

TEST(Summarize, MatchesHandComputedValues) {
  const TimeStatistics odd = Summarize({9.0, 1.0, 2.0});
  EXPECT_EQ(odd.median, 2.0);
  EXPECT_EQ(odd.mean, 4.0);
  EXPECT_EQ(odd.max, 9.0);
  const TimeStatistics even = Summarize({4.0, 1.0, 2.0, 9.0});
  EXPECT_EQ(even.median, 3.0);
  std::vector<double> hundred(100);
  std::iota(hundred.rbegin(), hundred.rend(), 1.0);
  EXPECT_EQ(Summarize(hundred).p95, 95.0);
  EXPECT_EQ(Summarize({1.0, 2.0}).p95, 2.0);
}

}  // namespace
}  // namespace hullslam
