// SPDX-License-Identifier: GPL-3.0-or-later
#include "eval/relocalisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

namespace hullslam {
namespace {

TEST(ChooseQueries, EachFrameIsChosenAtMostOnceAndTheSeedDecides) {
  std::vector<size_t> frames(100);
  std::iota(frames.begin(), frames.end(), 50);
  const std::vector<size_t> chosen = ChooseQueries(frames, 20, 7);
  EXPECT_EQ(std::set<size_t>(chosen.begin(), chosen.end()).size(), 20U);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(ChooseQueries(frames, 20, 7), chosen);
  EXPECT_NE(ChooseQueries(frames, 20, 8), chosen);
  EXPECT_EQ(ChooseQueries(frames, 1000, 7), frames);
}

TEST(SummarizeQueries, SharesAreThoseOfAllQueries) {
  const auto found = [](RelocalisationMethod method, double error, double milliseconds) {
    QueryResult result{.found = RelocalisedPose(), .error = error, .milliseconds = milliseconds};
    result.found->method = method;
    return result;
  };
  const std::vector<QueryResult> results = {
      found(RelocalisationMethod::kWords, 0.01, 1.0),
      found(RelocalisationMethod::kWords, 0.07, 2.0),
      found(RelocalisationMethod::kObjects, 0.5, 9.0),
      QueryResult{.found = std::nullopt, .error = 0.0, .milliseconds = 4.0}};
  const std::vector<QuerySummary> lines = SummarizeQueries(results);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0].queries, 2U);
  EXPECT_EQ(lines[0].near_percent, 25.0);
  EXPECT_EQ(lines[0].far_percent, 50.0);
  EXPECT_EQ(lines[1].wrong, 1U);
  EXPECT_EQ(lines[2].name, "not found");
  EXPECT_EQ(lines[2].max_ms, 4.0);
  EXPECT_EQ(lines[3].queries, 4U);
  EXPECT_EQ(lines[3].max_ms, 9.0);
}

TEST(DescribeQueries, HasALineForEachOutcome) {
  const std::vector<QueryResult> results = {
      QueryResult{.found = std::nullopt, .milliseconds = 4.0}};
  EXPECT_EQ(DescribeQuery(results[0]), "not found, 4.0 ms\n");
  const std::string text = DescribeQueries(results);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
}

}  // namespace
}  // namespace hullslam
